// On which side of the region all Gaussians are whose centres lie in a box. The answer is conservative: the box has a side
// only where each of them has it. Twin: src/reference/region/box_side.rs.
#ifndef RARA_REGION_BOX_SIDE
#define RARA_REGION_BOX_SIDE
#include "region/answers.glsl"
#include "region/surface.glsl"

// `reach` is the farthest that a contour of 1/255 lies from its centre, and `sigma` the largest standard deviation.
uint box_side(vec3 middle, vec3 half_size, float reach, float sigma) {
    if (FRAME.region.trace_all != 0u && FRAME.region.mode != MODE_HARD) {
        return SIDE_CUTOFF;
    }
    float traced = FRAME.region.sigma * sigma;
    float support = FRAME.region.mode == MODE_HARD ? 0.0 : FRAME.region.mode == MODE_RARA ? max(reach, traced) : reach;
    if (COMBINED && LAYER.region.op == OP_PARTS) {
        Answers answers = Answers(0u, 0u);
        for (uint i = 0u; i < LAYER.region.surface_count; i++) {
            uint surface = LAYER.region.first_surface + i;
            answer(answers, surface_box_side(surface, middle, half_size, support), surfaces.at[surface].joins);
        }
        return side_answered(answers);
    }
    uint side = side_undecided();
    for (uint i = 0u; i < LAYER.region.surface_count && side != side_that_decides(); i++) {
        side = combined_side(side, surface_box_side(LAYER.region.first_surface + i, middle, half_size, support));
    }
    return side;
}

#endif
