// The vertex shader of what is drawn of the tiles' picture: one quad for QUAD_TILES x QUAD_TILES tiles. A quad whose tiles all hold
// nothing blends nothing.
#ifndef RARA_FILLED_QUADS
#define RARA_FILLED_QUADS
#include "frame.glsl"

#ifdef RARA_MULTIVIEW
// The view of the scope that the picture is drawn into. In the others no quad has an area.
layout(constant_id = 3) const uint SCOPE_VIEW = 0u;
#define IS_IN_VIEW (uint(gl_ViewIndex) == SCOPE_VIEW)
#else
#define IS_IN_VIEW true
#endif

BUFFER(readonly, 2, uint, tile_begins)

layout(location = 0) flat out uvec2 filled; // tiles that hold anything, a bit each, row by row

void main() {
    uint quad = uint(gl_VertexIndex) / 6u;
    uvec2 tiles = uvec2(EYE.tiles.tile_columns, tile_rows());
    uint columns = (tiles.x + QUAD_TILES - 1u) / QUAD_TILES;
    uvec2 first = uvec2(quad % columns, quad / columns) * QUAD_TILES;
    filled = uvec2(0u);
    for (uint row = 0u; IS_IN_VIEW && row < QUAD_TILES && first.y + row < tiles.y; row++) {
        uint tile = (first.y + row) * tiles.x + first.x;
        uint begin = tile_begins.at[tile];
        uint bits = 0u;
        for (uint column = 0u; column < min(QUAD_TILES, tiles.x - first.x); column++) {
            uint end = tile_begins.at[tile + column + 1u];
            bits |= begin < end ? 1u << column : 0u;
            begin = end;
        }
        uint bit = row * QUAD_TILES;
        bits <<= bit % 32u;
        filled |= bit < 32u ? uvec2(bits, 0u) : uvec2(0u, bits);
    }
    // All quads are one strip, of which each has six vertices: its first and last corner come twice, so that the triangles
    // between two quads have no area. A quad that holds nothing has no area either.
    uint corner = filled == uvec2(0u) ? 0u : uint(clamp(gl_VertexIndex % 6 - 1, 0, 3));
    vec2 pixel = vec2((first + QUAD_TILES * uvec2(corner & 1u, corner >> 1u)) * uvec2(TILE_WIDTH, TILE_HEIGHT));
    gl_Position = vec4(2.0 * pixel * VIEW.size.zw - 1.0, 0.0, 1.0);
}

#endif
