// The shape of a clip: a half-space, whose unit normal points to what it keeps. Twin: src/reference/region/plane.rs.
#ifndef RARA_REGION_PLANE
#define RARA_REGION_PLANE
#include "region/sides.glsl"
#include "two_float.glsl"

// Signed distance of a point to a plane, world units, positive on the visible side.
float plane_distance(uint plane, vec3 position) {
    return two_float_plane(FRAME.region.plane_high[plane], FRAME.region.plane_low[plane], position);
}

// The normal in the Gaussian's unit space; its length is the standard deviation along the normal.
vec3 unit_normal(uint plane, mat3 world_factor) {
    return FRAME.region.plane_high[plane].xyz * world_factor;
}

// Of a Gaussian at a distance, with the normal in its unit space and a band of so many standard deviations: SIDE_VISIBLE
// where the plane keeps all of it, SIDE_INVISIBLE where it keeps nothing, else SIDE_CUTOFF.
uint plane_gaussian_side(float distance, vec3 normal, float deviations) {
    if (FRAME.region.mode == MODE_HARD) {
        return distance >= 0.0 ? SIDE_VISIBLE : SIDE_INVISIBLE;
    }
    float support = deviations * length(normal);
    if (FRAME.region.trace_all != 0u) {
        return SIDE_CUTOFF;
    }
    return distance >= support ? SIDE_VISIBLE : distance <= -support ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

// Of all Gaussians whose centres lie in a box and that reach at most so far from them, world units.
uint plane_box_side(uint plane, vec3 middle, vec3 half_size, float support) {
    float distance = plane_distance(plane, middle);
    float margin = dot(abs(FRAME.region.plane_high[plane].xyz), half_size) + 1.0001 * support;
    return distance > margin ? SIDE_VISIBLE : distance < -margin ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif
