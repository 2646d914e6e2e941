#version 460
#extension GL_GOOGLE_include_directive : require
// Reads the tiles' picture, which is blended onto what the host has drawn.
struct Params {
    vec2 origin; // where the viewport begins in the attachment, px
};
#define PARAMS Params
#include "frame.glsl"

BUFFER(readonly, 1, vec4, picture)

layout(location = 0) flat in uvec2 filled; // of this quad's tiles, as composite.vert says
layout(location = 0) out vec4 colour;

void main() {
    vec2 pixel_centre = gl_FragCoord.xy - push.params.origin;
    uvec2 size = uvec2(FRAME.view.size.xy);
    uvec2 pixel = min(uvec2(pixel_centre), size - 1u);
    uvec2 tile = pixel / uvec2(TILE_WIDTH, TILE_HEIGHT) % QUAD_TILES;
    uint bit = tile.y * QUAD_TILES + tile.x;
    bool is_filled = ((bit < 32u ? filled.x : filled.y) >> bit % 32u & 1u) != 0u;
    colour = vec4(0.0);
    if (is_filled) {
        colour = picture.at[pixel.y * size.x + pixel.x];
    }
}
