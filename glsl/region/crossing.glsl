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
    float lateral; // what counts of the variance across the line: all, but where nodes stand for a part of it
    vec3 mean;
};

Line line_through(Sight s) {
    Line line;
    line.s = s;
    line.det = determinant(s);
    line.lateral = 1.0;
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
    vec3 all = (s.c * dot(s.c, v) + s.low_pass * across) / line.det;
    if (line.lateral == 1.0) {
        return all;
    }
    vec3 along = direction_of(line) * dot(direction_of(line), v);
    return along + line.lateral * (all - along);
}

float variance_of(Line line, vec3 a) {
    Sight s = line.s;
    vec3 a1 = cross(a, s.b1);
    vec3 a2 = cross(a, s.b2);
    float along = dot(a, s.c);
    float all = (along * along + s.low_pass * (dot(a1, a1) + dot(a2, a2) + s.low_pass * dot(a, a))) / line.det;
    if (line.lateral == 1.0) {
        return all;
    }
    along = dot(a, direction_of(line));
    return along * along + line.lateral * max(all - along * along, 0.0);
}

// The trace of the bend times the covariance.
float trace_of(Line line, UnitSurface surface) {
    Sight s = line.s;
    float size = dot(s.b1, s.b1) + dot(s.b2, s.b2) + s.low_pass;
    float across = bend_trace(surface) * size - bend_along(surface, s.b1) - bend_along(surface, s.b2);
    float all = (bend_along(surface, s.c) + s.low_pass * across) / line.det;
    if (line.lateral == 1.0) {
        return all;
    }
    float along = bend_along(surface, direction_of(line));
    return along + line.lateral * (all - along);
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

// `moved` is by how many deviations the bend across the direction moves the mean.
Crossed crossed(Line line, UnitSurface surface, out float moved) {
    Crossed crossing;
    vec3 gradient = gradient_at(surface, line.mean);
    vec3 along;
    float n = steepest(line, gradient, along);
    float bend = bend_along(surface, along);
    float shift = trace_of(line, surface) - bend;
    moved = abs(shift) <= BENT * n ? 0.0 : 1.0;
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

#endif
