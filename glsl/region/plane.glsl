// The first shape: a half-space, whose unit normal points to what it keeps. Twin: src/reference/region/plane.rs.
#ifndef RARA_REGION_PLANE
#define RARA_REGION_PLANE
#include "region/unit_surface.glsl"
#include "two_float.glsl"

// Signed distance of a point, the layer's units, positive on the visible side.
float plane_distance(uint surface, vec3 position) {
    return two_float_plane(surfaces.at[surface].high, surfaces.at[surface].low, position);
}

vec4 plane_half_space(uint surface, mat3 axes, vec3 position) {
    return vec4(surfaces.at[surface].high.xyz * axes, plane_distance(surface, position));
}

UnitSurface plane_unit_surface(uint surface, mat3 axes, vec3 position) {
    return UnitSurface(plane_half_space(surface, axes, position), vec3(0.0), vec3(0.0));
}

// The length of the normal in the Gaussian's unit space is the standard deviation along the normal.
uint plane_gaussian_side(uint surface, mat3 axes, vec3 position, float deviations) {
    vec4 half_space = plane_half_space(surface, axes, position);
    float distance = half_space.w;
    float support = deviations * length(half_space.xyz);
    return distance >= support ? SIDE_VISIBLE : distance <= -support ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

uint plane_box_side(uint surface, vec3 middle, vec3 half_size, float support) {
    float distance = plane_distance(surface, middle);
    float margin = dot(abs(surfaces.at[surface].high.xyz), half_size) + 1.0001 * support;
    return distance > margin ? SIDE_VISIBLE : distance < -margin ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif
