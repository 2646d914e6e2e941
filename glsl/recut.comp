#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a splat that a moved clip changes computes what of it depends on the clip, and marks the tiles to draw
// again. The splat's centre, colour, depth and tiles stay.
#include "footprint.glsl"
#include "quad.glsl"
#include "rects.glsl"

layout(local_size_x = SPLAT_GROUP_SIZE) in;
// True when tiles are wanted.
layout(constant_id = 0) const bool TILES = false;
// True when quads are drawn.
layout(constant_id = 1) const bool QUADS = false;
// True where rectangles of tiles are kept, and masks only where these do not tell everything.
layout(constant_id = 2) const bool RECTS = false;

BUFFER(readonly, 1, Gaussian, gaussians)
BUFFER(readonly, 2, uint, splat_gaussians)
BUFFER(readonly, 3, FrameCounts, counts)
BUFFER(readonly, 4, uvec2, recuts)
BUFFER(readonly, 5, vec4, cut_records)
BUFFER(readonly, 6, uvec4, tile_masks)
BUFFER(, 7, vec4, splats)
BUFFER(writeonly, 8, uint, dirty)
BUFFER(writeonly, 9, Quad, quads)
#include "splat_at.glsl"
#include "carried.glsl"

// All that find a tile changed write the same value. The tiles are the whole splat's, as in the lists.
void mark(uint splat_index) {
    uint word = RECTS ? RECT_WORD(tile_masks, splat_index) : RECT_LARGE;
    if (!needs_mask(word)) {
        Rect rect = word == RECT_NONE ? NO_RECT : rect_of_word(word);
        for (uint row = 0u; row < rect.size.y; row++) {
            uint first = (rect.first.y + row) * EYE.tiles.tile_columns + rect.first.x;
            for (uint tile = first; tile < first + rect.size.x; tile++) {
                dirty.at[tile] = 1u;
            }
        }
        return;
    }
    uvec4 tiles = tile_masks.at[splat_index];
    for (uvec2 mask = tiles.y == 0u ? tiles.zw : uvec2(0u); (mask.x | mask.y) != 0u;) {
        Span span = next_span(tiles.x, mask);
        uvec2 columns = span.columns + span.row * EYE.tiles.tile_columns;
        for (uint tile = columns.x; tile < columns.y; tile++) {
            dirty.at[tile] = 1u;
        }
    }
    if (tiles.y != 0u) {
        Splat splat = splat_at(splat_index);
        splat.conic_cut.z = Z_WHOLE;
        Outline o = bounded_outline(splat, tiles.zw);
        for (uint row = o.rows.x; row < o.rows.y; row++) {
            uvec2 columns = tiles_in_row(o, row) + row * EYE.tiles.tile_columns;
            for (uint tile = columns.x; tile < columns.y; tile++) {
                dirty.at[tile] = 1u;
            }
        }
    }
}

void main() {
    uint change = LINEAR_GROUP * SPLAT_GROUP_SIZE + gl_LocalInvocationIndex;
    if (change >= counts.at[0].recut_groups.w) {
        return;
    }
    uint splat_index = recuts.at[change].x;
    uint cut = recuts.at[change].y;
    uint index = splat_gaussians.at[splat_index];
    enter_layer_of_block(index / BLOCK_SIZE);
    Gaussian gaussian = gaussians.at[index];
    Footprint f = footprint(gaussian);
    Carried weight = whole_weight();
    if (cut < CUT_AWAY) {
        weight = carried_weight(cut);
    }
    if (TILES) {
        mark(splat_index);
    }
    Quad quad = Quad(vec2(0.0), vec2(0.0), vec2(0.0));
    if (cut == CUT_AWAY) {
        // The quad holds nothing to rasterise; tiles look at z.
        weight.linear.x = Z_CUT_AWAY;
    } else if (QUADS) {
        quad = quad_around(f, opacity_extent(opacity_on_screen(f, gaussian)), weight);
    }
    SPLAT_CONIC(splat_index).zw = weight.linear.xy;
    SPLAT_COLOUR(splat_index).w = weight.linear.z;
    SPLAT_CURVATURE(splat_index).xyz = weight.curvature;
    if (QUADS) {
        quads.at[splat_index] = quad;
    }
}
