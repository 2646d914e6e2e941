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

float mean_depth(SplatDepth s, vec2 delta) {
    float whole = s.mean.x + dot(s.mean.yz, delta);
    float low = -clamp(s.far.x + dot(s.far.yz, delta), -8.0, 8.0);
    float high = clamp(s.near.x + dot(s.near.yz, delta), -8.0, 8.0);
    float moment = s.far.w * normal_density(low) + s.near.w * normal_density(high);
    if (s.mean.w != 0.0) {
        // A union leaves out what is between the two.
        float share = low < high ? tail_phi(low) + tail_phi(-high) : 1.0;
        return whole - (low < high ? moment / max(share, LEAST_SHARE) : 0.0);
    }
    // The difference is taken between the tails on the side where both are small.
    float share = low + high > 0.0 ? tail_phi(-low) - tail_phi(-high) : tail_phi(high) - tail_phi(low);
    return low < high ? whole + moment / max(share, LEAST_SHARE) : whole;
}

#endif
