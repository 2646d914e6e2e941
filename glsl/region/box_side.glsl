// On which side of the region all Gaussians are whose centres lie in a box. The answer is conservative: the box has a side
// only where each of them has it. Twin: src/reference/region/box_side.rs.
#ifndef RARA_REGION_BOX_SIDE
#define RARA_REGION_BOX_SIDE
#include "region/answers.glsl"
#include "region/shortlist.glsl"

// How far a Gaussian reaches from its centre at most: `reach` is the farthest that a contour of 1/255 lies from it, and `sigma`
// the largest standard deviation.
float box_support(float reach, float sigma) {
    float traced = FRAME.region.sigma * sigma;
    return FRAME.region.mode == MODE_HARD ? 0.0 : FRAME.region.mode == MODE_RARA ? max(reach, traced) : reach;
}

// True where every Gaussian counts as cut.
bool cuts_all() {
    return FRAME.region.trace_all != 0u && FRAME.region.mode != MODE_HARD;
}

// `support` is how far a Gaussian reaches from its centre at most.
uint box_side(vec3 middle, vec3 half_size, float support) {
    if (cuts_all()) {
        return SIDE_CUTOFF;
    }
    if (has_shortlist() && shortlist_side() != SIDE_CUTOFF) {
        return shortlist_side();
    }
    if (COMBINED && LAYER.region.op == OP_PARTS) {
        Answers answers = Answers(0u, 0u);
        for (uint i = 0u; i < surface_count(); i++) {
            answer(answers, surface_box_side(surface_at(i), middle, half_size, support), operators_at(i));
        }
        return side_answered(answers);
    }
    uint side = side_undecided();
    for (uint i = 0u; i < surface_count() && side != side_that_decides(); i++) {
        side = combined_side(side, surface_box_side(surface_at(i), middle, half_size, support));
    }
    return side;
}

#endif
