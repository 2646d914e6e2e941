// Where the fragment shaders that draw the tiles' picture find a pixel.
#ifndef RARA_COMPOSITE
#define RARA_COMPOSITE
struct Params {
    vec2 origin; // where the viewport begins in the attachment, px
    float unit; // what depths are multiplied by
    float depth_offset; // what the host's depth buffer holds for a depth: see host_depth.glsl
    float depth_scale;
};
#define PARAMS Params
#include "frame.glsl"

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

// Where what lies behind all pixels begins.
uint pixels_end() {
    return uint(VIEW.size.x) * uint(VIEW.size.y);
}

#endif
