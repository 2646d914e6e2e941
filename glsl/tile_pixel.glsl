// Where the fragment shaders that draw the tiles' picture find a pixel. Their parameters have the origin of the picture.
#ifndef RARA_TILE_PIXEL
#define RARA_TILE_PIXEL
#include "frame.glsl"
#include "behind.glsl"

BUFFER(readonly, 1, vec4, picture)

layout(location = 0) flat in uvec2 filled; // of this quad's tiles, as composite.vert says

// The pixel's number, where its tile holds anything.
bool find_pixel(out uint at) {
    vec2 pixel_centre = gl_FragCoord.xy - push.params.origin;
    uvec2 size = uvec2(VIEW.size.xy);
    uvec2 pixel = min(uvec2(pixel_centre), size - 1u);
    uvec2 tile = pixel / uvec2(TILE_WIDTH, TILE_HEIGHT) % QUAD_TILES;
    uint bit = tile.y * QUAD_TILES + tile.x;
    at = pixel.y * size.x + pixel.x;
    return ((bit < 32u ? filled.x : filled.y) >> bit % 32u & 1u) != 0u;
}

// A word of a pixel, of the part that begins after so many words of all pixels.
uint behind(uint at, uint words) {
    uint place = (4u + words) * uint(VIEW.size.x) * uint(VIEW.size.y) + at;
    return floatBitsToUint(picture.at[place / 4u][place % 4u]);
}

#endif
