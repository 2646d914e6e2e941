// Where a surface that bends stands on a pixel's line of sight. Twin: src/reference/region/crossing.rs, which also says where
// the formulas come from.
#ifndef RARA_REGION_CROSSING
#define RARA_REGION_CROSSING
#include "region/unit_surface.glsl"
#include "sight.glsl"

// Beyond this Phi is taken for 0 or 1, which is off by less than 4e-6, a fifth of the best approximation's error.
const float PHI_ONE = 4.5;
// How much the mean may move by a surface's bend across the direction in which it varies most, in deviations, before the bend
// is integrated over.
const float BENT = 0.05;

// A line of sight and the mean of the Gaussian given the pixel.
struct Line {
    Sight s;
    float det;
    vec3 mean;
};

Line line_through(Sight s) {
    Line line;
    line.s = s;
    line.det = determinant(s);
    vec2 d = s.delta / line.det;
    line.mean = d.x * (cross(s.b2, s.c) + s.low_pass * s.b1) + d.y * (cross(s.c, s.b1) + s.low_pass * s.b2);
    return line;
}

vec3 direction_of(Line line) {
    return line.s.c / max(length(line.s.c), 1e-30);
}

// The covariance given the pixel, times a vector.
vec3 spread(Line line, vec3 v) {
    Sight s = line.s;
    vec3 across = v * (dot(s.b1, s.b1) + dot(s.b2, s.b2) + s.low_pass) - s.b1 * dot(s.b1, v) - s.b2 * dot(s.b2, v);
    return (s.c * dot(s.c, v) + s.low_pass * across) / line.det;
}

float variance_of(Line line, vec3 a) {
    Sight s = line.s;
    vec3 a1 = cross(a, s.b1);
    vec3 a2 = cross(a, s.b2);
    float along = dot(a, s.c);
    return (along * along + s.low_pass * (dot(a1, a1) + dot(a2, a2) + s.low_pass * dot(a, a))) / line.det;
}

// The trace of the bend times the covariance.
float trace_of(Line line, UnitSurface surface) {
    Sight s = line.s;
    float size = dot(s.b1, s.b1) + dot(s.b2, s.b2) + s.low_pass;
    float across = bend_trace(surface) * size - bend_along(surface, s.b1) - bend_along(surface, s.b2);
    return (bend_along(surface, s.c) + s.low_pass * across) / line.det;
}

// The deviation of a function with this gradient, and the direction in which it varies most.
float steepest(Line line, vec3 gradient, out vec3 along) {
    float n = sqrt(variance_of(line, gradient));
    along = n > 0.0 ? spread(line, gradient) / n : direction_of(line);
    return n;
}

// A surface's crossing follows from these, given the pixel: its function's mean but for the bend in the direction in which it varies
// most, its variance, and that bend times the variance. All are polynomials of the pixel where lines of sight are parallel.
struct Terms {
    float value;
    float variance;
    float bend;
};

// Where a function with this mean, deviation and bend is zero in the direction in which it varies most.
struct Crossings {
    float z; // of the first; FAR_AWAY and the mean's sign where there is none
    float smooth_z; // the same as a smooth function of the pixel, also where there is no crossing
    float other; // of the second
    bool between; // what is kept lies between the two
    bool exist;
};

const float NO_CROSSING = 1e30;
// Beyond this nothing is left of a splat, and no chord is as long.
const float FAR_AWAY = 40.0;

Crossings crossings(float value, float n, float bend) {
    float square = n * n - 4.0 * bend * value;
    float sum = n + sqrt(max(square, 0.0));
    Crossings c;
    c.exist = !(square < 0.0) && sum > 0.0;
    c.smooth_z = 2.0 * value / sum;
    c.z = c.exist ? c.smooth_z : value < 0.0 ? -FAR_AWAY : FAR_AWAY;
    c.other = c.exist ? -sum / (2.0 * bend) : NO_CROSSING;
    c.between = bend < 0.0;
    return c;
}

Crossings crossings(Terms terms) {
    float variance = max(terms.variance, 1e-30);
    float bend = terms.bend / variance;
    return crossings(terms.value - bend, sqrt(variance), bend);
}

// A surface's crossings, no farther than FAR_AWAY: beyond, there is no second one. The gradients at them point to what is kept.
struct Crossed {
    Crossings at;
    Terms terms;
    vec3 gradient;
    vec3 other_gradient;
};

// `moved` is by how much the bend across the direction moves the mean; 0 where that is little.
Crossed crossed(Line line, UnitSurface surface, out float moved) {
    Crossed crossing;
    vec3 gradient = gradient_at(surface, line.mean);
    vec3 along;
    float n = steepest(line, gradient, along);
    float bend = bend_along(surface, along);
    float shift = trace_of(line, surface) - bend;
    moved = abs(shift) <= BENT * n ? 0.0 : abs(shift);
    float value = value_at(surface, line.mean) + shift;
    crossing.terms = Terms(value + bend, n * n, bend * n * n);
    crossing.at = crossings(value, n, bend);
    crossing.at.z = clamp(crossing.at.z, -FAR_AWAY, FAR_AWAY);
    crossing.at.other = abs(crossing.at.other) < FAR_AWAY ? crossing.at.other : NO_CROSSING;
    vec3 across = 2.0 * bent(surface, along);
    crossing.gradient = crossing.at.exist ? gradient - crossing.at.z * across : gradient;
    crossing.other_gradient = crossing.at.other != NO_CROSSING ? gradient + crossing.at.other * across : gradient;
    return crossing;
}

// True for a surface that bends much across the direction in which it varies most, and is not so far that no point of the splat is on
// its other side: a function's square has its value at PHI_ONE there, less 1.
bool is_bent(Crossed crossing, float moved) {
    Terms terms = crossing.terms;
    float bend = abs(terms.bend) / max(terms.variance, 1e-30);
    float most = PHI_ONE * sqrt(terms.variance) + (PHI_ONE * PHI_ONE - 1.0) * (bend + moved);
    return moved > 0.0 && abs(terms.value) <= most;
}

// A vector's variance across a line, and the deviation that it has there.
float across(Line line, vec3 v, out vec3 deviation) {
    vec3 direction = direction_of(line);
    vec3 moved = spread(line, v) - direction * dot(direction, v);
    float variance = dot(v, moved);
    deviation = variance > 0.0 ? moved * inversesqrt(variance) : vec3(0.0);
    return variance > 0.0 ? variance : 1.0;
}

// A unit vector across a unit vector.
vec3 perpendicular(vec3 v) {
    return normalize(cross(v, abs(v.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
}

// The deviations along a line and in two directions across it, none of which depends on another.
mat3 deviations_of(Line line, out mat3 back) {
    mat3 deviations;
    deviations[0] = direction_of(line);
    vec3 p = dot(line.s.b1, line.s.b1) < dot(line.s.b2, line.s.b2) ? line.s.b2 : line.s.b1;
    p /= max(length(p), 1e-30);
    vec3 q = cross(deviations[0], p);
    float variance = across(line, p, deviations[1]);
    q -= p * (dot(q, deviations[1]) * inversesqrt(variance));
    across(line, q, deviations[2]);
    // Thin Gaussians leave the general inverse no digits.
    vec3 r = cross(deviations[1], deviations[2]);
    back = transpose(mat3(r / dot(r, deviations[0]), p / dot(p, deviations[1]), q / dot(q, deviations[2])));
    return deviations;
}

mat3 deviations_of(Line line) {
    mat3 back;
    return deviations_of(line, back);
}

#endif
