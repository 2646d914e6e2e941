// The usual cut splat's weight without its record: z as a polynomial of degree two in the pixel, fitted to the
// perspective-exact form and kept only where it is as good. Affine splats are the case without curvature.
#ifndef RARA_CURVE
#define RARA_CURVE
#include "extent.glsl"
#include "sight.glsl"

struct Curve {
    vec3 plane; // z at the centre, dz/dx, dz/dy
    vec3 curvature; // factors of dx^2, dx dy, dy^2
    bool good; // no pixel's alpha differs by more than CURVE_TOLERANCE from the exact form's
};

// Largest error of alpha times weight that a fit may have: a twenty-fifth of a level of 8 bits.
const float CURVE_TOLERANCE = 1.5e-4;
// The fit is exact at the centre and this many deviations from it, where alpha and its change are both large.
const float CURVE_NODE = 2.0;

// Everything needed to evaluate the exact form at a point of the splat.
struct CurveSource {
    vec4 h0, h1, h2; // header of the cutoff record
    vec4 plane; // in the ray form
    vec2 centre; // relative to the principal point, px
    vec2 first, second; // one deviation along the footprint's axes, px
};

float exact_z(CurveSource source, vec2 st) {
    vec2 delta = st.x * source.first + st.y * source.second;
    Sight sight = sight_through(source.h0, source.h1, source.h2, source.centre + delta, delta);
    bool far;
    return ray_z(sight, determinant(sight), source.plane, far);
}

Curve fitted(CurveSource source, float opacity) {
    // In coordinates along the axes: exact at nine points but for the mean of four.
    const float r = CURVE_NODE;
    const float h = 0.70710678 * CURVE_NODE;
    float c0 = exact_z(source, vec2(0.0));
    float e = exact_z(source, vec2(r, 0.0));
    float w = exact_z(source, vec2(-r, 0.0));
    float n = exact_z(source, vec2(0.0, r));
    float s = exact_z(source, vec2(0.0, -r));
    float cross_difference = exact_z(source, vec2(h, h)) + exact_z(source, vec2(-h)) - exact_z(source, vec2(h, -h))
        - exact_z(source, vec2(-h, h));
    vec2 slope = vec2(e - w, n - s) / (2.0 * r);
    vec3 bend = vec3((e + w - 2.0 * c0) / (2.0 * r * r), cross_difference / (4.0 * h * h), (n + s - 2.0 * c0) / (2.0 * r * r));

    float worst = 0.0;
    for (int ring = 1; ring <= 3; ring++) {
        for (int step = 0; step < 8; step++) {
            float turn = 0.78539816 * (float(step) + 0.5 * float(ring & 1));
            vec2 st = float(ring) * vec2(cos(turn), sin(turn));
            float z = c0 + dot(slope, st) + bend.x * st.x * st.x + bend.y * st.x * st.y + bend.z * st.y * st.y;
            float alpha = opacity * exp(-0.5 * dot(st, st));
            // A steep edge may pass between the points: what counts is z's error wherever the edge may come near.
            float exact = exact_z(source, st);
            vec2 gradient = slope + vec2(2.0 * bend.x * st.x + bend.y * st.y, 2.0 * bend.z * st.y + bend.y * st.x);
            if (abs(exact) < 5.0 + length(gradient)) {
                worst = max(worst, 0.4 * alpha * abs(z - exact));
            }
        }
    }

    // In pixels: s and t are the components of delta along the axes.
    vec2 u = source.first / dot(source.first, source.first);
    vec2 v = source.second / dot(source.second, source.second);
    Curve curve;
    curve.plane = vec3(c0, slope.x * u + slope.y * v);
    curve.curvature = vec3(bend.x * u.x * u.x + bend.y * u.x * v.x + bend.z * v.x * v.x,
                           2.0 * bend.x * u.x * u.y + bend.y * (u.x * v.y + u.y * v.x) + 2.0 * bend.z * v.x * v.y,
                           bend.x * u.y * u.y + bend.y * u.y * v.y + bend.z * v.y * v.y);
    curve.good = worst <= CURVE_TOLERANCE;
    return curve;
}

#endif
