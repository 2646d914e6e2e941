#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel, for the expected depth: alpha times depth, and alpha.
#define EXPECTED_DEPTH
#include "splat_params.glsl"
#include "weight_constants.glsl"
#include "buffers.glsl"


BUFFER(readonly, 4, vec4, cut_records)
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
    float weight;
    float alpha = splat_alpha(centre_conic, conic_cut, slope_curvature.x, slope_curvature.yzw, weight);
    float here = mean_depth(SplatDepth(mean, far, near), gl_FragCoord.xy - centre_conic.xy);
    depth = vec4(alpha * here * push.params.unit, alpha, 0.0, alpha);
}
