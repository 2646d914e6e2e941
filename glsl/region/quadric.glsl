// Quadrics: which side of one a Gaussian is on, whole boxes of Gaussians, and what it is in a Gaussian's unit space. Twin:
// src/reference/region/quadric.rs, which also says where the bounds come from.
#ifndef RARA_REGION_QUADRIC
#define RARA_REGION_QUADRIC
#include "region/unit_surface.glsl"
#include "two_float.glsl"

// How often the bound of a quadratic function over a ball is improved at most, and from which step on no more, as a share.
const uint BALL_STEPS = 16u;
const float BALL_STEP = 0.01;
// The least shift as a share of the bend, and the least determinant as a share of the trace's cube: closer to a singular matrix
// rounding would make a bound of nothing. What is left of its error is taken off.
const float BALL_SHIFT = 0.02;
const float BALL_DEFINITE = 1e-4;
const float BALL_ERROR = 1.01;

vec3 quadric_point(uint surface, vec3 position) {
    return two_float_difference(position, surfaces.at[surface].anchor.xyz, surfaces.at[surface].anchor_low.xyz);
}

// The quadric's matrix as that of a surface.
UnitSurface quadric_matrix(uint surface) {
    return UnitSurface(vec4(0.0), surfaces.at[surface].diagonal.xyz, surfaces.at[surface].across.xyz);
}

float quadric_distance(uint surface, vec3 position) {
    vec3 p = quadric_point(surface, position);
    vec2 sum = vec2(surfaces.at[surface].high.w, surfaces.at[surface].low.w);
    sum = two_float_dot(sum, surfaces.at[surface].high.xyz, surfaces.at[surface].low.xyz, p);
    sum = two_float_dot(sum, bent(quadric_matrix(surface), p), vec3(0.0), p);
    return sum.x + sum.y;
}

vec3 quadric_gradient(uint surface, vec3 position) {
    return surfaces.at[surface].high.xyz + 2.0 * bent(quadric_matrix(surface), quadric_point(surface, position));
}

// The quadric to first order about a Gaussian's centre.
vec4 quadric_half_space(uint surface, mat3 axes, vec3 position) {
    return vec4(quadric_gradient(surface, position) * axes, quadric_distance(surface, position));
}

UnitSurface quadric_with(uint surface, mat3 axes, vec4 half_space) {
    UnitSurface matrix = quadric_matrix(surface);
    vec3 x = bent(matrix, axes[0]);
    vec3 y = bent(matrix, axes[1]);
    vec3 z = bent(matrix, axes[2]);
    UnitSurface s;
    s.half_space = half_space;
    s.diagonal = vec3(dot(axes[0], x), dot(axes[1], y), dot(axes[2], z));
    s.across = vec3(dot(axes[0], y), dot(axes[0], z), dot(axes[1], z));
    return s;
}

UnitSurface quadric_unit_surface(uint surface, mat3 axes, vec3 position) {
    return quadric_with(surface, axes, quadric_half_space(surface, axes, position));
}

// The inverse of sign Q with `shift` added to its diagonal. False where that matrix is not positive definite.
bool inverse_shifted(UnitSurface s, float sign, float shift, out UnitSurface inverse) {
    vec3 d = sign * s.diagonal + shift;
    vec3 a = sign * s.across;
    vec3 minors = d.yxx * d.zzy - a.zyx * a.zyx;
    vec3 across = vec3(a.y * a.z - a.x * d.z, a.x * a.z - a.y * d.y, a.x * a.y - a.z * d.x);
    float determinant = d.x * minors.x + a.x * across.x + a.y * across.y;
    inverse = UnitSurface(vec4(0.0), minors / determinant, across / determinant);
    float trace = d.x + d.y + d.z;
    return d.x > 0.0 && minors.z > 0.0 && determinant > BALL_DEFINITE * trace * trace * trace;
}

// The side of the ball that reaches `deviations` standard deviations.
uint quadric_gaussian_side(uint surface, mat3 axes, vec3 position, float deviations) {
    vec4 half_space = quadric_half_space(surface, axes, position);
    float sign = half_space.w < 0.0 ? -1.0 : 1.0;
    float offset = abs(half_space.w);
    float slope = length(half_space.xyz);
    uint side = sign > 0.0 ? SIDE_VISIBLE : SIDE_INVISIBLE;
    // A first bound needs no bend of its own: most Gaussians are far from the surface.
    float largest = max(max(dot(axes[0], axes[0]), dot(axes[1], axes[1])), dot(axes[2], axes[2]));
    if (offset >= deviations * (slope + 1.0001 * deviations * largest * bend_norm(quadric_matrix(surface)))) {
        return side;
    }
    UnitSurface s = quadric_with(surface, axes, half_space);
    float norm = bend_norm(s);
    float support = deviations * (slope + deviations * norm);
    if (offset >= support) {
        return side;
    }
    // The point of the ball that the slope leads to is on the other side for most Gaussians that are cut.
    vec3 downhill = (deviations / slope) * s.half_space.xyz;
    if (offset - deviations * slope + sign * bend_along(s, downhill) <= 0.0) {
        return SIDE_CUTOFF;
    }
    float margin = 1e-5 * support;
    // Here the matrix is positive definite, and the nearest point is inside the ball.
    float shift = slope / (deviations + deviations) + norm;
    UnitSurface inverse;
    bool is_definite = inverse_shifted(s, sign, shift, inverse);
    for (uint i = 0u; i < BALL_STEPS && is_definite; i++) {
        vec3 nearest = -0.5 * sign * bent(inverse, s.half_space.xyz);
        float reach = length(nearest);
        float taken = -0.5 * BALL_ERROR * sign * dot(s.half_space.xyz, nearest);
        if (offset - shift * deviations * deviations - taken > margin) {
            return side;
        }
        float next = shift + reach * reach * (reach - deviations) / (deviations * max(bend_along(inverse, nearest), 1e-30));
        next = max(next, BALL_SHIFT * norm);
        if (abs(next - shift) <= BALL_STEP * shift) {
            break;
        }
        // Where the step went too far, half of it may not have.
        is_definite = inverse_shifted(s, sign, next, inverse);
        shift = is_definite ? next : 0.5 * (shift + next);
        is_definite = is_definite || inverse_shifted(s, sign, shift, inverse);
    }
    return SIDE_CUTOFF;
}

uint quadric_box_side(uint surface, vec3 middle, vec3 half_size, float support) {
    vec3 reach = half_size + 1.0001 * support;
    UnitSurface matrix = quadric_matrix(surface);
    vec3 p = quadric_point(surface, middle);
    float value = quadric_distance(surface, middle);
    float slope = dot(abs(quadric_gradient(surface, middle)), reach);
    vec3 squares = reach * reach;
    float across = 2.0 * dot(abs(matrix.across), reach.xxy * reach.yzz);
    // What rounding may have done to the terms.
    UnitSurface sizes = UnitSurface(vec4(0.0), abs(matrix.diagonal), abs(matrix.across));
    float slack = 1e-6 * (abs(value) + dot(abs(surfaces.at[surface].high.xyz), abs(p)) + bend_along(sizes, abs(p)) + slope);
    float least = value - slope + dot(min(matrix.diagonal, 0.0), squares) - across - slack;
    float greatest = value + slope + dot(max(matrix.diagonal, 0.0), squares) + across + slack;
    return least > 0.0 ? SIDE_VISIBLE : greatest < 0.0 ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif
