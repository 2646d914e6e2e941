// The usual cut splat's weight without lines of sight: z is a polynomial in the splat's own coordinates, fitted to the
// perspective-exact form and kept only where it is as good. The rasteriser carries one of degree two; a record holds one of
// degree four, or three polynomials from which z follows: where a surface that bends is steep, no single one is near it.
#ifndef RARA_CURVE
#define RARA_CURVE
#include "polynomial.glsl"
#include "quad.glsl"
#include "region/crossing.glsl"
#include "region/term_curves.glsl"

// True where records may hold the terms of a surface, and strips are found from samples: both fill a GPU's registers.
layout(constant_id = 0) const bool HAS_TERMS = false;
// Largest error of alpha times weight that a fit may have: a twenty-fifth of a level of 8 bits.
const float CURVE_TOLERANCE = 1.5e-4;

// Everything needed to evaluate the exact form at a point of the splat.
struct CurveSource {
    vec4 h0, h1, h2; // header of the cutoff record
    vec4 half_space; // in the beam form
    bool bends; // whether the surface is this one instead
    UnitSurface surface;
    vec2 centre; // relative to the principal point, px
    vec3 conic; // Cholesky factor, 1/px
};

// The exact form at a point.
struct Exact {
    float z;
    bool is_one; // whether this z is the weight's: the surface is not crossed twice, and bends little
    Terms terms;
    bool has_terms; // whether the weight follows from them, and from the first crossing alone
};

Exact exact_form(CurveSource source, vec2 uv) {
    float dx = uv.x / source.conic.x;
    vec2 delta = vec2(dx, (uv.y - source.conic.y * dx) / source.conic.z);
    Sight sight = sight_through(source.h0, source.h1, source.h2, source.centre + delta, delta);
    if (COMBINED && source.bends) {
        float moved;
        Crossed crossing = crossed(line_through(sight), source.surface, moved);
        // Where the surface is not crossed, its z has to say so too.
        float z = crossing.at.smooth_z;
        bool has_terms = moved == 0.0 && abs(crossing.at.other) >= PHI_ONE;
        bool is_one = has_terms && (abs(z) >= PHI_ONE || abs(crossing.at.z) < FAR_AWAY);
        return Exact(z, is_one, crossing.terms, has_terms);
    }
    bool far;
    return Exact(beam_z(sight, determinant(sight), source.half_space, far), true, Terms(0.0, 0.0, 0.0), false);
}

// There are eight samples on each of five rings around the centre, every other ring turned by half a step. The fit uses
// the first two rings. The others are checked where it is not close on the first.
const uint CURVE_STEPS = 8u;
const uint CURVE_RINGS = 5u;
const uint CURVE_SAMPLES = CURVE_RINGS * CURVE_STEPS;
// The rings from the centre outwards.
const uint CURVE_OUTWARDS[CURVE_RINGS] = uint[](0u, 3u, 1u, 4u, 2u);

// A ring's radius in deviations; the last ring is the contour at which the splat ends.
float curve_radius(uint ring, float extent) {
    float last = max(extent, 2.5);
    return ring == 0u ? 1.0 : ring == 1u ? 2.0 : ring == 2u ? last : ring == 3u ? 1.5 : 0.5 * (2.0 + last);
}

vec2 curve_direction(uint ring, uint step) {
    float turn = 0.78539816 * (float(step) + 0.5 * float(ring & 1u));
    return vec2(cos(turn), sin(turn));
}

struct CurveSamples {
    float centre;
    float at[CURVE_SAMPLES];
    bool is_one; // whether a single z is the weight's at each of them
    Terms centre_terms;
    Terms terms[CURVE_SAMPLES];
    bool has_terms; // whether the weight follows from them at each
};

const uint FITTED_RINGS = 2u;

// The samples that are looked at first: what is fitted, and of a surface that bends the contour, where it may be crossed twice.
uint first_rings(CurveSource source) {
    return COMBINED && source.bends ? FITTED_RINGS + 1u : FITTED_RINGS;
}

// The centre is the first sample, and those of the rings follow.
const uint ALL_SAMPLES = 1u + CURVE_SAMPLES;

uint first_samples(CurveSource source) {
    return 1u + first_rings(source) * CURVE_STEPS;
}

