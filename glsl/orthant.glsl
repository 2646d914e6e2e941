// The share of a splat that is on the visible side of two or three planes at once. Given a pixel, the planes' distances
// are correlated normal variables, and the share is the chance that all of them are positive. Included by weight.glsl,
// after phi. Twin: src/reference/orthant.rs, which also says where the formulas come from.
#ifndef RARA_ORTHANT
#define RARA_ORTHANT
#include "sight.glsl"

// Beyond this Phi is taken for 0 or 1: off by less than 4e-6, a fifth of what the best approximation is.
const float PHI_ONE = 4.5;
// Correlations up to which the integral starts at independence; beyond, at dependence. Either way four nodes leave 2e-5.
const float RHO_NEAR = 0.8;
// Gauss's nodes and weights on [0, 1].
const uint NODES = 4u;
const vec4 NODE = vec4(0.06943184, 0.33000948, 0.66999052, 0.93056816);
const vec4 NODE_WEIGHT = vec4(0.17392742, 0.32607258, 0.32607258, 0.17392742);
const float INVERSE_TAU = 0.15915494;
const float ROOT_TAU = 2.5066283;

// A plane function's direction among what a line of sight leaves open of the Gaussian: a unit vector of ten components.
struct Direction {
    float along;
    vec3 across_1, across_2, rest;
};

Direction direction(Sight s, vec3 a) {
    float spread = sqrt(s.low_pass);
    Direction d;
    d.along = dot(a, s.c);
    d.across_1 = spread * cross(a, s.b1);
    d.across_2 = spread * cross(a, s.b2);
    d.rest = s.low_pass * a;
    float squared = d.along * d.along + dot(d.across_1, d.across_1) + dot(d.across_2, d.across_2) + dot(d.rest, d.rest);
    float inverse = inversesqrt(max(squared, 1e-37));
    d.along *= inverse;
    d.across_1 *= inverse;
    d.across_2 *= inverse;
    d.rest *= inverse;
    return d;
}

// Correlation rho of two planes and 1 - rho^2, which a difference from one would lose.
vec2 correlation(Direction d, Direction e) {
    float rho = d.along * e.along + dot(d.across_1, e.across_1) + dot(d.across_2, e.across_2) + dot(d.rest, e.rest);
    float sign = rho < 0.0 ? -1.0 : 1.0;
    float along = d.along - sign * e.along;
    vec3 across_1 = d.across_1 - sign * e.across_1;
    vec3 across_2 = d.across_2 - sign * e.across_2;
    vec3 rest = d.rest - sign * e.rest;
    float apart = 0.5 * (along * along + dot(across_1, across_1) + dot(across_2, across_2) + dot(rest, rest));
    return vec2(sign * (1.0 - apart), apart * (2.0 - apart));
}

// The chance that two variables are positive, from Phi of them, p and q, and their correlation. |h| and |k| are at most
// PHI_ONE.
float both_positive(float h, float k, float p, float q, vec2 rho) {
    float low = max(0.0, p - (1.0 - q));
    float high = min(p, q);
    float sum = 0.0;
    if (abs(rho.x) <= RHO_NEAR) {
        for (uint i = 0u; i < NODES; i++) {
            float r = rho.x * NODE[i];
            float rest = 1.0 - r * r;
            sum += NODE_WEIGHT[i] * exp((r * h * k - 0.5 * (h * h + k * k)) / rest) * inversesqrt(rest);
        }
        return clamp(p * q + rho.x * INVERSE_TAU * sum, low, high);
    }
    float sign = rho.x < 0.0 ? -1.0 : 1.0;
    float limit = sign < 0.0 ? low : high;
    float apart = abs(h - sign * k);
    float root = sqrt(rho.y);
    if (apart >= 5.5 * root) {
        return limit;
    }
    float product = sign * h * k;
    float first = exp(-0.5 * product);
    for (uint i = 0u; i < NODES; i++) {
        float c = root * NODE[i];
        float r = sqrt(1.0 - c * c);
        float edge = apart / c;
        sum += NODE_WEIGHT[i] * exp(-0.5 * edge * edge) * (exp(-product / (1.0 + r)) / r - first);
    }
    float edge = apart / root;
    float smooth_part = first * (exp(-0.5 * edge * edge) - edge * ROOT_TAU * phi(-edge));
    return clamp(limit - sign * INVERSE_TAU * root * (smooth_part + sum), low, high);
}

// A plane on a line of sight.
struct Threshold {
    float z;
    bool far; // whether the far side is kept
    Direction direction;
};

float both_positive(Threshold t, Threshold u) {
    return both_positive(t.z, u.z, phi(t.z), phi(u.z), correlation(t.direction, u.direction));
}

// The chance that three variables are positive, if what the first leaves of the others is taken for normal.
float three_positive(Threshold first, Threshold t, Threshold u) {
    float p = max(phi(first.z), 1e-6);
    float mean = exp(-0.5 * first.z * first.z) / (ROOT_TAU * p);
    float shrink = mean * (mean + first.z);
    float to_t = correlation(first.direction, t.direction).x;
    float to_u = correlation(first.direction, u.direction).x;
    vec2 inverse = inversesqrt(max(1.0 - vec2(to_t * to_t, to_u * to_u) * shrink, 1e-4));
    vec2 z = clamp((vec2(t.z, u.z) + vec2(to_t, to_u) * mean) * inverse, -8.0, 8.0);
    float between = correlation(t.direction, u.direction).x - to_t * to_u * shrink;
    float rho = clamp(between * inverse.x * inverse.y, -1.0, 1.0);
    return p * both_positive(z.x, z.y, phi(z.x), phi(z.y), vec2(rho, 1.0 - rho * rho));
}

#endif
