// The share of a splat that is on the visible side of two or three planes at once. Given a pixel, the planes' distances
// are correlated normal variables, and the share is the chance that all of them are positive. Twin:
// src/reference/orthant.rs, which also says where the formulas come from and takes more nodes.
#ifndef RARA_ORTHANT
#define RARA_ORTHANT
#include "phi.glsl"
#include "region/crossing.glsl"
#include "sight.glsl"

// Up to this correlation the integral starts at independence; beyond it, at dependence. Either way four nodes leave 2e-5.
const float RHO_NEAR = 0.8;
// Gauss's nodes and weights on [0, 1].
const uint NODES = 4u;
const vec4 NODE = vec4(0.06943184, 0.33000948, 0.66999052, 0.93056816);
const vec4 NODE_WEIGHT = vec4(0.17392742, 0.32607258, 0.32607258, 0.17392742);
const float INVERSE_TAU = 0.15915494;
const float ROOT_TAU = 2.5066283;

// A half-space's direction among what a line of sight leaves open of the Gaussian: a unit vector of ten components.
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

// The correlation rho of two planes, and 1 - rho^2, whose digits a difference from one would lose.
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

// The chance that two variables are positive, from their means h and k, p = Phi(h), q = Phi(k) and their correlation. |h|
// and |k| are at most PHI_ONE.
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

// A half-space on a line of sight.
struct Threshold {
    float z;
    Direction direction;
};

float both_positive(Threshold t, Threshold u) {
    return both_positive(t.z, u.z, phi(t.z), phi(u.z), correlation(t.direction, u.direction));
}

// Six of Gauss's nodes on [0, 1], moved to 2 t - t^2 along the path from independence to the correlations. The slope
// 2 - 2 t, which the weights hold, evens out what grows like 1 / sqrt(1 - rho^2) at the end.
const uint STEPS = 6u;
const float STEP[STEPS] = float[](0.06639039, 0.31009584, 0.61645563, 0.85507481, 0.97130523, 0.99885991);
const float STEP_WEIGHT[STEPS] = float[](0.16553968, 0.29965026, 0.28978359, 0.17813035, 0.06111132, 0.00578481);

// The contribution of one of the first variable's two correlations along the path: the density of the two variables,
// times the chance that the third is positive. `r` is their correlation, `s` and `q` are the third's with the first and
// with the other.
float path_density(float h, float k, float third, float r, float s, float q) {
    float rest = 1.0 - r * r;
    float open = max(rest - s * s - q * q + 2.0 * r * s * q, 1e-12);
    float mean = (s - r * q) * h + (q - r * s) * k;
    float density = exp((r * h * k - 0.5 * (h * h + k * k)) / rest) * inversesqrt(rest);
    return density * phi((third * rest - mean) * inversesqrt(rest * open));
}

// The chance that three variables are positive. The path starts with the first one independent of the others, which are the
// two that depend most on each other.
float three_positive(Threshold t, Threshold u, Threshold v, out vec3 pairs) {
    vec2 tu = correlation(t.direction, u.direction);
    vec2 tv = correlation(t.direction, v.direction);
    vec2 uv = correlation(u.direction, v.direction);
    float p = phi(t.z);
    float q = phi(u.z);
    float r = phi(v.z);
    float with_u = both_positive(t.z, u.z, p, q, tu);
    float with_v = both_positive(t.z, v.z, p, r, tv);
    float others = both_positive(u.z, v.z, q, r, uv);
    pairs = vec3(with_u, with_v, others);
    // The pairs bound the chance; where correlations are full the bounds meet.
    float high = min(with_u, min(with_v, others));
    float low = max(with_u + with_v - p, max(with_u + others - q, with_v + others - r));
    vec3 z = vec3(t.z, u.z, v.z);
    float first = p;
    float rest = others;
    vec3 rho = vec3(tu.x, tv.x, uv.x);
    if (abs(tu.x) > max(abs(tv.x), abs(uv.x))) {
        z = z.zxy;
        first = r;
        rest = with_u;
        rho = vec3(tv.x, uv.x, tu.x);
    } else if (abs(tv.x) > abs(uv.x)) {
        z = z.yxz;
        first = q;
        rest = with_v;
        rho = vec3(tu.x, uv.x, tv.x);
    }
    float sum = 0.0;
    for (uint i = 0u; i < STEPS; i++) {
        float a = rho.x * STEP[i];
        float b = rho.y * STEP[i];
        sum += STEP_WEIGHT[i] * (rho.x * path_density(z.x, z.y, z.z, a, b, rho.z)
            + rho.y * path_density(z.x, z.z, z.y, b, a, rho.z));
    }
    return min(max(first * rest + INVERSE_TAU * sum, max(low, 0.0)), high);
}

#endif
