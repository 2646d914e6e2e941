// The weight w of a cut splat in a pixel, and what it does to alpha. Included by what turns splats into pixels, after it
// has declared the buffer `cuts` and the constants CLIP_MODE, CLIP_OP, DECAY, MISS and PHI_FORM.
#ifndef RARA_WEIGHT
#define RARA_WEIGHT
#include "sight.glsl"

// The normal distribution's Phi by a logistic of an odd quintic: absolute error 1.9e-5, and Phi(z) + Phi(-z) = 1 to
// rounding. Beyond |z| = 8 the quintic would turn back.
float phi(float z) {
    float x = clamp(z, -8.0, 8.0);
    float s = x * x;
    if (PHI_FORM == PHI_LOGISTIC) {
        return 1.0 / (1.0 + exp2(-2.4550345 * x)); // 9.5e-3
    }
    if (PHI_FORM == PHI_CUBIC) {
        return 1.0 / (1.0 + exp2(-x * (2.3048539 + s * 0.1018025))); // 1.4e-4
    }
    return 1.0 / (1.0 + exp2(-x * (2.3017272 + s * (0.10617733 - 9.1122696e-4 * s))));
}

#include "orthant.glsl"

// A union is the rest of the complements' intersection, which is why every plane is negated under OP_OR.
float complement_sign() {
    return CLIP_OP == OP_OR ? -1.0 : 1.0;
}

float combined(float share) {
    return CLIP_OP == OP_OR ? 1.0 - share : share;
}

vec2 principal_point() {
    return vec2(uintBitsToFloat(push.param[4]), uintBitsToFloat(push.param[5]));
}

Sight line_of_sight(uint base, vec2 delta, vec2 place) {
    vec2 pixel = place - principal_point();
    return sight_through(cuts.at[base], cuts.at[base + 1u], cuts.at[base + 2u], pixel, delta);
}

// Phi with a relative error of 2e-5 in its lower tail, for shares that are divided by the part in front of the eye.
float tail_phi(float z) {
    float x = min(abs(z), 8.0);
    float t = 1.0 / (1.0 + 0.37 * x);
    float series = t * (0.14672541 + t * (0.15906193 + t * (0.0711053 + t * (0.21612205 - 0.09302393 * t))));
    float tail = exp(-0.5 * x * x) * series;
    return z < 0.0 ? tail : 1.0 - tail;
}

// A record's plane; under OP_OR its complement.
vec4 plane_of(uint base, uint plane) {
    return complement_sign() * cuts.at[base + CUT_HEADER + plane];
}

Threshold threshold_of(Sight s, float det, uint base, uint plane) {
    vec4 form = plane_of(base, plane);
    Threshold t;
    t.z = ray_z(s, det, form, t.far);
    t.direction = direction(s, form.xyz);
    return t;
}

// The strictest plane besides two; `count` where there is none of the kind asked for.
const uint KIND_NEAR = 0u;
const uint KIND_FAR = 1u;
const uint KIND_ANY = 2u;

uint strictest(Sight s, float det, uint base, uint count, uvec2 besides, uint kind) {
    uint found = count;
    float least = PHI_ONE;
    for (uint plane = 0u; plane < count; plane++) {
        bool far;
        float z = ray_z(s, det, plane_of(base, plane), far);
        bool is_asked = kind == KIND_ANY || (kind == KIND_FAR) == far;
        if (z < least && is_asked && plane != besides.x && plane != besides.y) {
            least = z;
            found = plane;
        }
    }
    return found;
}

// What three and more planes keep that one pixel sees the edges of. No arrays: they would cost every splat their room.
float corner_weight(Sight s, float det, uint base, uint count) {
    uint a = strictest(s, det, base, count, uvec2(count), KIND_ANY);
    Threshold first = threshold_of(s, det, base, a);
    uint b = strictest(s, det, base, count, uvec2(a), first.far ? KIND_NEAR : KIND_FAR);
    bool is_mixed = b < count;
    b = is_mixed ? b : strictest(s, det, base, count, uvec2(a), KIND_ANY);
    Threshold second = threshold_of(s, det, base, b);
    uint c = strictest(s, det, base, count, uvec2(a, b), KIND_ANY);
    float share = three_positive(first, second, threshold_of(s, det, base, c));
    // Bounds from pairs: the least of them, and what is left when each plane takes what the strictest one of its kind, and
    // this what the strictest of all, has not taken. Where correlations are full both are the share.
    float p = phi(first.z);
    float q = phi(second.z);
    float high = both_positive(first, second);
    float low = high;
    for (uint plane = 0u; plane < count; plane++) {
        Threshold t = threshold_of(s, det, base, plane);
        if (plane == a || plane == b || t.z >= PHI_ONE) {
            continue;
        }
        float with_first = both_positive(first, t);
        float with_second = both_positive(second, t);
        high = min(high, min(with_first, with_second));
        low += is_mixed && t.far == second.far ? with_second - q : with_first - p;
        // Beyond three planes: as if each depended on the strictest only.
        share *= plane == c ? 1.0 : with_first / max(p, 1e-6);
    }
    return clamp(share, max(low, 0.0), max(high, 0.0));
}

// What several planes of a record keep together. Few pixels of a splat see the edges of more than one of them.
float several_weight(Sight s, float det, uint base, uint count) {
    uvec2 open = uvec2(0u);
    vec2 z = vec2(0.0);
    uint opens = 0u;
    for (uint plane = 0u; plane < count; plane++) {
        bool far;
        float here = ray_z(s, det, plane_of(base, plane), far);
        if (here <= -PHI_ONE) {
            return 0.0;
        }
        if (here < PHI_ONE) {
            open = uvec2(open.y, plane);
            z = vec2(z.y, here);
            opens++;
        }
    }
    if (opens < 2u) {
        return opens == 0u ? 1.0 : phi(z.y);
    }
    if (opens > 2u) {
        return corner_weight(s, det, base, count);
    }
    vec2 rho = correlation(direction(s, plane_of(base, open.x).xyz), direction(s, plane_of(base, open.y).xyz));
    return both_positive(z.x, z.y, phi(z.x), phi(z.y), rho);
}

