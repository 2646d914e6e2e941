// A whole splat. Included after the buffer `splats` is declared.
#ifndef RARA_SPLAT_AT
#define RARA_SPLAT_AT
#include "splats.glsl"

Splat splat_at(uint number) {
    Splat splat;
    splat.centre_conic = SPLAT_CENTRE(number);
    splat.conic_cut = SPLAT_CONIC(number);
    splat.colour_cut = SPLAT_COLOUR(number);
    splat.curvature_depth = vec4(CARRIED_CURVATURE(number, splat.conic_cut), SPLAT_DEPTH(number));
    return splat;
}

#endif