void take_samples(CurveSource source, uint first, uint end, float extent, inout CurveSamples z) {
    for (uint i = first; i < end; i++) {
        uint at = max(i, 1u) - 1u;
        uint ring = at / CURVE_STEPS;
        vec2 place = curve_radius(ring, extent) * curve_direction(ring, at % CURVE_STEPS);
        Exact exact = exact_form(source, i == 0u ? vec2(0.0) : place);
        if (i == 0u) {
            z.centre = exact.z;
            z.is_one = exact.is_one;
            z.centre_terms = exact.terms;
            z.has_terms = HAS_TERMS && exact.has_terms;
            continue;
        }
        z.at[at] = exact.z;
        z.is_one = z.is_one && exact.is_one;
        if (HAS_TERMS && COMBINED) {
            z.terms[at] = exact.terms;
            z.has_terms = z.has_terms && exact.has_terms;
        }
    }
}

// Fourier coefficients of the samples of a ring.
struct Harmonics {
    float mean;
    vec2 first, second, third;
    float fourth; // of cosine on rings that are not turned, of sine on those that are
};

Harmonics harmonics(float at[CURVE_SAMPLES], uint ring) {
    Harmonics h = Harmonics(0.0, vec2(0.0), vec2(0.0), vec2(0.0), 0.0);
    for (uint step = 0u; step < CURVE_STEPS; step++) {
        vec2 one = curve_direction(ring, step);
        vec2 two = vec2(one.x * one.x - one.y * one.y, 2.0 * one.x * one.y);
        vec2 three = vec2(two.x * one.x - two.y * one.y, two.x * one.y + two.y * one.x);
        float here = at[ring * CURVE_STEPS + step] / float(CURVE_STEPS);
        h.mean += here;
        h.first += 2.0 * here * one;
        h.second += 2.0 * here * two;
        h.third += 2.0 * here * three;
        h.fourth += (step & 1u) == 0u ? here : -here;
    }
    return h;
}

// Makes fits from a function's values at the centre and on the rings at 1 and 2 deviations. Each harmonic's lowest powers of the
// radius are fitted; the factors balance what the next power leaves on the two rings, weighted by alpha there, 0.61 and 0.14.
// Where the degree allows a harmonic two powers, they pass through both rings.
void fitted(float centre, float at[CURVE_SAMPLES], out Curve square, out Curve cubic, out Curve quartic) {
    Harmonics one = harmonics(at, 0u);
    Harmonics two = harmonics(at, 1u);
    float mean = 0.53 * (one.mean - centre) + 0.1175 * (two.mean - centre); // r^2
    vec2 second = 0.53 * one.second + 0.1175 * two.second; // r^2
    square.at = centre;
    square.slope = 0.693 * one.first + 0.1535 * two.first; // r
    square.bend = vec3(mean + second.x, 2.0 * second.y, mean - second.x);
    square.twist = vec4(0.0);
    square.wave = vec4(0.0);
    square.ripple = 0.0;
    vec2 first = (two.first - 2.0 * one.first) / 6.0; // r^3
    vec2 third = 0.36 * one.third + 0.08 * two.third; // r^3
    cubic = square;
    cubic.slope = one.first - first;
    cubic.twist = vec4(first.x + third.x, first.y + 3.0 * third.y, first.x - 3.0 * third.x, first.y - third.y);
    float mean_4 = ((two.mean - centre) - 4.0 * (one.mean - centre)) / 12.0; // r^4
    vec2 second_4 = (two.second - 4.0 * one.second) / 12.0; // r^4
    vec2 fourth = vec2(one.fourth, two.fourth / 16.0); // r^4
    float mean_2 = one.mean - centre - mean_4;
    vec2 second_2 = one.second - second_4;
    quartic = cubic;
    quartic.bend = vec3(mean_2 + second_2.x, 2.0 * second_2.y, mean_2 - second_2.x);
    quartic.wave = vec4(mean_4 + second_4.x + fourth.x, 2.0 * second_4.y + 4.0 * fourth.y, 2.0 * mean_4 - 6.0 * fourth.x,
                        2.0 * second_4.y - 4.0 * fourth.y);
    quartic.ripple = mean_4 - second_4.x + fourth.x;
}

vec2 curve_gradient(Curve c, vec2 d) {
    float u = d.x;
    float v = d.y;
    float along_u = c.slope.x + u * (2.0 * c.bend.x + u * (3.0 * c.twist.x + u * 4.0 * c.wave.x))
        + v * (c.bend.y + u * (2.0 * c.twist.y + u * 3.0 * c.wave.y) + v * (c.twist.z + u * 2.0 * c.wave.z + v * c.wave.w));
    float along_v = c.slope.y + u * (c.bend.y + u * (c.twist.y + u * c.wave.y))
        + v * (2.0 * (c.bend.z + u * (c.twist.z + u * c.wave.z)) + v * (3.0 * (c.twist.w + u * c.wave.w) + v * 4.0 * c.ripple));
    return vec2(along_u, along_v);
}

