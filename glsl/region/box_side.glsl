// On which side of the region all Gaussians are whose centres lie in a box. The answer is conservative: the box has a side
// only where each of them has it. Twin: src/reference/region/box_side.rs.
#ifndef RARA_REGION_BOX_SIDE
#define RARA_REGION_BOX_SIDE
#include "region/shortlist.glsl"

// How far a Gaussian reaches from its centre at most: `reach` is the farthest that a contour of 1/255 lies from it, and `sigma`
// the largest standard deviation.
float box_support(float reach, float sigma) {
    float traced = CUT.region.sigma * sigma;
    return CUT.region.mode == MODE_HARD ? 0.0 : CUT.region.mode == MODE_RARA ? max(reach, traced) : reach;
}

// True where every Gaussian counts as cut.
bool cuts_all() {
    return CUT.region.trace_all != 0u && CUT.region.mode != MODE_HARD;
}

// `support` is how far a Gaussian reaches from its centre at most.
uint box_side(vec3 middle, vec3 half_size, float support) {
    if (cuts_all()) {
        return SIDE_CUTOFF;
    }
    if (has_shortlist() && shortlist_side() != SIDE_CUTOFF) {
        return shortlist_side();
    }
    RegionAnswer region = unasked();
    for (uint i = 0u; i < surface_count() && is_open(region); i++) {
        add_answer(region, i, surface_box_side(surface_at(i), middle, half_size, support));
    }
    return side_of(region);
}

#endif
