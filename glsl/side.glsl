// The paper's three classes (section 3.2) for one Gaussian and every plane, by its tight support along the normal:
// |n.mu + d| against K |M^T n| with K where alpha falls to 1/255, instead of 3 max(sigma). Outside that band no pixel
// of the splat changes by more than 0.5/255.
#ifndef RARA_SIDE
#define RARA_SIDE
#include "footprint.glsl"

const uint SIDE_CULLED = 0u;
const uint SIDE_INVISIBLE = 1u;
const uint SIDE_VISIBLE = 2u;
const uint SIDE_CUTOFF = 3u;

// Signed distance of the centre to a plane, world units, positive on the visible side.
float plane_distance(uint plane, vec3 position) {
    return two_float_plane(FRAME.plane_high[plane], FRAME.plane_low[plane], position);
}

// The normal in the Gaussian's unit space; its length is the standard deviation along the normal.
vec3 unit_normal(uint plane, mat3 world_factor) {
    return FRAME.plane_high[plane].xyz * world_factor;
}

// How far the band reaches, in standard deviations. rara also traces its own ellipsoid.
float band(float extent) {
    return FRAME.mode == MODE_RARA ? max(extent, FRAME.sigma) : extent;
}

// One plane: SIDE_VISIBLE where it keeps the whole splat, SIDE_INVISIBLE where it keeps nothing, else SIDE_CUTOFF.
uint plane_side(float distance, vec3 normal, float reach) {
    if (FRAME.mode == MODE_HARD) {
        return distance >= 0.0 ? SIDE_VISIBLE : SIDE_INVISIBLE;
    }
    float support = reach * length(normal);
    if (FRAME.trace_all != 0u) {
        return SIDE_CUTOFF;
    }
    return distance >= support ? SIDE_VISIBLE : distance <= -support ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

// All planes together.
uint clip_side(mat3 world_factor, vec3 position, float extent) {
    uint decided = FRAME.op == OP_AND ? SIDE_INVISIBLE : SIDE_VISIBLE;
    uint side = FRAME.op == OP_AND ? SIDE_VISIBLE : SIDE_INVISIBLE;
    float reach = band(extent);
    for (uint plane = 0u; plane < FRAME.plane_count; plane++) {
        uint one = plane_side(plane_distance(plane, position), unit_normal(plane, world_factor), reach);
        if (one == decided) {
            return decided;
        }
        side = one == SIDE_CUTOFF ? SIDE_CUTOFF : side;
    }
    return side;
}

#endif
