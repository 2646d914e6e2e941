// A pixel's share of a splat: the chance that a point of the Gaussian on the pixel's line of sight is kept by all surfaces
// of the splat's cutoff record, or by any surface of a union. Included after the buffer `cut_records` is declared. Twin:
// src/reference/region/share.rs and src/reference/polytope.rs.
#ifndef RARA_REGION_SHARE
#define RARA_REGION_SHARE
#include "orthant.glsl"

// Chords of which a slice of a polytope is a sum, and Newton's steps to the first and the last of them.
const uint CHORDS = 16u;
const uint CHORD_STEPS = 12u;
// How far slices are apart, deviations, and how many there are on either side of the mean.
const float APART = 0.37;
const int SLICES = 11;
// Planes that turn away from the strictest one by less, as a sine, make no polytope with ends, but a bent plane.
const float NARROW = 0.5;
// A plane is along a chord where it changes by less along that than aside.
const float LEAST_ALONG = 1e-6;
const float PI = 3.14159265;

// The share that a record keeps, from the share that all of its surfaces keep together. A union's record holds the
// complements: the union keeps the rest of their intersection.
float combined(uint flags, float share) {
    return (flags & CUT_UNION) != 0u ? 1.0 - share : share;
}

// A plane of a record.
vec4 plane_of(uint base, uint plane) {
    return cut_records.at[base + CUT_HEADER + plane];
}

Threshold threshold_of(Sight s, float det, uint base, uint plane) {
    vec4 half_space = plane_of(base, plane);
    bool far;
    return Threshold(beam_z(s, det, half_space, far), direction(s, half_space.xyz));
}

// A chord of the polytope that planes bound: the points from low to high along a direction; none where high is below low.
struct Chord {
    float low, high;
    float opening; // by how much high - low changes where the chord moves
};

// The chord through `at` along `direction` that is moved by `u` times `aside`. Planes along it do not bound it.
Chord chord_of_planes(uint base, uint count, vec3 at, vec3 direction, vec3 aside, float u) {
    Chord chord = Chord(-8.0, 8.0, 0.0);
    vec2 slopes = vec2(0.0);
    for (uint plane = 0u; plane < count; plane++) {
        vec4 half_space = plane_of(base, plane);
        float along = dot(half_space.xyz, direction);
        float slope = -dot(half_space.xyz, aside);
        if (abs(along) > LEAST_ALONG * abs(slope)) {
            slope /= along;
            float end = u * slope - (half_space.w + dot(half_space.xyz, at)) / along;
            if (along > 0.0 && end > chord.low) {
                chord.low = end;
                slopes.x = slope;
            } else if (along < 0.0 && end < chord.high) {
                chord.high = end;
                slopes.y = slope;
            }
        }
    }
    chord.opening = slopes.y - slopes.x;
    return chord;
}

// Moves an end of a stretch of chords inwards to where there are chords, by Newton's method; false where there are none. The
// length of a chord is a concave function of its place, so that no step goes too far.
bool find_chords(uint base, uint count, vec3 at, vec3 direction, vec3 aside, float inwards, inout float u) {
    for (uint i = 0u; i < CHORD_STEPS; i++) {
        Chord chord = chord_of_planes(base, count, at, direction, aside, u);
        float missing = chord.low - chord.high;
        if (missing <= 0.0) {
            break;
        }
        if (!(chord.opening * inwards > 0.0)) {
            return false;
        }
        u += missing / chord.opening;
    }
    return true;
}

// A plane of a record by three normal variables of variance 1, whose deviations these are: its unit normal and its distance.
vec4 plane_in(mat3 deviations, vec3 mean, vec4 half_space) {
    vec3 a = half_space.xyz * deviations;
    return vec4(a, half_space.w + dot(half_space.xyz, mean)) * inversesqrt(max(dot(a, a), 1e-30));
}

