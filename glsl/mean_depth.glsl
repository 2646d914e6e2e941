// The mean depth of what the clip leaves of a splat in a pixel. Twin: src/reference/depth.rs,
// which also says where the formulas come from.
#ifndef RARA_MEAN_DEPTH
#define RARA_MEAN_DEPTH
#include "tail.glsl"
#include "types.glsl"

float normal_density(float z) {
    return 0.39894228 * exp(-0.5 * z * z);
}

// Shares below which a pixel shows nothing of a splat.
const float LEAST_SHARE = 1e-9;

// The share of a normal distribution between two bounds, by its tails on the side where both are small.
float between(float low, float high) {
    return low + high > 0.0 ? tail_phi(-low) - tail_phi(-high) : tail_phi(high) - tail_phi(low);
}

// The mean depth of the whole splat in a pixel, and the bounds that the clip sets it, deviations from that.
vec3 mean_and_bounds(SplatDepth s, vec2 delta) {
    float whole = s.mean.x + dot(s.mean.yz, delta);
    float low = -clamp(s.far.x + dot(s.far.yz, delta), -8.0, 8.0);
    float high = clamp(s.near.x + dot(s.near.yz, delta), -8.0, 8.0);
    return vec3(whole, low, high);
}

float mean_depth(SplatDepth s, vec2 delta) {
    vec3 found = mean_and_bounds(s, delta);
    float whole = found.x;
    float low = found.y;
    float high = found.z;
    float moment = s.far.w * normal_density(low) + s.near.w * normal_density(high);
    if (s.mean.w < 0.0) {
        // A union leaves out what is between the two.
        float share = low < high ? tail_phi(low) + tail_phi(-high) : 1.0;
        return whole - (low < high ? moment / max(share, LEAST_SHARE) : 0.0);
    }
    return low < high ? whole + moment / max(between(low, high), LEAST_SHARE) : whole;
}

// The share of what the clip leaves of a splat in a pixel that is before a depth, and the mean depth of that.
vec2 part_before(SplatDepth s, vec2 delta, float depth) {
    vec3 found = mean_and_bounds(s, delta);
    float whole = found.x;
    float low = found.y;
    float high = found.z;
    float deviation = abs(s.mean.w);
    float z = clamp((depth - whole) / deviation, -8.0, 8.0);
    if (s.mean.w < 0.0) {
        // The interval that a union leaves out may lie on both sides of the depth.
        bool leaves_out = low < high && high - low < 16.0;
        float kept = leaves_out ? tail_phi(low) + tail_phi(-high) : 1.0;
        float before = tail_phi(z) - (leaves_out ? between(min(low, z), min(high, z)) : 0.0);
        return vec2(clamp(before / max(kept, LEAST_SHARE), 0.0, 1.0), min(mean_depth(s, delta), depth));
    }
    if (z >= high) {
        return vec2(1.0, mean_depth(s, delta));
    }
    if (z <= low) {
        return vec2(0.0, depth);
    }
    float before = between(low, z);
    float moment = s.far.w * normal_density(low) - deviation * normal_density(z);
    return vec2(min(before / max(between(low, high), LEAST_SHARE), 1.0), min(whole + moment / max(before, LEAST_SHARE), depth));
}

#endif
