#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that the clip may cut finds the side of each of its Gaussians, the paper's three classes
// (section 3.2), whatever the camera sees of it. (Classify adds what perspective adds to the band of large splats.) A
// block's masks are eight words of what is visible and eight of what is cut.
#define OF_CUT
#define MESHES_BINDING 6
#include "axes.glsl"
#include "band.glsl"
#define SETS 2u // visible, cut
#include "side_masks.glsl"

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER_OF(readonly, 3, block_list, uvec4 groups; uint at[])
BUFFER(writeonly, 4, uint, clip_masks)
BUFFER(readonly, 5, uint, shortlists)
#include "region/gaussian_side.glsl"

uint side_in_clip(Gaussian gaussian) {
    return gaussian_side(half_axes(gaussian), gaussian.position_opacity.xyz,
                         band(opacity_extent(opacity_in_layer(gaussian))));
}

void main() {
    uint group = LINEAR_GROUP;
    bool is_block = group < block_list.groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    enter_shortlist(block, 1.0);
    uint length = is_block ? block_length(block) : 0u;
    begin_masks();
    for (uint turn = 0u; turn < TURNS; turn++) {
        uint local = local_in_turn(turn);
        if (local < length) {
            uint side = side_in_clip(gaussians.at[block * BLOCK_SIZE + local]);
            add_to_masks(turn, side == SIDE_VISIBLE ? 1u : side == SIDE_CUTOFF ? 2u : 0u);
        }
        if (TURNS == 1u) {
            break;
        }
    }
    end_masks();
    for (uint word = gl_LocalInvocationIndex; is_block && word < SETS * WORDS; word += gl_WorkGroupSize.x) {
        clip_masks.at[block * SETS * WORDS + word] = set_masks[word];
    }
}