// The share that planes keep where one pixel sees the edges of more than three: the chance that three normal variables are in a
// polytope. In the first one, across the strictest plane, the integral is a sum at Chebyshev's places between the polytope's
// ends, at which chords end like roots; in the second, across which planes turn away most, chords are exact; and the third, of
// which little depends, or nothing for a prism, is a sum of slices.
float polytope_weight(Sight s, uint base, uint count) {
    Line line = line_through(s);
    mat3 deviations = deviations_of(line);
    vec3 g = vec3(1.0, 0.0, 0.0);
    float least = PHI_ONE;
    for (uint plane = 0u; plane < count; plane++) {
        vec4 here = plane_in(deviations, line.mean, plane_of(base, plane));
        g = here.w < least ? here.xyz : g;
        least = min(least, here.w);
    }
    vec3 h = vec3(0.0);
    for (uint plane = 0u; plane < count; plane++) {
        vec4 here = plane_in(deviations, line.mean, plane_of(base, plane));
        vec3 aside = here.xyz - g * dot(here.xyz, g);
        h = here.w < PHI_ONE && dot(aside, aside) > dot(h, h) ? aside : h;
    }
    bool is_narrow = dot(h, h) < NARROW * NARROW;
    h = dot(h, h) > 1e-12 ? normalize(h) : perpendicular(g);
    // Planes that hardly turn away from the strictest one are crossed along its normal.
    vec3 normal = g;
    g = is_narrow ? h : g;
    h = is_narrow ? normal : h;
    vec3 k = cross(g, h);
    bool is_prism = true;
    for (uint plane = 0u; plane < count; plane++) {
        vec4 here = plane_in(deviations, line.mean, plane_of(base, plane));
        is_prism = is_prism && (here.w >= PHI_ONE || abs(dot(here.xyz, k)) <= 1e-3);
    }
    vec3 aside = deviations * g;
    vec3 direction = deviations * h;
    vec3 third = deviations * k;
    float share = 0.0;
    float weights = 0.0;
    int slices = is_prism ? 0 : SLICES;
    for (int slice = -slices; slice <= slices; slice++) {
        float t = APART * float(slice);
        vec3 at = line.mean + t * third;
        float weight = exp(-0.5 * t * t);
        weights += weight;
        float low = -PHI_ONE;
        float high = PHI_ONE;
        for (uint plane = 0u; plane < count; plane++) {
            vec4 half_space = plane_of(base, plane);
            float slope = dot(half_space.xyz, aside);
            if (abs(dot(half_space.xyz, direction)) <= LEAST_ALONG * abs(slope)) {
                float end = -(half_space.w + dot(half_space.xyz, at)) / slope;
                low = slope > 0.0 ? max(low, end) : low;
                high = slope < 0.0 ? min(high, end) : high;
            }
        }
        if (!find_chords(base, count, at, direction, aside, 1.0, low) || !find_chords(base, count, at, direction, aside, -1.0, high)) {
            continue;
        }
        float half_width = 0.5 * max(high - low, 0.0);
        float sum = 0.0;
        for (uint i = 0u; i < CHORDS; i++) {
            float angle = PI / float(CHORDS) * (float(i) + 0.5);
            float u = 0.5 * (low + high) - half_width * cos(angle);
            Chord chord = chord_of_planes(base, count, at, direction, aside, u);
            sum += sin(angle) * exp(-0.5 * u * u) * max(phi(chord.high) - phi(chord.low), 0.0);
        }
        share += weight * sum * half_width * PI / (float(CHORDS) * ROOT_TAU);
    }
    return min(share / weights, 1.0);
}

// The share that several planes of a record keep together. Few pixels of a splat see the edges of more than one of them.
float several_weight(Sight s, float det, uint base, uint count) {
    uvec3 open = uvec3(0u);
    float z;
    uint opens = 0u;
    for (uint plane = 0u; plane < count; plane++) {
        bool far;
        float here = beam_z(s, det, plane_of(base, plane), far);
        if (here <= -PHI_ONE) {
            return 0.0;
        }
        if (here < PHI_ONE) {
            z = here;
            open = uvec3(open.yz, plane);
            opens++;
        }
    }
    if (opens < 2u) {
        return opens == 0u ? 1.0 : phi(z);
    }
    if (opens > 3u) {
        return polytope_weight(s, base, count);
    }
    Threshold t = threshold_of(s, det, base, open.y);
    Threshold u = threshold_of(s, det, base, open.z);
    vec3 pairs;
    return opens == 2u ? both_positive(t, u) : three_positive(threshold_of(s, det, base, open.x), t, u, pairs);
}

#endif
