#version 460
#extension GL_GOOGLE_include_directive : require
// In the third step of binning each run writes its spans, front to back, to the places of their rows.
#include "bin.glsl"

layout(local_size_x = SPAN_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, vec4, splats)
BUFFER(readonly, 3, uint, order)
BUFFER(, 4, uint, span_counts)
BUFFER(writeonly, 5, uint, span_splats)
BUFFER(writeonly, 6, uint, span_columns)
BUFFER(readonly, 7, uint, mask_origins)
BUFFER(readonly, 8, uint, masks_above)
BUFFER(readonly, 9, uint, masks_below)
#include "splat_at.glsl"

void put(uint slot, uvec2 columns, uint splat) {
    uint place = span_counts.at[slot];
    span_counts.at[slot] = place + 1u;
    if (place >= counts.at[0].pairs) {
        return; // cannot be, while both steps find the same spans
    }
    span_splats.at[place] = splat;
    span_columns.at[place] = columns.x | columns.y << 16;
}

void main() {
    uint run = gl_GlobalInvocationID.x;
    uint rows = tile_rows();
    uvec2 bounds = run_bounds(run, EYE.tiles.span_runs, counts.at[0].visible + counts.at[0].cutoff);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint splat = order.at[i];
        uint origin = mask_origins.at[i];
        uvec2 words = uvec2(masks_above.at[i], masks_below.at[i]);
        for (uvec2 mask = origin != NO_MASK ? words : uvec2(0u); (mask.x | mask.y) != 0u;) {
            Span span = next_span(origin, mask);
            put(run * rows + span.row, span.columns, splat);
        }
        if (origin != NO_MASK) {
            continue;
        }
        Outline o = bounded_outline(splat_at(splat), words);
        for (uint row = o.rows.x; row < o.rows.y; row++) {
            uvec2 columns = tiles_in_row(o, row);
            if (columns.x < columns.y) {
                put(run * rows + row, columns, splat);
            }
        }
    }
}
