// On which side of the region a Gaussian is: the paper's three classes (section 3.2), by its tight support along each
// plane's normal, |n.mu + d| against K |M^T n| with K where alpha falls to 1/255, instead of 3 max(sigma). Outside that
// band no pixel of the splat changes by more than 0.5/255; where weights follow true rays, perspective widens it
// (band.glsl). Twin: src/reference/region/gaussian_side.rs.
#ifndef RARA_REGION_GAUSSIAN_SIDE
#define RARA_REGION_GAUSSIAN_SIDE
#include "region/shortlist.glsl"

uint gaussian_side(mat3 axes, vec3 position, float deviations) {
    if (has_shortlist() && shortlist_side() != SIDE_CUTOFF) {
        return shortlist_side();
    }
    RegionAnswer region = unasked();
    for (uint i = 0u; i < surface_count() && is_open(region); i++) {
        add_answer(region, i, surface_gaussian_side(surface_at(i), axes, position, deviations));
    }
    return side_of(region);
}

#endif
