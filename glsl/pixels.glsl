// The pixels of the tiles' picture: floats, which a draw can blend onto what the host has drawn, or those of a target of 8
// bits a channel, where nothing lies below.
#ifndef RARA_PIXELS
#define RARA_PIXELS
#include "frame.glsl"

layout(constant_id = 10) const uint PIXELS = PIXELS_FLOAT; // PIXELS_*

BUFFER(writeonly, 5, vec4, picture)
// The same buffer, for pixels of a word.
BUFFER(writeonly, 8, uint, picture_words)

// Writes a pixel, with the bytes that it gets when it is blended into a cleared attachment.
void write_pixel(uint at, vec4 colour) {
    if (PIXELS == PIXELS_BYTE) {
        picture_words.at[at] = packUnorm4x8(colour);
    } else {
        picture.at[at] = colour;
    }
}

// Writes a pixel's expected depth, which has its place behind all pixels: the sum of its splats' depths, each times what it adds to
// the pixel's alpha, and that alpha.
void write_expected_depth(uint at, uint pixel_count, vec2 sums) {
    uint place = (PIXELS == PIXELS_BYTE ? 1u : 4u) * pixel_count + 2u * at;
    picture_words.at[place] = floatBitsToUint(sums.x);
    picture_words.at[place + 1u] = floatBitsToUint(sums.y);
}

// Writes a pixel's depth for the host's depth buffer, which has its place behind the expected ones. The picture of a host with such a
// buffer has pixels of floats.
void write_depth(uint at, uint pixel_count, float depth) {
    uint expected = EXPECTED_DEPTH ? (pixel_count + 1u) / 2u : 0u;
    picture_words.at[4u * (pixel_count + expected) + at] = floatBitsToUint(depth);
}

#endif
