#version 460
#extension GL_GOOGLE_include_directive : require
// Second step of binning, one workgroup, a digit an invocation: where each run's pairs of each digit begin, how many there
// are, and whether there is room for them. If not, the frame's quads are drawn instead.
#include "sort.glsl"

layout(local_size_x = DIGITS) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(, 2, uint, histogram)

shared uint totals[DIGITS];

// Sums that stay at the largest number instead of turning over.
uint capped_sum(uint a, uint b) {
    return a > ~0u - b ? ~0u : a + b;
}

void main() {
    uint d = gl_LocalInvocationIndex;
    // Without survivors nothing was counted, and the histogram is another frame's.
    uint runs = counts.at[0].mesh_groups.w == 0u ? 0u : FRAME.sort_runs;
    uint total = 0u;
    for (uint run = 0u; run < runs; run++) {
        total = capped_sum(total, histogram.at[run * DIGITS + d]);
    }
    totals[d] = total;
    barrier();
    uint place = 0u;
    for (uint before = 0u; before < d; before++) {
        place = capped_sum(place, totals[before]);
    }
    uint pairs = capped_sum(place, total);
    for (uint run = 0u; run < runs; run++) {
        uint count = histogram.at[run * DIGITS + d];
        histogram.at[run * DIGITS + d] = place;
        place += count;
    }
    if (d == DIGITS - 1u) {
        bool tiled = pairs <= FRAME.pair_capacity;
        uint strip_tiles = STRIP_ROWS * FRAME.tile_columns;
        uint strips = (FRAME.tile_count + strip_tiles - 1u) / strip_tiles;
        counts.at[0].pairs = pairs;
        counts.at[0].tiled = tiled ? 1u : 0u;
        counts.at[0].pair_groups = uvec4(tiled ? FRAME.sort_runs / SORT_GROUP_SIZE : 0u, 1u, 1u, 0u);
        counts.at[0].tile_groups = uvec4(tiled ? strip_tiles : 0u, strips, 1u, 0u);
        uvec2 tiles = uvec2(FRAME.tile_columns, FRAME.tile_count / FRAME.tile_columns);
        uvec2 quads = (tiles + QUAD_TILES - 1u) / QUAD_TILES;
        counts.at[0].composite = uvec4(6u * quads.x * quads.y, tiled ? 1u : 0u, 0u, 0u);
        if (tiled || FRAME.redrawn != 0u) {
            counts.at[0].draw.y = 0u;
        }
    }
}
