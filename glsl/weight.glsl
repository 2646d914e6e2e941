// The weight w of a cut splat in a pixel, and what it does to alpha. Included by stages that turn splats into pixels, after
// they have declared the buffer `cut_records`, the constants of weight_constants.glsl, and the parameters sigma, cut_stride and
// principal_point.
#ifndef RARA_WEIGHT
#define RARA_WEIGHT
#include "region/share.glsl"
#include "tail.glsl"
#include "region/combination.glsl"
#include "region/term_curves.glsl"

vec2 principal_point() {
    return push.params.principal_point;
}

Sight line_of_sight(uint base, vec2 delta, vec2 pixel_centre) {
    vec2 pixel = pixel_centre - principal_point();
    return sight_through(cut_records.at[base], cut_records.at[base + 1u], cut_records.at[base + 2u], pixel, delta);
}

// The weight of several surfaces, or of one that bends. In mode `rara` none but combined records come here.
float surfaces_weight(Sight s, uint base, uint flags, RecordSides sides) {
    bool is_combined = COMBINED && (flags & CUT_COMBINED) != 0u;
    float share = is_combined || LISTS_TOO || CLIP_MODE == MODE_RARA
        ? combined_weight(s, base, flags, sides, push.params.sigma)
        : several_weight(s, determinant(s), base, flags >> CUT_COUNT_SHIFT);
    return is_combined ? share : combined(flags, share);
}

// The weight of mode `exact` with the camera inside the splat: only what is in front of the eye counts, as part and as whole. Such a splat
// is so large that the low-pass is nothing. The planes are thresholds in one variable along the ray: those that keep the
// far side bound it from below, as the eye does, and the others from above.
float front_weight(uint base, uint flags, vec2 delta, vec2 pixel_centre) {
    uint count = flags >> CUT_COUNT_SHIFT;
    Sight s = line_of_sight(base, delta, pixel_centre);
    float det = determinant(s);
    float far = 1.0;
    float gone = 0.0;
    bool keeps;
    float front = beam_z(s, det, cut_records.at[base + CUT_HEADER + count], keeps);
    for (uint plane = 0u; plane < count; plane++) {
        float z = beam_z(s, det, plane_of(base, plane), keeps);
        if (keeps) {
            far = min(far, tail_ratio(z, front));
        } else {
            gone = max(gone, tail_ratio(-z, front));
        }
    }
    return combined(flags, max(0.0, far - gone));
}

// The weight of mode `rara`: the visible share of the chord that the ray cuts out of the ellipsoid (paper section 3.3 and
// eq. 11). The line is p + t c/|c| with p its point nearest the centre; |p|^2 = |delta.x b2 - delta.y b1|^2 / |c|^2 needs no
// inverse of M and no B^2 - 4 A C.
float chord_weight(uint base, uint flags, vec2 delta, vec2 pixel_centre) {
    uint count = flags >> CUT_COUNT_SHIFT;
    Sight s = line_of_sight(base, delta, pixel_centre);
    float cc = dot(s.c, s.c);
    float sigma = push.params.sigma;
    bool degenerate = !(cc > 0.0);
    float inverse = degenerate ? 0.0 : 1.0 / cc;
    vec3 nearest = (s.delta.x * cross(s.b2, s.c) + s.delta.y * cross(s.c, s.b1)) * inverse;
    vec3 direction = s.c * sqrt(inverse);
    vec3 offset = s.delta.x * s.b2 - s.delta.y * s.b1;
    float half_square = degenerate ? -1.0 : sigma * sigma - dot(offset, offset) * inverse;
    float high = half_square > 0.0 ? sqrt(half_square) : 0.0;
    float low = -high;
    if ((flags & CUT_FRONT) != 0u) {
        vec4 front = cut_records.at[base + CUT_HEADER + count];
        // The view direction's component along the line is never negative.
        low = max(low, -(front.w + dot(front.xyz, nearest)) / max(dot(front.xyz, direction), 1e-30));
    }
    float whole = high - low;
    bool miss = !(half_square > 0.0) || !(whole > 0.0);
    if (miss && MISS != MISS_PEAK) {
        return MISS == MISS_KEEP ? 1.0 : 0.0;
    }
    bool inside = true;
    for (uint plane = 0u; plane < count; plane++) {
        vec4 half_space = plane_of(base, plane);
        float value = half_space.w + dot(half_space.xyz, nearest);
        float slope = dot(half_space.xyz, direction);
        if (miss || slope == 0.0) {
            // A plane's own points are visible, so that they are no part of a complement.
            inside = inside && (value > 0.0 || (value == 0.0 && (flags & CUT_UNION) == 0u));
        } else if (slope > 0.0) {
            low = max(low, -value / slope);
        } else {
            high = min(high, -value / slope);
        }
    }
    float share = !inside ? 0.0 : miss ? 1.0 : max(0.0, high - low) / whole;
    return combined(flags, share);
}

