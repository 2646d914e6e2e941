#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a Gaussian: view culling by footprint, opacity and size, then the paper's three classes (section 3.2).
// Writes one bit a Gaussian (survives; is cut) and each workgroup's totals; compact turns them into ordered lists.
#include "side.glsl"

layout(local_size_x = GROUP_SIZE) in;
layout(constant_id = 0) const bool CLIP = false;

BUFFER(readonly, 1, Gaussian, gaussians)
BUFFER(writeonly, 2, uint, masks)
BUFFER(writeonly, 3, uvec4, group_counts)

const uint WORDS = GROUP_SIZE / 32u;
shared uint survivor_mask[WORDS];
shared uint cutoff_mask[WORDS];
shared uint visible_count;
shared uint cutoff_count;
shared uint invisible_count;

// Whether some pixel centre lies in the splat's bounding box and in the picture.
bool covers_a_pixel(vec2 centre, vec2 extent) {
    vec2 low = max(ceil(centre - extent - 0.5), vec2(0.0));
    vec2 high = min(floor(centre + extent - 0.5), FRAME.size.xy - 1.0);
    return low.x <= high.x && low.y <= high.y;
}

uint classify(uint index) {
    Gaussian gaussian = gaussians.at[index];
    float opacity = gaussian.position_opacity.w;
    // Depth first: it is cheap and drops what is behind the eye. Negated, so that a NaN is culled too.
    float depth = dot(FRAME.rotation_z.xyz, eye_relative(gaussian.position_opacity.xyz));
    if (!(depth >= NEAR_Z) || opacity < ALPHA_MIN) {
        return SIDE_CULLED;
    }
    Footprint f = footprint(gaussian);
    float extent = opacity_extent(opacity);
    // Finite, each for itself, since max() may drop a NaN: deviations beyond the range of single precision have no
    // footprint.
    bool drawable = all(lessThan(abs(cholesky(f)), vec3(3e38))) && all(lessThan(abs(f.centre), vec2(3e38)));
    if (!drawable || !covers_a_pixel(f.centre, box_extent(f, extent))) {
        return SIDE_CULLED;
    }
    return CLIP ? clip_side(f, gaussian.position_opacity.xyz, extent) : SIDE_VISIBLE;
}

void main() {
    uint local = gl_LocalInvocationIndex;
    if (local < WORDS) {
        survivor_mask[local] = 0u;
        cutoff_mask[local] = 0u;
    }
    if (local == 0u) {
        visible_count = 0u;
        cutoff_count = 0u;
        invisible_count = 0u;
    }
    barrier();
    uint group = LINEAR_GROUP;
    uint index = group * GROUP_SIZE + local;
    if (index < FRAME.gaussian_count) {
        uint side = classify(index);
        uint bit = 1u << (local & 31u);
        // Sums and unions do not depend on the order of atomics.
        if (side >= SIDE_VISIBLE) {
            atomicOr(survivor_mask[local >> 5], bit);
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
    if (group < FRAME.group_count) {
        if (local < WORDS) {
            masks.at[group * 2u * WORDS + local] = survivor_mask[local];
            masks.at[group * 2u * WORDS + WORDS + local] = cutoff_mask[local];
        }
        if (local == 0u) {
            group_counts.at[group] = uvec4(visible_count, cutoff_count, invisible_count, 0u);
        }
    }
}
