// The paper's three classes (section 3.2) for one Gaussian and every plane, by its tight support along the normal:
// |n.mu + d| against K |M^T n| with K where alpha falls to 1/255, instead of 3 max(sigma). Outside that band no pixel
// of the splat changes by more than 0.5/255; where weights follow true rays, perspective widens it.
#ifndef RARA_SIDE
#define RARA_SIDE
#include "footprint.glsl"

const uint SIDE_CULLED = 0u;
const uint SIDE_INVISIBLE = 1u;
const uint SIDE_VISIBLE = 2u;
const uint SIDE_CUTOFF = 3u;

// Signed distance of the centre to a plane, world units, positive on the visible side.
float plane_distance(uint plane, vec3 position) {
    return two_float_plane(FRAME.region.plane_high[plane], FRAME.region.plane_low[plane], position);
}

// The normal in the Gaussian's unit space; its length is the standard deviation along the normal.
vec3 unit_normal(uint plane, mat3 world_factor) {
    return FRAME.region.plane_high[plane].xyz * world_factor;
}

// Whether the exact form of a splat follows each pixel's true ray.
bool is_beam(Footprint f, float sigma) {
    return FRAME.weight.form == FORM_BEAM
        || (FRAME.weight.form == FORM_AUTO && (f.clamped || sigma > FRAME.weight.beam_switch * f.view.z));
}

// How far the band of a splat reaches whose weight follows each pixel's true ray: a pixel at delta sees the point u with
// B u = delta in the footprint, and on its ray u / (1 - e.u), with e = m3 / Z. Where the slope was clamped, the root of the
// trace of one covariance by the other's inverse bounds how far apart the two footprints are. Around the eye that has no
// bound, but all rays pass through the eye, and beyond it by BEYOND_EYE deviations nothing counts.
float beam_band(Footprint f, float extent) {
    float stretch = 1.0;
    if (f.clamped) {
        vec3 b1;
        vec3 b2;
        screen_gradients(f, f.view.xy / f.view.z, b1, b2);
        b1 *= f.scale;
        b2 *= f.scale;
        vec3 across = cross(b1, b2);
        float n1 = dot(b1, b1);
        float n2 = dot(b2, b2);
        float det = dot(across, across) + f.low_pass * (n1 + n2) + f.low_pass * f.low_pass;
        // A sum of squares, where xx yy' - 2 xy xy' + yy xx' would cancel for needles.
        float trace = dot(f.b1, f.b1) + dot(f.b2, f.b2) + n1 + n2 + 2.0 * f.low_pass;
        trace *= f.low_pass;
        for (uint i = 0u; i < 3u; i++) {
            vec3 apart = f.b1[i] * b2 - f.b2[i] * b1;
            trace += dot(apart, apart);
        }
        trace /= det;
        stretch = max(1.0, sqrt(trace));
    }
    float rest = 1.0 - extent * stretch * length(f.m3) / f.view.z;
    if (rest > WIDENING_REST) {
        return extent * stretch / rest;
    }
    mat3 m = f.world_factor;
    vec3 eye = f.relative * m / vec3(dot(m[0], m[0]), dot(m[1], m[1]), dot(m[2], m[2]));
    // What is no number bounds nothing: every plane then cuts.
    return length(eye) + BEYOND_EYE;
}

// How far the band reaches, in standard deviations. rara also traces its own ellipsoid.
float band(float extent) {
    return FRAME.region.mode == MODE_RARA ? max(extent, FRAME.region.sigma) : extent;
}

// One plane: SIDE_VISIBLE where it keeps the whole splat, SIDE_INVISIBLE where it keeps nothing, else SIDE_CUTOFF.
uint plane_side(float distance, vec3 normal, float reach) {
    if (FRAME.region.mode == MODE_HARD) {
        return distance >= 0.0 ? SIDE_VISIBLE : SIDE_INVISIBLE;
    }
    float support = reach * length(normal);
    if (FRAME.region.trace_all != 0u) {
        return SIDE_CUTOFF;
    }
    return distance >= support ? SIDE_VISIBLE : distance <= -support ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

// The same with what perspective adds to it.
float band_in_view(Footprint f, float sigma, float extent) {
    return FRAME.region.mode == MODE_EXACT && is_beam(f, sigma) ? beam_band(f, extent) : band(extent);
}

// All planes together.
uint clip_side(mat3 world_factor, vec3 position, float reach) {
    uint decided = FRAME.region.op == OP_AND ? SIDE_INVISIBLE : SIDE_VISIBLE;
    uint side = FRAME.region.op == OP_AND ? SIDE_VISIBLE : SIDE_INVISIBLE;
    for (uint plane = 0u; plane < FRAME.region.plane_count; plane++) {
        uint one = plane_side(plane_distance(plane, position), unit_normal(plane, world_factor), reach);
        if (one == decided) {
            return decided;
        }
        side = one == SIDE_CUTOFF ? SIDE_CUTOFF : side;
    }
    return side;
}

#endif
