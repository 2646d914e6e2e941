#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel: alpha by the Cholesky factor of the conic, then, for cut splats only, the clip's weight.
#include "frame.glsl"

// MODE_* of the frame: without a clip none of its code is in the pipeline.
layout(constant_id = 0) const uint CLIP_MODE = 0u;
// PHI_*: which approximation of Phi.
layout(constant_id = 1) const uint PHI_FORM = 0u;

BUFFER(readonly, 4, vec4, cuts)
#include "weight.glsl"

layout(location = 0) flat in vec2 centre;
layout(location = 1) flat in vec4 conic;
layout(location = 2) flat in vec4 colour_cut;
layout(location = 0) out vec4 colour;

void main() {
    vec2 delta = gl_FragCoord.xy - centre;
    float u = conic.x * delta.x;
    float v = conic.y * delta.x + conic.z * delta.y;
    float alpha = min(ALPHA_MAX, conic.w * exp(-0.5 * (u * u + v * v)));
    // Thresholds are on the unclipped alpha, so that thin layers do not vanish when they are cut. Blending nothing is
    // cheaper than discard on lavapipe, which would lose early tests.
    if (!(alpha >= ALPHA_MIN)) {
        colour = vec4(0.0);
        return;
    }
    if (CLIP_MODE >= MODE_RARA) {
        uint cut = floatBitsToUint(colour_cut.w);
        if (cut != NOT_CUT) {
            alpha = decayed(alpha, cut_weight(CLIP_MODE, cut, delta));
        }
    }
    colour = vec4(colour_cut.rgb * alpha, alpha);
}
