// Two-float arithmetic: a value as the unevaluated sum of two floats, about 48 bits. `precise` forbids the compiler to
// contract or reassociate, on which every line below rests. Knuth's two-sum, Dekker's product with Veltkamp's split:
// no fma, whose single rounding Vulkan does not promise.
#ifndef RARA_TWO_FLOAT
#define RARA_TWO_FLOAT

vec2 two_sum(float a, float b) {
    precise float sum = a + b;
    precise float b_round = sum - a;
    precise float error = (a - (sum - b_round)) + (b - b_round);
    return vec2(sum, error);
}

vec2 split(float a) {
    precise float t = 4097.0 * a;
    precise float high = t - (t - a);
    precise float low = a - high;
    return vec2(high, low);
}

vec2 two_product(float a, float b) {
    precise float product = a * b;
    vec2 sa = split(a);
    vec2 sb = split(b);
    precise float error = ((sa.x * sb.x - product) + sa.x * sb.y + sa.y * sb.x) + sa.y * sb.y;
    return vec2(product, error);
}

vec2 two_add(vec2 a, vec2 b) {
    vec2 s = two_sum(a.x, b.x);
    precise float low = s.y + (a.y + b.y);
    return two_sum(s.x, low);
}

// (high + low) . x + the fourth component, rounded once: a plane's signed distance, right at coordinates of 1e6,
// where plain single precision is off by 0.3.
float two_float_plane(vec4 high, vec4 low, vec3 x) {
    vec2 sum = vec2(high.w, low.w);
    for (int i = 0; i < 3; i++) {
        vec2 term = two_product(high[i], x[i]);
        precise float correction = term.y + low[i] * x[i];
        sum = two_add(sum, vec2(term.x, correction));
    }
    return sum.x + sum.y;
}

// a - (high + low) with one rounding of the result's own size: camera-relative positions far from the origin.
vec3 two_float_difference(vec3 a, vec3 high, vec3 low) {
    precise vec3 coarse = a - high;
    precise vec3 fine = coarse - low;
    return fine;
}

#endif
