// The pixels of the tiles' picture: floats, which a draw can blend onto what the host has drawn, or those of a target of 8
// bits a channel, where nothing lies below.
#ifndef RARA_PIXELS
#define RARA_PIXELS
#include "frame.glsl"
#include "behind.glsl"

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

// Writes a word of a pixel, of the part that begins after so many words of all pixels.
void write_behind(uint at, uint pixel_count, uint words, uint word) {
    picture_words.at[((PIXELS == PIXELS_BYTE ? 1u : 4u) + words) * pixel_count + at] = word;
}

#endif
