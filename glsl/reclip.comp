#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block between the clip's old and new surface, one invocation a Gaussian, which finds its side now, and
// whether what the rasteriser holds of it has to change.
#include "band.glsl"
#include "reclip.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, block_list)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(readonly, 5, uint, revisits)
BUFFER(readonly, 6, uint, block_sides)
BUFFER(readonly, 7, uint, masks)
BUFFER(, 8, uint, reclips)
BUFFER(readonly, 9, uint, shortlists)
#include "region/gaussian_side.glsl"

shared uint visible_mask[WORDS];
shared uint cut_mask[WORDS];
shared uint invisible_mask[WORDS];
shared uint changed_mask[WORDS];

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
    uint side = block_sides.at[block];
    return side == SIDE_VISIBLE
        || (side == SIDE_CUTOFF && (masks.at[block * 2u * WORDS + (local >> 5)] & 1u << (local & 31u)) != 0u);
}

void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < WORDS) {
        visible_mask[local] = 0u;
        cut_mask[local] = 0u;
        invisible_mask[local] = 0u;
        changed_mask[local] = 0u;
    }
    barrier();
    uint group = LINEAR_GROUP;
    bool is_block = group < counts.at[0].clip_groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    if (is_block && local < block_length(block) && is_in_view(block, local)) {
        uint index = block * BLOCK_SIZE + local;
        uint before = gaussian_side_before(block, local);
        uint now = gaussian_side_now(block, index);
        uint word = local >> 5;
        uint bit = 1u << (local & 31u);
        // Unions do not depend on the order of the atomics.
        if (now == SIDE_VISIBLE) {
            atomicOr(visible_mask[word], bit);
        } else if (now == SIDE_CUTOFF) {
            atomicOr(cut_mask[word], bit);
        } else {
            atomicOr(invisible_mask[word], bit);
        }
        if (now != before || now == SIDE_CUTOFF) {
            atomicOr(changed_mask[word], bit);
        }
    }
    barrier();
    if (!is_block) {
        return;
    }
    uint base = block * RECLIP_WORDS;
    if (local < WORDS) {
        reclips.at[base + RECLIP_CHANGED + local] = changed_mask[local];
        reclips.at[base + RECLIP_VISIBLE + local] = visible_mask[local];
        reclips.at[base + RECLIP_CUT + local] = cut_mask[local];
    }
    if (local == 0u) {
        uvec4 totals = uvec4(0u);
        for (uint word = 0u; word < WORDS; word++) {
            totals += uvec4(bitCount(visible_mask[word]), bitCount(cut_mask[word]), bitCount(invisible_mask[word]),
                            bitCount(changed_mask[word]));
        }
        for (uint k = 0u; k < 4u; k++) {
            reclips.at[base + RECLIP_TOTALS + k] = totals[k];
        }
    }
}
