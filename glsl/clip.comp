#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that the clip may cut, one invocation a Gaussian: the paper's three classes (section 3.2), whatever
// the camera sees of it. (What perspective adds to the band of large splats, classify does.) A block's masks are eight words of what is visible and eight of what is cut.
#include "masks.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 1, Gaussian, gaussians)
BUFFER(readonly, 2, uint, block_list)
BUFFER(readonly, 3, FrameCounts, counts)
BUFFER(writeonly, 4, uint, clip_masks)

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
    uint index = block * BLOCK_SIZE + local;
    if (is_block && index < FRAME.scene.gaussian_count) {
        Gaussian gaussian = gaussians.at[index];
        uint side = gaussian_side(world_factor(gaussian), gaussian.position_opacity.xyz,
                              band(opacity_extent(gaussian.position_opacity.w)));
        if (side >= SIDE_VISIBLE) {
            // A union does not depend on the order of atomics.
            atomicOr(masks[(side == SIDE_CUTOFF ? WORDS : 0u) + (local >> 5)], 1u << (local & 31u));
        }
    }
    barrier();
    if (is_block && local < 2u * WORDS) {
        clip_masks.at[block * 2u * WORDS + local] = masks[local];
    }
}
