#version 460
#extension GL_GOOGLE_include_directive : require
// Counts how many splats of each batch are in each tile of its macro-tile, and marks the tiles in which several surfaces cut
// one of them.
// True where tiles have a pipeline without code for several surfaces: an exact cut by more than one, or by one that bends.
layout(constant_id = 0) const bool SEVERAL = false;
#define NEEDS_SPLATS SEVERAL
#include "batch_tiles.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(writeonly, 7, uint, tile_counts)
BUFFER(readonly, 8, vec4, cut_records)

// A bit for each splat of the batch that several surfaces cut.
shared uint several[BATCH_WORDS];

bool is_cut_by_several(uint splat) {
    vec3 linear = vec3(SPLAT_CONIC(splat).zw, SPLAT_COLOUR(splat).w);
    if (!(linear.x < -Z_RANGE)) {
        return false; // whole, or one surface that the splat carries
    }
    uint flags = to_uint(cut_records.at[record_number(linear.x) * EYE.weight.cut_stride].w);
    return flags >> CUT_COUNT_SHIFT != 1u || (flags & CUT_COMBINED) != 0u; // none, where two stages disagree by rounding, is weighed as several are
}

void find_several(uint count) {
    if (gl_LocalInvocationIndex < BATCH_WORDS) {
        several[gl_LocalInvocationIndex] = 0u;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < count; i += RADIX_GROUP_SIZE) {
        if (is_cut_by_several(batch_splats[i])) {
            atomicOr(several[i / 32u], 1u << i % 32u);
        }
    }
    barrier();
}

void main() {
    uint number = LINEAR_GROUP;
    if (number >= counts.at[0].batch_groups.w) {
        return;
    }
    Batch batch = batch_of(number);
    if (batch.pairs.x == batch.pairs.y) {
        return;
    }
    find_held(batch);
    if (SEVERAL) {
        find_several(batch.pairs.y - batch.pairs.x);
    }
    uint tile = gl_LocalInvocationIndex;
    if (tile < MACRO_TILES) {
        uint count = 0u;
        uint mark = 0u;
        for (uint word = 0u; word < BATCH_WORDS; word++) {
            uint bits = held[held_place(word, tile)];
            count += bitCount(bits);
            mark |= SEVERAL && (bits & several[word]) != 0u ? SEVERAL_TILE : 0u;
        }
        tile_counts.at[tile_count_place(number, tile)] = count | mark;
    }
}
