#version 460
#extension GL_GOOGLE_include_directive : require
// After a sort of the pairs of macro-tile and splat that took several passes, a workgroup a macro-tile finds where its pairs
// begin; the last one finds where all end. One that has none begins where the next one does.
#include "macro_tiles.glsl"

layout(local_size_x = MACRO_RANGE_GROUP_SIZE) in;

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, uint, macro_keys)
BUFFER(writeonly, 3, uint, macro_begins)

shared uint steps_before;

// The beginning lies between two places; as many places as there are invocations divide what is between them, until nothing is.
void main() {
    uint macro_tile = LINEAR_GROUP;
    if (macro_tile > macro_tile_count()) {
        return;
    }
    uvec2 bounds = uvec2(0u, counts.at[0].macro_pairs);
    while (bounds.x < bounds.y) {
        barrier();
        if (gl_LocalInvocationIndex == 0u) {
            steps_before = 0u;
        }
        barrier();
        uint step = (bounds.y - bounds.x + MACRO_RANGE_GROUP_SIZE - 1u) / MACRO_RANGE_GROUP_SIZE;
        // The last place of each step: those of this macro-tile begin behind it if its own is one before.
        uint place = bounds.x + (gl_LocalInvocationIndex + 1u) * step - 1u;
        if (place < bounds.y && pair_macro_tile(macro_keys.at[place]) < macro_tile) {
            atomicAdd(steps_before, 1u); // the sum does not depend on the order
        }
        barrier();
        bounds.x += steps_before * step;
        bounds.y = min(bounds.x + step - 1u, bounds.y);
    }
    if (gl_LocalInvocationIndex == 0u) {
        macro_begins.at[macro_tile] = bounds.x;
    }
}
