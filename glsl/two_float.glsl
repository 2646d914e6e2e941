// Two-float arithmetic: a value as the unevaluated sum of two floats, about 48 bits. `precise` forbids the compiler to
// contract or reassociate, on which every line below rests. It uses Knuth's two-sum and Dekker's product with
// Veltkamp's split, but no fma, whose single rounding Vulkan does not promise.
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

// start + (high + low) . x in two floats.
vec2 two_float_dot(vec2 start, vec3 high, vec3 low, vec3 x) {
    vec2 sum = start;
    for (int i = 0; i < 3; i++) {
        vec2 term = two_product(high[i], x[i]);
        precise float correction = term.y + low[i] * x[i];
        sum = two_add(sum, vec2(term.x, correction));
    }
    return sum;
}

// (high + low) . x + the fourth component, rounded once: a plane's signed distance, right at coordinates of 1e6,
// where plain single precision is off by 0.3. Coordinates that Veltkamp's split would take beyond the range (no scene
// has them, but a file can) are scaled down before and up again after, which loses nothing of the offset.
float two_float_plane(vec4 high, vec4 low, vec3 x) {
    float unit = max(abs(x.x), max(abs(x.y), abs(x.z))) > 1e30 ? exp2(-40.0) : 1.0;
    vec2 sum = two_float_dot(unit * vec2(high.w, low.w), high.xyz, low.xyz, unit * x);
    return (sum.x + sum.y) / unit;
}

// a - (high + low) with one rounding of the result's own size: camera-relative positions far from the origin.
vec3 two_float_difference(vec3 a, vec3 high, vec3 low) {
    precise vec3 coarse = a - high;
    precise vec3 fine = coarse - low;
    return fine;
}

// The rotation's rows (high + low) times a - (eye_high + eye_low), rounded once: at a distance of 1e4 and a focal length
// of 2e6 px single precision alone would put the picture's pixels a fifth of a pixel off.
float two_float_view(vec3 row_high, vec3 row_low, vec3 a, vec3 eye_high, vec3 eye_low) {
    vec3 high;
    vec3 low;
    for (int i = 0; i < 3; i++) {
        vec2 difference = two_add(two_sum(a[i], -eye_high[i]), vec2(-eye_low[i], 0.0));
        high[i] = difference.x;
        low[i] = difference.y;
    }
    precise float small = row_high.x * low.x + row_high.y * low.y + row_high.z * low.z;
    vec2 sum = two_float_dot(vec2(0.0), row_high, row_low, high);
    precise float rounded = sum.x + (sum.y + small);
    return rounded;
}

#endif
