#version 460
#extension GL_GOOGLE_include_directive : require
// The second step of binning, one workgroup with an invocation for each row of tiles, finds where each run's spans of each
// row begin, how many pairs of tile and splat there are, and whether there is room for them. If not, coarse lists are written
// instead.
#include "bin.glsl"
#include "capped_sum.glsl"
#include "groups.glsl"

const uint ROWS = 256u; // at a time
layout(local_size_x = ROWS) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(, 2, uint, span_counts)
BUFFER(writeonly, 3, uint, row_begins)
#include "room.glsl"

shared uint totals[ROWS];

void main() {
    uint local = gl_LocalInvocationIndex;
    // Without splats nothing was counted, and the counts are another frame's.
    uint runs = counts.at[0].mesh_groups.w == 0u ? 0u : EYE.tiles.span_runs;
    uint own_pairs = 0u;
    for (uint run = local; run < runs; run += ROWS) {
        own_pairs = capped_sum(own_pairs, span_counts.at[pairs_place(run)]);
    }
    totals[local] = own_pairs;
    barrier();
    uint pairs = 0u;
    for (uint i = 0u; i < ROWS; i++) {
        pairs = capped_sum(pairs, totals[i]);
    }
    uint rows = tile_rows();
    uint begin = 0u;
    for (uint first = 0u; first < rows; first += ROWS) {
        uint row = first + local;
        uint total = 0u;
        for (uint run = 0u; run < runs && row < rows; run++) {
            total += span_counts.at[run * rows + row];
        }
        barrier();
        totals[local] = total;
        barrier();
        uint place = begin;
        for (uint i = 0u; i < ROWS; i++) {
            place += i < local ? totals[i] : 0u;
            begin += totals[i];
        }
        if (row < rows) {
            row_begins.at[row] = place;
        }
        for (uint run = 0u; run < runs && row < rows; run++) {
            uint count = span_counts.at[run * rows + row];
            span_counts.at[run * rows + row] = place;
            place += count;
        }
    }
    if (local == 0u) {
        row_begins.at[rows] = begin;
        bool has_room = decide_room(pairs);
        counts.at[0].span_groups = has_room ? groups(EYE.tiles.span_runs, SPAN_GROUP_SIZE) : uvec4(0u);
        counts.at[0].part_groups = has_room ? groups(rows * EYE.tiles.row_parts, ROW_GROUP_SIZE) : uvec4(0u);
        counts.at[0].row_groups = has_room ? groups(rows, ROW_GROUP_SIZE) : uvec4(0u);
        counts.at[0].coarse_groups = has_room ? uvec4(0u) : groups(counts.at[0].mesh_groups.w, COARSE_GROUP_SIZE);
    }
}
