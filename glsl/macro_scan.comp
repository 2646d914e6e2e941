#version 460
#extension GL_GOOGLE_include_directive : require
// The second step of binning for GPUs finds where the pairs of each chunk of splats begin, and whether they have room. Each
// workgroup adds up the partitions before its own by itself.
#include "macro_tiles.glsl"
#include "radix.glsl"
#include "workgroup_sum.glsl"
#include "groups.glsl"

layout(local_size_x = RADIX_GROUP_SIZE) in;

BUFFER(, 1, FrameCounts, counts)
BUFFER(writeonly, 2, uint, chunk_begins)
BUFFER(readonly, 3, uint, pair_sums)

void main() {
    uint local = gl_LocalInvocationIndex;
    uint p = gl_WorkGroupID.x;
    uint my_before = 0u;
    uint my_all = 0u;
    for (uint i = local; i < PARTITIONS; i += RADIX_GROUP_SIZE) {
        uint sum = pair_sums.at[i];
        my_before += i < p ? sum : 0u;
        my_all = capped_sum(my_all, sum);
    }
    uint all = capped_total(my_all);
    bool has_room = all <= EYE.room.pair_capacity;
    if (p == 0u && local == 0u) {
        counts.at[0].excess_pairs = has_room ? 0u : all;
        counts.at[0].macro_pairs = has_room ? all : 0u;
        uint partitions = has_room ? (all + RADIX_PARTITION - 1u) / RADIX_PARTITION : 0u;
        counts.at[0].pair_groups = uvec4(partitions, 1u, 1u, 0u);
        uint batches = (all + BATCH_SPLATS - 1u) / BATCH_SPLATS + macro_tile_count();
        // Without pairs no macro-tile's beginning is known.
        counts.at[0].batch_groups = has_room && all > 0u ? groups(batches, 1u) : uvec4(0u, 1u, 1u, 0u);
    }
    if (!has_room) {
        return;
    }
    uint before;
    exclusive_sum(my_before, before);
    if (local < CHUNKS) {
        for (uint chunk = 0u; chunk < CHUNKS; chunk++) {
            uint sum = pair_sums.at[CHUNK_SUM_PLACE(p, chunk)];
            before += chunk < local ? sum : 0u;
        }
        // A few splats make fewer chunks, and there is no room for more.
        uint place = p * CHUNKS + local;
        if (place * CHUNK_SPLATS < KEY_COUNT) {
            chunk_begins.at[place] = before;
        }
    }
}
