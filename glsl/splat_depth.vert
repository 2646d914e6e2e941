#version 460
#extension GL_GOOGLE_include_directive : require
// One instance a splat, a strip of four corners, for the expected depth.
#define EXPECTED_DEPTH
#include "splat_params.glsl"
#include "corners.glsl"

layout(location = 0) flat out vec4 centre_conic;
layout(location = 1) flat out vec4 conic_cut;
layout(location = 2) flat out vec4 slope_curvature;
layout(location = 3) flat out vec4 mean;
layout(location = 4) flat out vec4 far;
layout(location = 5) flat out vec4 near;

void main() {
    uint splat_index = splat_index_at(gl_InstanceIndex);
    Splat splat = splat_at(splat_index);
    gl_Position = corner(splat, quads.at[splat_index], gl_VertexIndex);
    centre_conic = fragment_centre(splat);
    conic_cut = splat.conic_cut;
    slope_curvature = vec4(splat.colour_cut.w, splat.curvature_depth.xyz);
    mean = SPLAT_MEAN_DEPTH(splat_index);
    far = SPLAT_FAR_BOUND(splat_index);
    near = SPLAT_NEAR_BOUND(splat_index);
}
