// A surface's terms (crossing.glsl) as polynomials in a splat's own coordinates, and how they are stored.
#ifndef RARA_REGION_TERM_CURVES
#define RARA_REGION_TERM_CURVES
#include "cut.glsl"
#include "polynomial.glsl"

// The polynomials are of degrees four, three and two.
struct TermCurves {
    Curve value, variance, bend;
};

TermCurves terms_of(vec4 at[TERMS_VECTORS]) {
    TermCurves t;
    t.value = curve_of(at[0], at[1], at[2], at[3]);
    t.variance = Curve(at[4].x, at[4].yz, at[5].xyz, at[6], vec4(0.0), 0.0);
    t.bend = Curve(at[4].w, vec2(at[5].w, at[7].x), at[7].yzw, vec4(0.0), vec4(0.0), 0.0);
    return t;
}

#endif
