#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel, for the expected depth: alpha times depth, and alpha. Parameter 8 is the unit of depths.
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
#include "splat_alpha.glsl"

#include "mean_depth.glsl"

layout(location = 0) flat in vec4 centre_conic;
layout(location = 1) flat in vec4 conic_cut;
layout(location = 2) flat in vec4 slope_curvature;
layout(location = 3) flat in vec4 mean;
layout(location = 4) flat in vec4 far;
layout(location = 5) flat in vec4 near;
layout(location = 0) out vec4 depth;

void main() {
    float kept;
    float alpha = splat_alpha(centre_conic, conic_cut, slope_curvature.x, slope_curvature.yzw, kept);
    float here = mean_depth(SplatDepth(mean, far, near), gl_FragCoord.xy - centre_conic.xy);
    depth = vec4(alpha * here * uintBitsToFloat(push.param[8]), alpha, 0.0, alpha);
}
