// The usual cut splat's weight without lines of sight: z as a polynomial in the pixel, fitted to the perspective-exact
// form and kept only where it is as good. Of degree two, the rasteriser carries it; of degree three, a record holds it.
#ifndef RARA_CURVE
#define RARA_CURVE
#include "extent.glsl"
#include "sight.glsl"

// z = at + slope . d + bend . (dx^2, dx dy, dy^2) + twist . (dx^3, dx^2 dy, dx dy^2, dy^3).
struct Curve {
    float at;
    vec2 slope;
    vec3 bend;
    vec4 twist;
};

// Largest error of alpha times weight that a fit may have: a twenty-fifth of a level of 8 bits.
const float CURVE_TOLERANCE = 1.5e-4;

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

// The samples: eight on each of four rings around the centre, every other ring turned by half a step. The first two are
// fitted to, all of them are checked.
const uint CURVE_STEPS = 8u;
const uint CURVE_RINGS = 4u;
const uint CURVE_SAMPLES = CURVE_RINGS * CURVE_STEPS;

// Deviations from the centre: 1, 2, 3 and 1.5.
float curve_radius(uint ring) {
    return ring == 3u ? 1.5 : float(ring + 1u);
}

vec2 curve_direction(uint ring, uint step) {
    float turn = 0.78539816 * (float(step) + 0.5 * float(ring & 1u));
    return vec2(cos(turn), sin(turn));
}

struct CurveSamples {
    float centre;
    float at[CURVE_SAMPLES];
};

CurveSamples sampled(CurveSource source) {
    CurveSamples z;
    z.centre = exact_z(source, vec2(0.0));
    for (uint ring = 0u; ring < CURVE_RINGS; ring++) {
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            z.at[ring * CURVE_STEPS + step] = exact_z(source, curve_radius(ring) * curve_direction(ring, step));
        }
    }
    return z;
}

// The parts of z on a ring that turn with the angle and its multiples: means of z times cosine and sine.
struct Harmonics {
    float mean;
    vec2 first, second, third;
};

Harmonics harmonics(CurveSamples z, uint ring) {
    Harmonics h = Harmonics(0.0, vec2(0.0), vec2(0.0), vec2(0.0));
    for (uint step = 0u; step < CURVE_STEPS; step++) {
        vec2 one = curve_direction(ring, step);
        vec2 two = vec2(one.x * one.x - one.y * one.y, 2.0 * one.x * one.y);
        vec2 three = vec2(two.x * one.x - two.y * one.y, two.x * one.y + two.y * one.x);
        float here = z.at[ring * CURVE_STEPS + step] / float(CURVE_STEPS);
        h.mean += here;
        h.first += 2.0 * here * one;
        h.second += 2.0 * here * two;
        h.third += 2.0 * here * three;
    }
    return h;
}

// Both fits in deviations along the axes, from the rings at 1 and 2. Each harmonic's lowest powers of the radius are
// fitted; the factors balance what the next power leaves on the two rings, weighted by alpha there, 0.61 and 0.14.
void fitted(CurveSamples z, out Curve square, out Curve cube) {
    Harmonics one = harmonics(z, 0u);
    Harmonics two = harmonics(z, 1u);
    float mean = 0.53 * (one.mean - z.centre) + 0.1175 * (two.mean - z.centre); // r^2
    vec2 second = 0.53 * one.second + 0.1175 * two.second; // r^2
    square.at = z.centre;
    square.slope = 0.693 * one.first + 0.1535 * two.first; // r
    square.bend = vec3(mean + second.x, 2.0 * second.y, mean - second.x);
    square.twist = vec4(0.0);
    vec2 first = (two.first - 2.0 * one.first) / 6.0; // r^3
    vec2 third = 0.36 * one.third + 0.08 * two.third; // r^3
    cube = square;
    cube.slope = one.first - first;
    cube.twist = vec4(first.x + third.x, first.y + 3.0 * third.y, first.x - 3.0 * third.x, first.y - third.y);
}

float curve_z(Curve c, vec2 d) {
    return c.at + d.x * (c.slope.x + d.x * (c.bend.x + d.x * c.twist.x + d.y * c.twist.y) + d.y * c.bend.y)
        + d.y * (c.slope.y + d.y * (c.bend.z + d.x * c.twist.z + d.y * c.twist.w));
}

// Whether no pixel's alpha differs by more than CURVE_TOLERANCE from the exact form's.
bool is_good(Curve curve, CurveSamples z, float opacity) {
    for (uint ring = 0u; ring < CURVE_RINGS; ring++) {
        float r = curve_radius(ring);
        float alpha = opacity * exp(-0.5 * r * r);
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            // A steep edge may pass between the samples: what counts is z's error wherever an edge, the exact one or
            // the fit's, may come near.
            vec2 d = r * curve_direction(ring, step);
            vec4 t = curve.twist;
            vec2 gradient = curve.slope
                + vec2(2.0 * curve.bend.x * d.x + curve.bend.y * d.y, 2.0 * curve.bend.z * d.y + curve.bend.y * d.x)
                + vec2(3.0 * t.x * d.x * d.x + 2.0 * t.y * d.x * d.y + t.z * d.y * d.y,
                       t.y * d.x * d.x + 2.0 * t.z * d.x * d.y + 3.0 * t.w * d.y * d.y);
            float exact = z.at[ring * CURVE_STEPS + step];
            float fit = curve_z(curve, d);
            if (!(min(abs(exact), abs(fit)) >= 5.0 + length(gradient) && exact * fit >= 0.0)) {
                // Not its opposite: what is no number is no good.
                if (!(0.4 * alpha * abs(fit - exact) <= CURVE_TOLERANCE)) {
                    return false;
                }
            }
        }
    }
    return true;
}

// The product of a form of degree two with a linear one.
vec4 raised(vec3 bend, vec2 slope) {
    return vec4(bend * slope.x, 0.0) + vec4(0.0, bend * slope.y);
}

// A curve in deviations along the axes as one in pixels.
Curve in_pixels(Curve c, CurveSource source) {
    // s and t are the components of the pixel's offset along the axes.
    vec2 s = source.first / dot(source.first, source.first);
    vec2 t = source.second / dot(source.second, source.second);
    vec3 ss = vec3(s.x * s.x, 2.0 * s.x * s.y, s.y * s.y);
    vec3 st = vec3(s.x * t.x, s.x * t.y + s.y * t.x, s.y * t.y);
    vec3 tt = vec3(t.x * t.x, 2.0 * t.x * t.y, t.y * t.y);
    Curve pixels;
    pixels.at = clamp(c.at, -1e20, 1e20); // within what the rasteriser carries
    pixels.slope = c.slope.x * s + c.slope.y * t;
    pixels.bend = c.bend.x * ss + c.bend.y * st + c.bend.z * tt;
    pixels.twist = c.twist.x * raised(ss, s) + c.twist.y * raised(ss, t) + c.twist.z * raised(tt, s)
        + c.twist.w * raised(tt, t);
    return pixels;
}

#endif
