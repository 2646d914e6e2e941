#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel.
#include "splat_params.glsl"
#include "weight_constants.glsl"
#include "buffers.glsl"


// The debug view.
layout(constant_id = 6) const bool SHOW_WEIGHT = false;

BUFFER(readonly, 4, vec4, cut_records)
#include "weight.glsl"
#include "splat_alpha.glsl"

layout(location = 0) flat in vec4 centre_conic;
layout(location = 1) flat in vec4 conic_cut;
layout(location = 2) flat in vec4 colour_cut;
layout(location = 3) flat in vec3 curvature;
layout(location = 0) out vec4 colour;

void main() {
    float weight;
    float alpha = splat_alpha(centre_conic, conic_cut, colour_cut.w, curvature, weight);
    // Blending nothing is cheaper than discard on lavapipe, which would lose early tests.
    colour = vec4((SHOW_WEIGHT ? weight_colour(weight) : colour_cut.rgb) * alpha, alpha);
}
