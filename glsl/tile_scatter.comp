#version 460
#extension GL_GOOGLE_include_directive : require
// In the last step of binning each part of a row writes its splats, front to back, to the places of their tiles.
#include "rows.glsl"

layout(local_size_x = ROW_GROUP_SIZE) in;

BUFFER(readonly, 3, uint, span_splats)
BUFFER(readonly, 4, uint, span_columns)
BUFFER(readonly, 5, FrameCounts, counts)
BUFFER(writeonly, 6, uint, tile_splats)

void main() {
    uint part = gl_GlobalInvocationID.x;
    if (part >= part_count()) {
        return;
    }
    uint first = columns_place(part);
    uint pairs = counts.at[0].pairs;
    uvec2 bounds = part_bounds(part);
    for (uint i = bounds.x; i < bounds.y; i++) {
        uint splat = span_splats.at[i];
        uvec2 columns = columns_of(span_columns.at[i]);
        for (uint column = columns.x; column < columns.y; column++) {
            uint place = column_counts.at[first + column];
            column_counts.at[first + column] = place + 1u;
            if (place < pairs) { // it is, while the first and the third step find the same spans
                tile_splats.at[place] = splat;
            }
        }
    }
}