// The share that follows from a surface's terms.
float terms_share(Terms terms) {
    Crossings c = crossings(terms);
    if (abs(c.other) < PHI_ONE) {
        return share_of_two(c.z, c.other, c.between);
    }
    return abs(c.z) < PHI_ONE ? phi(c.z) : c.z > 0.0 ? 1.0 : 0.0;
}

// The same from a record that holds them.
float terms_weight(uint base, vec2 uv) {
    vec4 at[TERMS_VECTORS];
    for (uint i = 0u; i < TERMS_VECTORS; i++) {
        at[i] = cut_records.at[base + i];
    }
    TermCurves t = terms_of(at);
    return terms_share(Terms(curve_z(t.value, uv), curve_z(t.variance, uv), curve_z(t.bend, uv)));
}

// The weight by the frame's mode and the record's form. `delta` is the pixel's centre relative to the splat's centre, `uv`
// the same in the splat's own coordinates (curve.glsl).
float cut_weight(uint cut, vec2 delta, vec2 uv, vec2 pixel_centre) {
    uint base = cut * push.params.cut_stride;
    uint flags = to_uint(cut_records.at[base].w);
    bool is_combined = COMBINED && (flags & CUT_COMBINED) != 0u;
    if (CLIP_MODE == MODE_RARA && !is_combined) {
        return chord_weight(base, flags, delta, pixel_centre);
    }
    Sight s = line_of_sight(base, delta, pixel_centre);
    if (CLIP_MODE == MODE_EXACT && !is_combined) {
        if ((flags & CUT_FRONT) != 0u) {
            return front_weight(base, flags, delta, pixel_centre);
        }
        if (COMBINED && (flags & CUT_TERMS) != 0u) {
            return terms_weight(base, uv);
        }
        if ((flags & CUT_CURVE) != 0u) {
            return phi(curve_z(curve_of(cut_records.at[base], cut_records.at[base + 1u], cut_records.at[base + 2u], cut_records.at[base + 3u]), uv));
        }
        if (!SEVERAL || flags >> CUT_COUNT_SHIFT == 1u) {
            bool far;
            return phi(beam_z(s, determinant(s), cut_records.at[base + CUT_HEADER], far));
        }
    }
    return surfaces_weight(s, base, flags, all_cutting());
}

// The paper scales alpha (eq. 12). The default for `exact` scales optical depth, -ln(1 - alpha): then complementary
// halves rebuild the whole. A weight of one leaves alpha untouched to the bit. What is opaque has a finite depth, whose
// logarithm exists.
float decayed(float alpha, float weight) {
    if (weight >= 1.0) {
        return alpha;
    }
    return DECAY == DECAY_LINEAR ? alpha * weight : 1.0 - exp2(weight * log2(max(1.0 - alpha, TRANSMITTANCE_OPAQUE)));
}

#endif
