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

// Half-spaces on one line of sight are thresholds in one variable: those that keep the far side bound it from below,
// the others from above. An intersection is what both leave; a union is the rest of the complements' intersection,
// which is why every plane is negated (`sign`) under OP_OR.
float complement_sign() {
    return CLIP_OP == OP_OR ? -1.0 : 1.0;
}

float combined(float share) {
    return CLIP_OP == OP_OR ? 1.0 - share : share;
}

// `exact`, affine in the pixel.
float affine_weight(uint at, uint count, vec2 delta) {
    float sign = complement_sign();
    float far = 1.0;
    float near = 1.0;
    for (uint plane = 0u; plane < count; plane++) {
        vec4 form = cuts.at[at + plane];
        float kept = phi(sign * (form.x + form.y * delta.x + form.z * delta.y));
        if (sign * form.w > 0.0) {
            far = min(far, kept);
        } else {
            near = min(near, kept);
        }
    }
    // Not far + near - 1: where no near plane cuts, the share must stay as it is, to the bit.
    return combined(max(0.0, far - (1.0 - near)));
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

float beam_weight(uint base, uint count, bool has_front, vec2 delta, vec2 place) {
    Sight s = line_of_sight(base, delta, place);
    float det = determinant(s);
    float sign = complement_sign();
    // What the far thresholds leave, and what the near ones take of it.
    float far = 1.0;
    float gone = 0.0;
    bool keeps;
    for (uint plane = 0u; plane < count; plane++) {
        float z = sign * ray_z(s, det, cuts.at[base + CUT_HEADER + plane], keeps);
        if (keeps == (CLIP_OP == OP_AND)) {
            far = min(far, has_front ? tail_phi(z) : phi(z));
        } else {
            gone = max(gone, has_front ? tail_phi(-z) : phi(-z));
        }
    }
    float whole = 1.0;
    if (has_front) {
        // The camera is inside: only the part in front of the eye counts, as part and as whole.
        float front = tail_phi(ray_z(s, det, cuts.at[base + CUT_HEADER + count], keeps));
        if (front >= FRONT_MIN) {
            whole = front;
            far = min(far, front);
        }
    }
    return combined(max(0.0, far - gone) / whole);
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
    float sign = complement_sign();
    bool inside = true;
    for (uint plane = 0u; plane < count; plane++) {
        vec4 form = sign * cuts.at[base + CUT_HEADER + plane];
        float value = form.w + dot(form.xyz, nearest);
        float slope = dot(form.xyz, direction);
        if (miss || slope == 0.0) {
            // The plane itself is visible, so it is no part of a complement.
            inside = inside && (value > 0.0 || (value == 0.0 && CLIP_OP == OP_AND));
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
// splat's centre, `uv` that in the splat's own coordinates (curve.glsl). Parameter 2 is the traced ellipsoid's sigma, 3 the records' stride, 4 and 5 the principal point in the
// coordinates of `place`.
float cut_weight(uint cut, vec2 delta, vec2 uv, vec2 place) {
    uint base = cut * push.param[3];
    uint flags = uint(cuts.at[base].w);
    uint count = flags >> CUT_COUNT_SHIFT;
    if (CLIP_MODE == MODE_RARA) {
        return chord_weight(base, count, (flags & CUT_FRONT) != 0u, delta, place);
    }
    if ((flags & CUT_RAY) != 0u) {
        return beam_weight(base, count, (flags & CUT_FRONT) != 0u, delta, place);
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
    return affine_weight(base + CUT_HEADER, count, delta);
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
