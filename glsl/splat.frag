#version 460
#extension GL_GOOGLE_include_directive : require
// One splat in one pixel.
#include "types.glsl"
#include "buffers.glsl"

// What the weight depends on is fixed in the pipeline: without a clip none of its code is there.
layout(constant_id = 0) const uint CLIP_MODE = MODE_NONE;
layout(constant_id = 1) const uint CLIP_OP = OP_AND;
layout(constant_id = 2) const uint DECAY = DECAY_DEPTH;
layout(constant_id = 3) const uint MISS = MISS_PEAK;
// PHI_*: which approximation of Phi.
layout(constant_id = 4) const uint PHI_FORM = 0u;

// The debug view.
layout(constant_id = 6) const bool SHOW_WEIGHT = false;

BUFFER(readonly, 4, vec4, cuts)
#include "weight.glsl"
#include "splat_alpha.glsl"

layout(location = 0) flat in vec4 centre_conic;
layout(location = 1) flat in vec4 conic_cut;
layout(location = 2) flat in vec4 colour_cut;
layout(location = 3) flat in vec3 curvature;
layout(location = 0) out vec4 colour;

void main() {
    float kept;
    float alpha = splat_alpha(centre_conic, conic_cut, colour_cut.w, curvature, kept);
    // Blending nothing is cheaper than discard on lavapipe, which would lose early tests.
    colour = vec4((SHOW_WEIGHT ? weight_colour(kept) : colour_cut.rgb) * alpha, alpha);
}
