#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a revisited block, one invocation a Gaussian, writes the lists of the splats that change and of the
// Gaussians that are cut, in the order of the scene.
#include "reclip.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER_OF(readonly, 1, block_list, uvec4 groups; uint at[])
BUFFER(readonly, 2, uint, block_sides)
BUFFER(readonly, 3, uint, masks)
BUFFER(readonly, 4, uvec2, block_offsets)
BUFFER(readonly, 5, uint, reclips)
BUFFER(writeonly, 6, uvec2, recuts)
BUFFER(writeonly, 7, uint, cutoffs)

void main() {
    uint group = LINEAR_GROUP;
    uint local = gl_LocalInvocationIndex;
    if (group >= block_list.groups.w) {
        return;
    }
    uint block = block_list.at[group];
    uint base = block * RECLIP_WORDS;
    uint bit = 1u << (local & 31u);
    if ((reclips.at[base + RECLIP_CHANGED + (local >> 5)] & bit) == 0u) {
        return;
    }
    uint view_base = block * 2u * WORDS;
    bool is_whole = block_sides.at[block] == SIDE_VISIBLE;
    uint splat_index = block_offsets.at[block].x + (is_whole ? local : 0u);
    uint place = reclips.at[base + RECLIP_PLACES];
    uint cut = reclips.at[base + RECLIP_PLACES + 1u];
    for (uint word = 0u; word <= local >> 5; word++) {
        place += bits_before(reclips.at[base + RECLIP_CHANGED + word], word, local);
        cut += bits_before(reclips.at[base + RECLIP_CUT + word], word, local);
        splat_index += is_whole ? 0u : bits_before(masks.at[view_base + word], word, local);
    }
    bool is_cut = (reclips.at[base + RECLIP_CUT + (local >> 5)] & bit) != 0u;
    bool is_visible = (reclips.at[base + RECLIP_VISIBLE + (local >> 5)] & bit) != 0u;
    if (is_cut) {
        cutoffs.at[cut] = block * BLOCK_SIZE + local;
    }
    recuts.at[place] = uvec2(splat_index, is_cut ? cut : is_visible ? NOT_CUT : CUT_AWAY);
}
