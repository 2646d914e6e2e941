// The usual cut splat's weight without lines of sight: z as a polynomial in the pixel, fitted to the perspective-exact
// form and kept only where it is as good. Of degree two, the rasteriser carries it; of degree four, a record holds it.
#ifndef RARA_CURVE
#define RARA_CURVE
#include "extent.glsl"
#include "sight.glsl"

// z = at + slope . d + bend . (dx^2, dx dy, dy^2) + twist . (dx^3, dx^2 dy, dx dy^2, dy^3)
//     + wave . (dx^4, dx^3 dy, dx^2 dy^2, dx dy^3) + ripple dy^4.
struct Curve {
    float at;
    vec2 slope;
    vec3 bend;
    vec4 twist;
    vec4 wave;
    float ripple;
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
    float fourth; // of cosine on rings that are not turned, of sine on those that are
};

Harmonics harmonics(CurveSamples z, uint ring) {
    Harmonics h = Harmonics(0.0, vec2(0.0), vec2(0.0), vec2(0.0), 0.0);
    for (uint step = 0u; step < CURVE_STEPS; step++) {
        vec2 one = curve_direction(ring, step);
        vec2 two = vec2(one.x * one.x - one.y * one.y, 2.0 * one.x * one.y);
        vec2 three = vec2(two.x * one.x - two.y * one.y, two.x * one.y + two.y * one.x);
        float here = z.at[ring * CURVE_STEPS + step] / float(CURVE_STEPS);
        h.mean += here;
        h.first += 2.0 * here * one;
        h.second += 2.0 * here * two;
        h.third += 2.0 * here * three;
        h.fourth += (step & 1u) == 0u ? here : -here;
    }
    return h;
}

// Both fits in deviations along the axes, from the rings at 1 and 2. Each harmonic's lowest powers of the radius are
// fitted; the factors balance what the next power leaves on the two rings, weighted by alpha there, 0.61 and 0.14. Where
// the degree allows a harmonic two powers, they pass through both rings.
void fitted(CurveSamples z, out Curve square, out Curve quartic) {
    Harmonics one = harmonics(z, 0u);
    Harmonics two = harmonics(z, 1u);
    float mean = 0.53 * (one.mean - z.centre) + 0.1175 * (two.mean - z.centre); // r^2
    vec2 second = 0.53 * one.second + 0.1175 * two.second; // r^2
    square.at = z.centre;
    square.slope = 0.693 * one.first + 0.1535 * two.first; // r
    square.bend = vec3(mean + second.x, 2.0 * second.y, mean - second.x);
    square.twist = vec4(0.0);
    square.wave = vec4(0.0);
    square.ripple = 0.0;
    vec2 first = (two.first - 2.0 * one.first) / 6.0; // r^3
    vec2 third = 0.36 * one.third + 0.08 * two.third; // r^3
    float mean_4 = ((two.mean - z.centre) - 4.0 * (one.mean - z.centre)) / 12.0; // r^4
    vec2 second_4 = (two.second - 4.0 * one.second) / 12.0; // r^4
    vec2 fourth = vec2(one.fourth, two.fourth / 16.0); // r^4
    float mean_2 = one.mean - z.centre - mean_4;
    vec2 second_2 = one.second - second_4;
    quartic.at = z.centre;
    quartic.slope = one.first - first;
    quartic.bend = vec3(mean_2 + second_2.x, 2.0 * second_2.y, mean_2 - second_2.x);
    quartic.twist = vec4(first.x + third.x, first.y + 3.0 * third.y, first.x - 3.0 * third.x, first.y - third.y);
    quartic.wave = vec4(mean_4 + second_4.x + fourth.x, 2.0 * second_4.y + 4.0 * fourth.y, 2.0 * mean_4 - 6.0 * fourth.x,
                        2.0 * second_4.y - 4.0 * fourth.y);
    quartic.ripple = mean_4 - second_4.x + fourth.x;
}

float curve_z(Curve c, vec2 d) {
    float at = c.at + d.x * (c.slope.x + d.x * (c.bend.x + d.x * (c.twist.x + d.x * c.wave.x)));
    float slope = c.slope.y + d.x * (c.bend.y + d.x * (c.twist.y + d.x * c.wave.y));
    float second = c.bend.z + d.x * (c.twist.z + d.x * c.wave.z);
    float third = c.twist.w + d.x * c.wave.w;
    return at + d.y * (slope + d.y * (second + d.y * (third + d.y * c.ripple)));
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
                       t.y * d.x * d.x + 2.0 * t.z * d.x * d.y + 3.0 * t.w * d.y * d.y)
                + r * r * r * vec2(4.0 * largest(curve.wave.xyz), 4.0 * max(abs(curve.wave.w), abs(curve.ripple)));
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

// The product of two forms of degree two: the last factor apart.
vec4 squared(vec3 a, vec3 b, out float last) {
    last = a.z * b.z;
    return vec4(a.x * b.x, a.x * b.y + a.y * b.x, a.x * b.z + a.y * b.y + a.z * b.x, a.y * b.z + a.z * b.y);
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
    float last;
    pixels.wave = c.wave.x * squared(ss, ss, last);
    pixels.ripple = c.wave.x * last;
    pixels.wave += c.wave.y * squared(ss, st, last);
    pixels.ripple += c.wave.y * last;
    pixels.wave += c.wave.z * squared(ss, tt, last);
    pixels.ripple += c.wave.z * last;
    pixels.wave += c.wave.w * squared(st, tt, last);
    pixels.ripple += c.wave.w * last;
    pixels.wave += c.ripple * squared(tt, tt, last);
    pixels.ripple += c.ripple * last;
    return pixels;
}

#endif
