// Computes what perspective adds to the band in which a surface cuts a Gaussian.
#ifndef RARA_BEAM
#define RARA_BEAM
#include "band.glsl"
#include "footprint.glsl"

// True when the exact form of a splat follows each pixel's true ray. `sigma` is its largest deviation, the layer's
// units. Where lines of sight are parallel the affine form is that already.
bool is_beam(Footprint f, float sigma) {
    bool is_large = f.clamped || LAYER_VIEW.unit * sigma > EYE.weight.beam_switch * f.view_centre.z;
    return !is_orthographic() && (EYE.weight.form == FORM_BEAM || (EYE.weight.form == FORM_AUTO && is_large));
}

// How far the band of a splat reaches whose weight follows each pixel's true ray. A pixel at delta sees the point u with
// B u = delta in the footprint, and on its ray u / (1 - e.u), with the lean e = m3 / Z. Where the slope was clamped, the
// root of the trace of one covariance by the other's inverse bounds how far apart the two footprints are. Around the eye that
// has no bound, but all rays pass through the eye, and nothing counts that lies BEYOND_EYE deviations beyond it.
float beam_band(Footprint f, float extent) {
    float stretch = 1.0;
    if (f.clamped) {
        vec3 b1;
        vec3 b2;
        screen_gradients(f, quotient(f.view_centre.xy, f.view_centre.z), b1, b2);
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
    float rest = 1.0 - extent * stretch * length(f.m3) / f.view_centre.z;
    if (rest > WIDENING_REST) {
        return extent * stretch / rest;
    }
    mat3 m = f.axes;
    vec3 eye = f.relative * m / vec3(dot(m[0], m[0]), dot(m[1], m[1]), dot(m[2], m[2]));
    // A distance that is no number bounds nothing: every plane then cuts.
    return length(eye) + BEYOND_EYE;
}

// The band of a Gaussian in view, in standard deviations.
float band_in_view(Footprint f, float sigma, float extent) {
    return CUT.region.mode == MODE_EXACT && is_beam(f, sigma) ? beam_band(f, extent) : band(extent);
}

// True when the eye's plane reaches into the splat, whose part behind it must not count.
bool holds_the_eye(Footprint f, float extent) {
    return !is_orthographic() && f.view_centre.z < band(extent) * length(f.m3);
}

#endif
