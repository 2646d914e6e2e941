#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a block finds on which side of the clip it lies, which depends on the clip alone, not on the camera. The
// blocks of a hidden layer count as invisible, so that none of their Gaussians is looked at.
#define OF_CUT
#define MESHES_BINDING 5
#include "frame.glsl"

layout(local_size_x = BLOCK_GROUP_SIZE) in;

BUFFER(readonly, 2, Block, blocks)
BUFFER(writeonly, 3, uint, clip_sides)
BUFFER(, 4, uint, shortlists)
#include "region/block_shortlist.glsl"

void main() {
    uint block = LINEAR_GROUP * BLOCK_GROUP_SIZE + gl_LocalInvocationIndex;
    if (block < CUT.scene.block_count) {
        enter_layer_of_block(block);
        if (SHORTLISTED) {
            write_shortlist(block, blocks.at[block]);
            enter_shortlist(block, 1.0);
        }
        bool is_hidden = LAYER.content.visible == 0u;
        clip_sides.at[block] = is_hidden ? SIDE_INVISIBLE : block_clip_side(blocks.at[block], 1.0);
    }
}