// By how much the exact form changes from a sample to its neighbours, along its ring and to the rings inside and outside.
float exact_change(CurveSamples z, uint outwards, uint step) {
    uint ring = CURVE_OUTWARDS[outwards];
    float here = z.at[ring * CURVE_STEPS + step];
    float next = z.at[ring * CURVE_STEPS + (step + 1u) % CURVE_STEPS];
    float last = z.at[ring * CURVE_STEPS + (step + CURVE_STEPS - 1u) % CURVE_STEPS];
    float inside = outwards == 0u ? z.centre : z.at[CURVE_OUTWARDS[outwards - 1u] * CURVE_STEPS + step];
    float outside = outwards + 1u == CURVE_RINGS ? here : z.at[CURVE_OUTWARDS[outwards + 1u] * CURVE_STEPS + step];
    return max(max(abs(next - here), abs(last - here)), max(abs(inside - here), abs(outside - here)));
}

// True when a fit is close enough on the first rings. What it leaves grows with the third or fourth power of the radius; weighted by
// alpha, that is most on the rings that are fitted, between which the factors of the fit balance it.
bool is_close(Curve curve, CurveSource source, CurveSamples z, float opacity, float extent) {
    bool close = z.is_one;
    for (uint ring = 0u; ring < first_rings(source); ring++) {
        float r = curve_radius(ring, extent);
        float alpha = opacity * exp(-0.5 * r * r);
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            float fit = curve_z(curve, r * curve_direction(ring, step));
            close = close && 0.4 * alpha * abs(fit - z.at[ring * CURVE_STEPS + step]) <= 0.75 * CURVE_TOLERANCE;
        }
    }
    return close;
}

// True when no pixel's alpha differs by more than CURVE_TOLERANCE from the exact form's.
bool is_good(Curve curve, CurveSamples z, float opacity, float extent) {
    if (!z.is_one) {
        return false;
    }
    for (uint outwards = 0u; outwards < CURVE_RINGS; outwards++) {
        uint ring = CURVE_OUTWARDS[outwards];
        float r = curve_radius(ring, extent);
        float alpha = opacity * exp(-0.5 * r * r);
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            vec2 d = r * curve_direction(ring, step);
            float exact = z.at[ring * CURVE_STEPS + step];
            float fit = curve_z(curve, d);
            // The test is negated, so that a fit that is no number is no good.
            if (!(0.4 * alpha * abs(fit - exact) <= CURVE_TOLERANCE)) {
                // A steep edge may pass between the samples: what counts is z's error wherever an edge, the exact one or
                // the fit's, may come near. Where both are on one side, far enough for either to stay there, nothing does.
                float change = max(length(curve_gradient(curve, d)), exact_change(z, outwards, step));
                if (!(min(abs(exact), abs(fit)) >= 5.0 + change && exact * fit >= 0.0)) {
                    return false;
                }
            }
        }
    }
    return true;
}

// Polynomials of a surface's terms.
TermCurves fitted_terms(CurveSamples samples) {
    float value[CURVE_SAMPLES];
    float variance[CURVE_SAMPLES];
    float bend[CURVE_SAMPLES];
    for (uint i = 0u; i < FITTED_RINGS * CURVE_STEPS; i++) {
        value[i] = samples.terms[i].value;
        variance[i] = samples.terms[i].variance;
        bend[i] = samples.terms[i].bend;
    }
    TermCurves fit;
    Curve square;
    Curve cubic;
    Curve quartic;
    fitted(samples.centre_terms.value, value, square, cubic, fit.value);
    fitted(samples.centre_terms.variance, variance, square, fit.variance, quartic);
    fitted(samples.centre_terms.bend, bend, fit.bend, cubic, quartic);
    return fit;
}

