#version 460
#extension GL_GOOGLE_include_directive : require
// One instance a splat, a strip of four corners.
#include "splat_params.glsl"
#include "corners.glsl"

layout(location = 0) flat out vec4 centre_conic;
layout(location = 1) flat out vec4 conic_cut;
layout(location = 2) flat out vec4 colour_cut;
layout(location = 3) flat out vec3 curvature;

void main() {
    uint splat_index = splat_index_at(gl_InstanceIndex);
    Splat splat = splat_at(splat_index);
    gl_Position = corner(splat, quads.at[splat_index], gl_VertexIndex);
    centre_conic = fragment_centre(splat);
    conic_cut = splat.conic_cut;
    colour_cut = splat.colour_cut;
    curvature = splat.curvature_depth.xyz;
}
