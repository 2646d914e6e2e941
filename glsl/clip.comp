#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that the clip may cut, one invocation a Gaussian, which finds its side, the paper's three classes
// (section 3.2), whatever the camera sees of it. (Classify adds what perspective adds to the band of large splats.) A
// block's masks are eight words of what is visible and eight of what is cut.
#include "band.glsl"
#define SETS 2u // visible, cut
#include "side_masks.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, block_list)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(writeonly, 5, uint, clip_masks)
BUFFER(readonly, 6, uint, shortlists)
#include "region/gaussian_side.glsl"

void main() {
    uint local = gl_LocalInvocationIndex;
    uint group = LINEAR_GROUP;
    bool is_block = group < counts.at[0].clip_groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    enter_shortlist(block, 1.0);
    uint sets = 0u;
    if (is_block && local < block_length(block)) {
        Gaussian gaussian = gaussians.at[block * BLOCK_SIZE + local];
        uint side = gaussian_side(half_axes(gaussian), gaussian.position_opacity.xyz,
                                  band(opacity_extent(opacity_in_layer(gaussian))));
        sets = side == SIDE_VISIBLE ? 1u : side == SIDE_CUTOFF ? 2u : 0u;
    }
    find_masks(sets);
    if (is_block && local < 2u * WORDS) {
        clip_masks.at[block * 2u * WORDS + local] = set_masks[local];
    }
}
