// A surface in a Gaussian's unit space: the point mu + M u is visible iff offset + normal . u + u . Q u >= 0, with Q the
// symmetric matrix of the bend. A plane's is zero. Twin: src/reference/region/quadric.rs.
#ifndef RARA_REGION_UNIT_SURFACE
#define RARA_REGION_UNIT_SURFACE

struct UnitSurface {
    vec4 half_space; // to first order about the Gaussian's centre: the normal and the centre's distance
    vec3 diagonal; // Q: xx, yy, zz
    vec3 across; // Q: xy, xz, yz
};

bool is_plane(UnitSurface s) {
    return s.diagonal == vec3(0.0) && s.across == vec3(0.0);
}

vec3 bent(UnitSurface s, vec3 v) {
    return s.diagonal * v + vec3(dot(s.across.xy, v.yz), dot(s.across.xz, v.xz), dot(s.across.yz, v.xy));
}

float bend_along(UnitSurface s, vec3 v) {
    return dot(v, bent(s, v));
}

float bend_trace(UnitSurface s) {
    return s.diagonal.x + s.diagonal.y + s.diagonal.z;
}

// The root of the sum of all squares, which no eigenvalue exceeds.
float bend_norm(UnitSurface s) {
    return sqrt(dot(s.diagonal, s.diagonal) + 2.0 * dot(s.across, s.across));
}

float value_at(UnitSurface s, vec3 u) {
    return s.half_space.w + dot(s.half_space.xyz, u) + bend_along(s, u);
}

vec3 gradient_at(UnitSurface s, vec3 u) {
    return s.half_space.xyz + 2.0 * bent(s, u);
}

#endif
