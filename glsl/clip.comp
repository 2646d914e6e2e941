#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that the clip may cut, one invocation a Gaussian, which finds its side, the paper's three classes
// (section 3.2), whatever the camera sees of it. (Classify adds what perspective adds to the band of large splats.) A
// block's masks are eight words of what is visible and eight of what is cut.
#include "band.glsl"
#include "masks.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, block_list)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(writeonly, 5, uint, clip_masks)
BUFFER(readonly, 6, uint, shortlists)
#include "region/gaussian_side.glsl"

shared uint masks[2u * WORDS];

void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < 2u * WORDS) {
        masks[local] = 0u;
    }
    barrier();
    uint group = LINEAR_GROUP;
    bool is_block = group < counts.at[0].clip_groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    enter_shortlist(block, 1.0);
    if (is_block && local < block_length(block)) {
        Gaussian gaussian = gaussians.at[block * BLOCK_SIZE + local];
        uint side = gaussian_side(half_axes(gaussian), gaussian.position_opacity.xyz,
                                  band(opacity_extent(opacity_in_layer(gaussian))));
        if (side >= SIDE_VISIBLE) {
            // A union does not depend on the order of the atomics.
            atomicOr(masks[(side == SIDE_CUTOFF ? WORDS : 0u) + (local >> 5)], 1u << (local & 31u));
        }
    }
    barrier();
    if (is_block && local < 2u * WORDS) {
        clip_masks.at[block * 2u * WORDS + local] = masks[local];
    }
}
