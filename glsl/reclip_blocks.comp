#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a block finds its side of a clip that has moved while the camera stood still, and whether its Gaussians
// have to be revisited.
struct Params {
    uint fresh; // 1: the frame before knew no clip
};
#define PARAMS Params
#define MESHES_BINDING 8
#include "frame.glsl"
#include "reclip.glsl"

layout(local_size_x = BLOCK_GROUP_SIZE) in;

BUFFER(readonly, 2, Block, blocks)
BUFFER(readonly, 3, uint, block_sides)
BUFFER(readonly, 4, uvec4, block_counts)
BUFFER(writeonly, 5, uint, revisits)
BUFFER(, 6, uint, reclips)
BUFFER(, 7, uint, shortlists)
#include "block_view.glsl"
#include "region/block_shortlist.glsl"

// Blocks only partly in view may hold Gaussians whose band the camera widens by any amount.
uint block_side_now(Block block, uint view_side) {
    uint side = block_clip_side(block, 1.0);
    return view_side == SIDE_VISIBLE ? block_side_in_view(block, side) : may_be_beam(block) ? SIDE_CUTOFF : side;
}

void main() {
    uint block = LINEAR_GROUP * BLOCK_GROUP_SIZE + gl_LocalInvocationIndex;
    if (block >= CUT.scene.block_count) {
        return;
    }
    enter_layer_of_block(block);
    uint base = block * RECLIP_WORDS;
    uint view_side = block_sides.at[block] & SIDE_BITS;
    uint in_view = view_side == SIDE_VISIBLE ? block_length(block) : view_side == SIDE_CUTOFF ? block_counts.at[block].x : 0u;
    uint before = reclips.at[base + RECLIP_SIDE];
    if (push.params.fresh != 0u) {
        before = SIDE_VISIBLE;
        reclips.at[base + RECLIP_TOTALS] = in_view;
        reclips.at[base + RECLIP_TOTALS + 1u] = 0u;
        reclips.at[base + RECLIP_TOTALS + 2u] = 0u;
    }
    if (SHORTLISTED) {
        write_shortlist(block, blocks.at[block]);
        enter_shortlist(block, 1.0);
    }
    uint now = in_view == 0u ? SIDE_VISIBLE : block_side_now(blocks.at[block], view_side);
    reclips.at[base + RECLIP_SIDE] = now;
    revisits.at[block] = now == SIDE_CUTOFF || now != before ? SIDE_CUTOFF | before << 2 : SIDE_CULLED;
}
