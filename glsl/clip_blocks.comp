#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a block: the side of the clip that it lies on. Depends on the clip alone, not on the camera.
#include "block.glsl"

layout(local_size_x = BLOCK_GROUP_SIZE) in;

BUFFER(readonly, 1, Block, blocks)
BUFFER(writeonly, 2, uint, clip_sides)

void main() {
    uint block = LINEAR_GROUP * BLOCK_GROUP_SIZE + gl_LocalInvocationIndex;
    if (block < FRAME.scene.block_count) {
        clip_sides.at[block] = block_clip_side(blocks.at[block], 1.0);
    }
}
