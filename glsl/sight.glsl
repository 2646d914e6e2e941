// The line of sight of a pixel through a cut splat, and where planes stand on it, from which the perspective-exact weight
// follows. The fragment stage uses it, and cutoff.comp fits a cheaper form to it.
#ifndef RARA_SIGHT
#define RARA_SIGHT
#include "cut.glsl"

// The line of sight of a pixel in the Gaussian's unit space: the points u with b1.u = delta.x and b2.u = delta.y.
// A pixel is two planes through the eye; dividing them by Z gives the gradients fx/Z m1 - X e and fy/Z m2 - Y e, with the
// lean e = m3 / Z and the pixel's position X, Y relative to the principal point. (The centre's gradients less delta e are
// the same, but for centres far beside the picture they are the difference of two large slopes.)
struct Sight {
    vec3 b1, b2, c;
    vec2 delta;
    float low_pass;
};

// Makes a sight from a cutoff record's header. `pixel` is relative to the principal point, `delta` to the splat's centre.
Sight sight_through(vec4 h0, vec4 h1, vec4 h2, vec2 pixel, vec2 delta) {
    Sight sight;
    sight.b1 = h0.xyz - pixel.x * h2.xyz;
    sight.b2 = h1.xyz - pixel.y * h2.xyz;
    sight.c = cross(sight.b1, sight.b2);
    sight.delta = delta * h1.w;
    sight.low_pass = h2.w;
    return sight;
}

float determinant(Sight s) {
    return dot(s.c, s.c) + s.low_pass * (dot(s.b1, s.b1) + dot(s.b2, s.b2)) + s.low_pass * s.low_pass;
}

// A plane's z in mode `exact`, perspective included: the same update as in the affine form, with this pixel's own gradients.
float beam_z(Sight s, float det, vec4 half_space, out bool far) {
    vec3 a = half_space.xyz;
    vec3 a1 = cross(a, s.b1);
    vec3 a2 = cross(a, s.b2);
    float along = dot(a, s.c);
    far = keeps_far(along, a);
    float variance = along * along + s.low_pass * (dot(a1, a1) + dot(a2, a2))
        + s.low_pass * s.low_pass * dot(a, a);
    vec2 k = vec2(dot(s.c, a2) + s.low_pass * dot(a, s.b1), -dot(s.c, a1) + s.low_pass * dot(a, s.b2));
    float mean = half_space.w + dot(k, s.delta) / det;
    return mean * inversesqrt(max(variance / det, 1e-30));
}

#endif
