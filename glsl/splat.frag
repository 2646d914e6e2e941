#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel: alpha by the Cholesky factor of the conic, then, for cut splats only, the clip's weight.
#include "types.glsl"
#include "buffers.glsl"

// What the weight depends on is fixed in the pipeline: without a clip none of its code is there.
layout(constant_id = 0) const uint CLIP_MODE = MODE_NONE;
layout(constant_id = 1) const uint CLIP_OP = OP_AND;
layout(constant_id = 2) const uint DECAY = DECAY_DEPTH;
layout(constant_id = 3) const uint MISS = MISS_PEAK;
// PHI_*: which approximation of Phi.
layout(constant_id = 4) const uint PHI_FORM = 0u;

BUFFER(readonly, 4, vec4, cuts)
#include "weight.glsl"

layout(location = 0) flat in vec4 centre_conic;
layout(location = 1) flat in vec4 conic_cut;
layout(location = 2) flat in vec4 colour_cut;
layout(location = 3) flat in vec3 curvature;
layout(location = 0) out vec4 colour;

void main() {
    vec2 delta = gl_FragCoord.xy - centre_conic.xy;
    float u = centre_conic.z * delta.x;
    float v = centre_conic.w * delta.x + conic_cut.x * delta.y;
    float alpha = min(ALPHA_MAX, conic_cut.y * exp(-0.5 * (u * u + v * v)));
    // Thresholds are on the unclipped alpha, so that thin layers do not vanish when they are cut. Blending nothing is
    // cheaper than discard on lavapipe, which would lose early tests.
    if (!(alpha >= ALPHA_MIN)) {
        colour = vec4(0.0);
        return;
    }
    if (CLIP_MODE >= MODE_RARA && conic_cut.z < CUT_RANGE) {
        vec3 plane = vec3(conic_cut.zw, colour_cut.w);
        if (CLIP_MODE == MODE_EXACT && plane.x > -CUT_RANGE) {
            float z = plane.x + delta.x * (plane.y + curvature.x * delta.x + curvature.y * delta.y)
                + delta.y * (plane.z + curvature.z * delta.y);
            alpha = decayed(alpha, phi(z));
        } else {
            alpha = decayed(alpha, cut_weight(uint(plane.y) | uint(plane.z) << 16, delta, vec2(u, v), gl_FragCoord.xy));
        }
    }
    colour = vec4(colour_cut.rgb * alpha, alpha);
}
