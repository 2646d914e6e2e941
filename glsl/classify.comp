#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that neither view nor clip settles as a whole, one invocation a Gaussian. It culls by footprint,
// opacity and size, and finds the side of what is in view. It writes two bits a Gaussian (survives, is cut) and the
// block's totals; compact turns them into ordered lists.
#include "band.glsl"
#include "masks.glsl"

layout(local_size_x = BLOCK_SIZE) in;
layout(constant_id = 0) const bool CLIP = false;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, block_list)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(readonly, 5, uint, clip_sides)
BUFFER(readonly, 6, uint, clip_masks)
BUFFER(writeonly, 7, uint, masks)
BUFFER(writeonly, 8, uvec4, block_counts)
BUFFER(readonly, 9, uint, shortlists)
#include "region/gaussian_side.glsl"

shared uint splat_mask[WORDS];
shared uint cutoff_mask[WORDS];
shared uint visible_count;
shared uint cutoff_count;
shared uint invisible_count;

// True when some pixel centre lies in the splat's bounding box and in the picture.
bool covers_a_pixel(vec2 centre, vec2 half_sides) {
    vec2 low = max(ceil(centre - half_sides - 0.5), vec2(0.0));
    vec2 high = min(floor(centre + half_sides - 0.5), VIEW.size.xy - 1.0);
    return low.x <= high.x && low.y <= high.y;
}

// The side that stage clip has found.
uint clip_stage_side(uint block, uint local) {
    uint side = clip_sides.at[block];
    if (side != SIDE_CUTOFF) {
        return side;
    }
    uint word = block * 2u * WORDS + (local >> 5);
    return side_of(clip_masks.at[word], clip_masks.at[word + WORDS], local);
}

uint classify(uint block, uint local) {
    uint index = block * BLOCK_SIZE + local;
    Gaussian gaussian = gaussians.at[index];
    // The depth comes first: it is cheap and culls what is behind the eye. The test is negated to cull a NaN too.
    float depth = dot(LAYER_VIEW.rotation_z.xyz, eye_relative(gaussian.position_opacity.xyz));
    if (!(depth >= VIEW.near_cut) || opacity_in_layer(gaussian) < ALPHA_MIN) {
        return SIDE_CULLED;
    }
    Footprint f = footprint(gaussian);
    float opacity = opacity_on_screen(f, gaussian);
    // Deviations beyond the range of single precision have no footprint. Each number is tested by itself, since max()
    // may drop a NaN.
    bool drawable = all(lessThan(abs(conic_of(f)), vec3(3e38))) && all(lessThan(abs(f.screen_centre), vec2(3e38)));
    bool shows = opacity >= ALPHA_MIN && covers_a_pixel(f.screen_centre, box_half_sides(f, opacity_extent(opacity)));
    if (!drawable || !shows) {
        return SIDE_CULLED;
    }
    if (!CLIP) {
        return SIDE_VISIBLE;
    }
    float sigma = largest(gaussian.scale.xyz);
    if (FRAME.region.mode == MODE_EXACT && is_beam(f, sigma)) {
        float extent = opacity_extent(opacity_in_layer(gaussian));
        float deviations = beam_band(f, extent);
        enter_shortlist(block, deviations / extent);
        return gaussian_side(f.axes, gaussian.position_opacity.xyz, deviations);
    }
    return clip_stage_side(block, local);
}

void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < WORDS) {
        splat_mask[local] = 0u;
        cutoff_mask[local] = 0u;
    }
    if (local == 0u) {
        visible_count = 0u;
        cutoff_count = 0u;
        invisible_count = 0u;
    }
    barrier();
    uint group = LINEAR_GROUP;
    bool is_block = group < counts.at[0].classify_groups.w;
    uint block = is_block ? block_list.at[group] : 0u;
    enter_layer_of_block(block);
    if (is_block && local < block_length(block)) {
        uint side = classify(block, local);
        uint bit = 1u << (local & 31u);
        // Neither sums nor unions depend on the order of the atomics.
        if (side >= SIDE_VISIBLE) {
            atomicOr(splat_mask[local >> 5], bit);
        }
        if (side == SIDE_VISIBLE) {
            atomicAdd(visible_count, 1u);
        } else if (side == SIDE_CUTOFF) {
            atomicOr(cutoff_mask[local >> 5], bit);
            atomicAdd(cutoff_count, 1u);
        } else if (side == SIDE_INVISIBLE) {
            atomicAdd(invisible_count, 1u);
        }
    }
    barrier();
    if (is_block) {
        if (local < WORDS) {
            masks.at[block * 2u * WORDS + local] = splat_mask[local];
            masks.at[block * 2u * WORDS + WORDS + local] = cutoff_mask[local];
        }
        if (local == 0u) {
            block_counts.at[block] = uvec4(visible_count, cutoff_count, invisible_count, 0u);
        }
    }
}
