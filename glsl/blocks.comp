#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a block finds what view and clip together say about all of its Gaussians.
#define MESHES_BINDING 6
#include "frame.glsl"

layout(local_size_x = BLOCK_GROUP_SIZE) in;
layout(constant_id = 0) const bool CLIP = false;

BUFFER(readonly, 2, Block, blocks)
BUFFER(readonly, 3, uint, clip_sides)
BUFFER(writeonly, 4, uint, block_sides)
BUFFER(readonly, 5, uint, shortlists)
#include "block_view.glsl"

void main() {
    uint block = LINEAR_GROUP * BLOCK_GROUP_SIZE + gl_LocalInvocationIndex;
    if (block >= CUT.scene.block_count) {
        return;
    }
    enter_layer_of_block(block);
    uint side = block_view_side(blocks.at[block]);
    if (CLIP && side == SIDE_VISIBLE) {
        enter_shortlist(block, 1.0);
        side = block_side_in_view(blocks.at[block], clip_sides.at[block]);
        side |= side == SIDE_CUTOFF ? WHOLLY_IN_VIEW : 0u;
    }
    block_sides.at[block] = side;
}