// `exact`, with the planes of a record.
float exact_weight(uint base, uint count, vec2 delta, vec2 place) {
    Sight s = line_of_sight(base, delta, place);
    float det = determinant(s);
    if (CLIP_OP == OP_ONE || count == 1u) {
        bool far;
        return phi(ray_z(s, det, cuts.at[base + CUT_HEADER], far));
    }
    return combined(several_weight(s, det, base, count));
}

// The same with the camera inside the splat: only what is in front of the eye counts, as part and as whole. Such a splat
// is so large that the low-pass is nothing: the planes are thresholds in one variable along the ray, those that keep the
// far side bound it from below, as the eye does, the others from above.
float front_weight(uint base, uint count, vec2 delta, vec2 place) {
    Sight s = line_of_sight(base, delta, place);
    float det = determinant(s);
    float far = 1.0;
    float gone = 0.0;
    bool keeps;
    for (uint plane = 0u; plane < count; plane++) {
        float z = ray_z(s, det, plane_of(base, plane), keeps);
        if (keeps) {
            far = min(far, tail_phi(z));
        } else {
            gone = max(gone, tail_phi(-z));
        }
    }
    float whole = tail_phi(ray_z(s, det, cuts.at[base + CUT_HEADER + count], keeps));
    if (whole < FRONT_MIN) {
        return combined(max(0.0, far - gone));
    }
    return combined(max(0.0, min(far, whole) - gone) / whole);
}

// `rara`: the visible share of the chord that the ray cuts out of the ellipsoid (paper section 3.3 and eq. 11). The
// line is p + t c/|c| with p its point nearest the centre; |p|^2 = |delta.x b2 - delta.y b1|^2 / |c|^2 needs no
// inverse of M and no B^2 - 4 A C.
float chord_weight(uint base, uint count, bool has_front, vec2 delta, vec2 place) {
    Sight s = line_of_sight(base, delta, place);
    float cc = dot(s.c, s.c);
    float sigma = uintBitsToFloat(push.param[2]);
    bool degenerate = !(cc > 0.0);
    float inverse = degenerate ? 0.0 : 1.0 / cc;
    vec3 nearest = (s.delta.x * cross(s.b2, s.c) + s.delta.y * cross(s.c, s.b1)) * inverse;
    vec3 direction = s.c * sqrt(inverse);
    vec3 offset = s.delta.x * s.b2 - s.delta.y * s.b1;
    float half_square = degenerate ? -1.0 : sigma * sigma - dot(offset, offset) * inverse;
    float high = half_square > 0.0 ? sqrt(half_square) : 0.0;
    float low = -high;
    if (has_front) {
        vec4 front = cuts.at[base + CUT_HEADER + count];
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
        vec4 form = plane_of(base, plane);
        float value = form.w + dot(form.xyz, nearest);
        float slope = dot(form.xyz, direction);
        if (miss || slope == 0.0) {
            // The plane itself is visible, so it is no part of a complement.
            inside = inside && (value > 0.0 || (value == 0.0 && CLIP_OP != OP_OR));
        } else if (slope > 0.0) {
            low = max(low, -value / slope);
        } else {
            high = min(high, -value / slope);
        }
    }
    float share = !inside ? 0.0 : miss ? 1.0 : max(0.0, high - low) / whole;
    return combined(share);
}

// Which of them by the frame's mode and the record's form. `place` is the pixel's, `delta` the same relative to the
// splat's centre, `uv` that in the splat's own coordinates (curve.glsl). Parameter 2 is the traced ellipsoid's sigma, 3 the
// records' stride, 4 and 5 the principal point in the coordinates of `place`.
float cut_weight(uint cut, vec2 delta, vec2 uv, vec2 place) {
    uint base = cut * push.param[3];
    uint flags = uint(cuts.at[base].w);
    uint count = flags >> CUT_COUNT_SHIFT;
    if (CLIP_MODE == MODE_RARA) {
        return chord_weight(base, count, (flags & CUT_FRONT) != 0u, delta, place);
    }
    if ((flags & CUT_FRONT) != 0u) {
        return front_weight(base, count, delta, place);
    }
    if ((flags & CUT_CURVE) != 0u) {
        vec4 linear = cuts.at[base];
        vec4 bend = cuts.at[base + 1u];
        vec4 twist = cuts.at[base + 2u];
        vec4 wave = cuts.at[base + CUT_HEADER];
        float at = linear.x + uv.x * (linear.y + uv.x * (bend.x + uv.x * (twist.x + uv.x * wave.x)));
        float slope = linear.z + uv.x * (bend.y + uv.x * (twist.y + uv.x * wave.y));
        float second = bend.z + uv.x * (twist.z + uv.x * wave.z);
        float third = twist.w + uv.x * wave.w;
        return phi(at + uv.y * (slope + uv.y * (second + uv.y * (third + uv.y * bend.w))));
    }
    return exact_weight(base, count, delta, place);
}

// The paper scales alpha (eq. 12). The default for `exact` scales optical depth, -ln(1 - alpha): then complementary
// halves rebuild the whole. A weight of one leaves alpha untouched to the bit.
float decayed(float alpha, float weight) {
    if (weight >= 1.0) {
        return alpha;
    }
    return DECAY == DECAY_LINEAR ? alpha * weight : 1.0 - exp2(weight * log2(1.0 - alpha));
}

#endif