// The same of what follows from a surface's terms. Their errors are weighted by what each does to the weight where that is most, as
// if the edge were at every sample.
bool is_good(TermCurves fit, CurveSamples samples, float opacity, float extent) {
    bool good = samples.has_terms;
    for (uint ring = 0u; ring < CURVE_RINGS; ring++) {
        float r = curve_radius(ring, extent);
        float alpha = opacity * exp(-0.5 * r * r);
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            vec2 d = r * curve_direction(ring, step);
            Terms exact = samples.terms[ring * CURVE_STEPS + step];
            float n = sqrt(exact.variance);
            float value = abs(curve_z(fit.value, d) - exact.value) / n;
            float variance = abs(curve_z(fit.variance, d) - exact.variance) / exact.variance;
            float bend = abs(curve_z(fit.bend, d) - exact.bend) / (exact.variance * n);
            good = good && alpha * (0.4 * value + 0.12 * variance + 0.3 * bend) <= CURVE_TOLERANCE;
        }
    }
    return good;
}

// Bounds the strip in which a curve is open: its terms beyond the first add and take no more than their sizes on the contour.
OpenStrip open_strip(Curve c, float extent) {
    float square = extent * extent;
    float rest = square * extent * (dot(abs(c.twist), vec4(1.0)) + extent * dot(abs(c.wave), vec4(1.0)));
    vec3 bend = square * c.bend;
    float ripple = square * square * c.ripple;
    float above = max(bend.x, 0.0) + abs(bend.y) + max(bend.z, 0.0) + rest + max(ripple, 0.0);
    float below = max(-bend.x, 0.0) + abs(bend.y) + max(-bend.z, 0.0) + rest + max(-ripple, 0.0);
    return OpenStrip(c.slope, c.at + TRIM_DEVIATIONS + above, c.at - TRIM_DEVIATIONS - below);
}

// How far the next sample is from one, at most, in deviations.
const float SAMPLES_APART = 1.2;

// Does the same from samples and a polynomial whose first terms are near them. What these leave is bounded by the samples near either end
// of the strip, with a fifth and a little more for what lies between them, so that the strip is narrower.
OpenStrip open_strip(Curve curve, CurveSamples z, uint rings, float extent) {
    float step_most = SAMPLES_APART * length(curve.slope);
    vec2 most = vec2(-1e20); // by how much z is above the first terms at the end that is away, and below them at the other
    float spread = 0.0;
    for (uint ring = 0u; ring < rings; ring++) {
        for (uint step = 0u; step < CURVE_STEPS; step++) {
            float here = z.at[ring * CURVE_STEPS + step];
            float plain = curve.at + dot(curve.slope, curve_radius(ring, extent) * curve_direction(ring, step));
            float rest = here - plain;
            vec2 beyond = vec2(here + TRIM_DEVIATIONS, TRIM_DEVIATIONS - here); // the ends, where positive
            bvec2 near = lessThan(abs(beyond), vec2(2.0 + step_most));
            spread = any(near) ? max(spread, abs(rest)) : spread;
            most.x = max(most.x, near.x ? rest : beyond.x > 0.0 ? step_most - TRIM_DEVIATIONS - plain : -1e20);
            most.y = max(most.y, near.y ? -rest : beyond.y > 0.0 ? step_most - TRIM_DEVIATIONS + plain : -1e20);
        }
    }
    most = z.is_one || z.has_terms ? most + 0.2 * spread + 0.05 : vec2(1e20);
    return OpenStrip(curve.slope, curve.at + TRIM_DEVIATIONS + most.x, curve.at - TRIM_DEVIATIONS - most.y);
}

// Joins the strips of two surfaces. What both have to keep is away where one is away, and what either may keep is whole where one
// is whole. A strip has room for one of the two lines, and takes the one that leaves less.
OpenStrip joined(OpenStrip one, OpenStrip other, bool is_or) {
    vec2 lengths = vec2(length(one.slope), length(other.slope));
    bool is_first = is_or ? one.whole * lengths.y > other.whole * lengths.x : one.away * lengths.y < other.away * lengths.x;
    OpenStrip strip = is_first ? one : other;
    return OpenStrip(strip.slope, is_or ? 1e20 : strip.away, is_or ? strip.whole : -1e20);
}

// A curve of degree two as a function of the pixel, which is how the rasteriser carries it.
void in_pixels(Curve c, vec3 conic, out vec3 linear, out vec3 curvature) {
    vec2 u = vec2(conic.x, 0.0);
    vec2 v = conic.yz;
    linear = vec3(c.at, c.slope.x * u + c.slope.y * v);
    curvature = vec3(c.bend.x * u.x * u.x + c.bend.y * u.x * v.x + c.bend.z * v.x * v.x,
                     c.bend.y * u.x * v.y + 2.0 * c.bend.z * v.x * v.y, c.bend.z * v.y * v.y);
}

#endif
