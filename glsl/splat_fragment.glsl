// One splat in one pixel. Included by the fragment shaders of the two front ends, which say how what is one for a splat comes
// from theirs.
#ifndef RARA_SPLAT_FRAGMENT
#define RARA_SPLAT_FRAGMENT
#include "splat_params.glsl"
#include "weight_constants.glsl"
#include "buffers.glsl"

// The debug view.
layout(constant_id = 6) const uint SHOW = SHOW_COLOUR; // SHOW_*

BUFFER(readonly, 4, vec4, cut_records)
#include "weight.glsl"
#include "splat_alpha.glsl"

layout(location = 0) ONE_A_SPLAT in vec4 centre_conic;
layout(location = 1) ONE_A_SPLAT in vec4 conic_cut;
layout(location = 2) ONE_A_SPLAT in vec4 colour_cut;
layout(location = 3) ONE_A_SPLAT in vec3 curvature;
layout(location = 0) out vec4 colour;

void main() {
    float weight;
    float alpha = splat_alpha(centre_conic, conic_cut, colour_cut.w, curvature, weight);
    // Blending nothing is cheaper than discard on lavapipe, which would lose early tests.
    colour = vec4((SHOW == SHOW_WEIGHT ? weight_colour(weight) : colour_cut.rgb) * alpha, alpha);
}

#endif
