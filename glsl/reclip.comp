#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block between the clip's old and new surface finds the side of each of its Gaussians now, and whether
// what the rasteriser holds of it has to change.
#define MESHES_BINDING 9
#include "beam.glsl"
#include "reclip.glsl"
#define SETS 4u // visible, cut, invisible, and those of which what the rasteriser holds changes
#include "side_masks.glsl"

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER_OF(readonly, 3, block_list, uvec4 groups; uint at[])
BUFFER(readonly, 4, uint, revisits)
BUFFER(readonly, 5, uint, block_sides)
BUFFER(readonly, 6, uint, masks)
BUFFER(, 7, uint, reclips)
BUFFER(readonly, 8, uint, shortlists)
#include "region/gaussian_side.glsl"

uint gaussian_side_before(uint block, uint local) {
    uint side = block_side_before(revisits.at[block]);
    if (side != SIDE_CUTOFF) {
        return side;
    }
    uint word = block * RECLIP_WORDS + (local >> 5);
    return side_of(reclips.at[word + RECLIP_VISIBLE], reclips.at[word + RECLIP_CUT], local);
}

uint gaussian_side_now(uint block, uint index) {
    uint side = reclips.at[block * RECLIP_WORDS + RECLIP_SIDE];
    if (side != SIDE_CUTOFF) {
        return side;
    }
    Gaussian gaussian = gaussians.at[index];
    Footprint f = footprint(gaussian);
    float extent = opacity_extent(opacity_in_layer(gaussian));
    float deviations = band_in_view(f, largest(gaussian.scale.xyz), extent);
    enter_shortlist(block, deviations / band(extent));
    return gaussian_side(f.axes, gaussian.position_opacity.xyz, deviations);
}

bool is_in_view(uint block, uint local) {
    uint side = block_sides.at[block] & SIDE_BITS;
    return side == SIDE_VISIBLE
        || (side == SIDE_CUTOFF && (masks.at[block * 2u * WORDS + (local >> 5)] & 1u << (local & 31u)) != 0u);
}

void main() {
    uint group = LINEAR_GROUP;
    bool is_block = group < block_list.groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    uint length = is_block ? block_length(block) : 0u;
    begin_masks();
    for (uint turn = 0u; turn < TURNS; turn++) {
        uint local = local_in_turn(turn);
        if (local < length && is_in_view(block, local)) {
            uint before = gaussian_side_before(block, local);
            uint now = gaussian_side_now(block, block * BLOCK_SIZE + local);
            uint sets = now == SIDE_VISIBLE ? 1u : now == SIDE_CUTOFF ? 2u : 4u;
            add_to_masks(turn, sets | (now != before || now == SIDE_CUTOFF ? 8u : 0u));
        }
        if (TURNS == 1u) {
            break;
        }
    }
    end_masks();
    if (!is_block) {
        return;
    }
    uint local = gl_LocalInvocationIndex;
    uint base = block * RECLIP_WORDS;
    if (local < WORDS) {
        reclips.at[base + RECLIP_VISIBLE + local] = set_masks[local];
        reclips.at[base + RECLIP_CUT + local] = set_masks[WORDS + local];
        reclips.at[base + RECLIP_CHANGED + local] = set_masks[3u * WORDS + local];
    }
    if (local < SETS) {
        reclips.at[base + RECLIP_TOTALS + local] = set_count(local);
    }
}
