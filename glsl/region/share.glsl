// A pixel's share of a splat: the chance that a point of the Gaussian on the pixel's line of sight is kept by all surfaces
// of the splat's cutoff record, or by any surface of a union. Included after the buffer `cut_records` is declared. Twin:
// src/reference/region/share.rs.
#ifndef RARA_REGION_SHARE
#define RARA_REGION_SHARE
#include "orthant.glsl"

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
    Threshold t;
    t.z = beam_z(s, det, half_space, t.far);
    t.direction = direction(s, half_space.xyz);
    return t;
}

// The share that four or more planes keep whose edges one pixel sees. It is taken as if the pairs' dependences added up,
// between two bounds that follow from the pairs. The upper one is the least of the pairs' shares. The lower one is the share
// of the two kinds' strictest planes, less what each other plane takes of what the strictest of its kind leaves. There are
// no arrays: they would cost every splat their room.
float many_weight(Sight s, float det, uint base, uint count) {
    // The first is of the planes that keep the far side, the second of the others.
    uvec2 strictest = uvec2(count);
    vec2 least = vec2(PHI_ONE);
    float share = 1.0;
    float high = 1.0;
    for (uint plane = 0u; plane < count; plane++) {
        Threshold t = threshold_of(s, det, base, plane);
        if (t.z >= PHI_ONE) {
            continue;
        }
        uint kind = t.far ? 0u : 1u;
        if (t.z < least[kind]) {
            least[kind] = t.z;
            strictest[kind] = plane;
        }
        float p = max(phi(t.z), 1e-6);
        share *= p;
        for (uint other = 0u; other < plane; other++) {
            Threshold u = threshold_of(s, det, base, other);
            if (u.z < PHI_ONE) {
                float pair = both_positive(t, u);
                high = min(high, pair);
                share *= pair / (p * max(phi(u.z), 1e-6));
            }
        }
    }
    bool is_mixed = strictest.x < count && strictest.y < count;
    float low = is_mixed
        ? both_positive(threshold_of(s, det, base, strictest.x), threshold_of(s, det, base, strictest.y))
        : phi(min(least.x, least.y));
    for (uint plane = 0u; plane < count; plane++) {
        Threshold t = threshold_of(s, det, base, plane);
        uint first = t.far ? strictest.x : strictest.y;
        if (t.z < PHI_ONE && plane != first && first < count) {
            low += both_positive(threshold_of(s, det, base, first), t) - phi(t.far ? least.x : least.y);
        }
    }
    return min(max(share, max(low, 0.0)), high);
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
        return many_weight(s, det, base, count);
    }
    Threshold t = threshold_of(s, det, base, open.y);
    Threshold u = threshold_of(s, det, base, open.z);
    vec3 pairs;
    return opens == 2u ? both_positive(t, u) : three_positive(threshold_of(s, det, base, open.x), t, u, pairs);
}

#endif
