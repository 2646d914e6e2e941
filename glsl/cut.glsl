// The cutoff record: what the fragment stage needs to weight a cut splat, computed once a splat by cutoff.comp.
// vec4s of a record (EYE.weight.cut_stride of them, or a multiple of that):
//   0      fx / Z m1, the screen gradient along x for a pixel on the principal axis, times scale; the sum of
//          CUT_BEAM, CUT_FRONT, CUT_UNION and 256 times the number of planes
//   1      fy / Z m2, the same along y, times scale; scale
//   2      the lean m3 / Z, how the gradients change with the pixel, times scale; low-pass times scale^2. In an
//          orthographic view 0 and 1 are fx m1 and fy m2, and there is no lean
//   3...   a plane each: normal in unit space, and the centre's distance, both divided by the normal's largest component
//   last   with CUT_FRONT: the plane through the eye across the view axis, in the same form
// Several planes in the affine form are such a record with the footprint's gradients and no lean. Without CUT_BEAM there is
// one plane, which the rasteriser carries: 3 holds z at the centre, dz/dx and dz/dy, 4 its curvature, the factors of dx^2,
// dx dy and dy^2. With CUT_COMBINED each surface has ENTRY_VECTORS vec4s: normal and distance; the bend's xx, yy, zz and the
// operators of SurfaceData; xy, xz, yz. With CUT_FACES a mesh has several such entries. With CUT_CURVE, in the coordinates of curve.glsl, 0 holds z at the centre and its slopes, 1 the factors
// of u^2, u v, v^2 and v^4, 2 those of u^3, u^2 v, u v^2 and v^3, 3 those of u^4, u^3 v, u^2 v^2 and u v^3. With CUT_TERMS
// these are of the value of a surface's terms (region/crossing.glsl) instead; 4 holds their variance at the centre and its slopes,
// 5 its factors of u^2, u v and v^2, 6 those of u^3, u^2 v, u v^2 and v^3; 4 and 5 end with the bend at the centre and its slope
// along u, and 7 holds that along v, and its factors of u^2, u v and v^2.
#ifndef RARA_CUT
#define RARA_CUT
#include "limits.glsl"

const uint CUT_HEADER = 3u;
// The planes are evaluated on each pixel's line of sight.
const uint CUT_BEAM = 1u;
// The splat reaches behind the eye.
const uint CUT_FRONT = 2u;
// The record is one plane's z as a polynomial of degree four.
const uint CUT_CURVE = 4u;
// The record is what one surface's crossing follows from, as polynomials.
const uint CUT_TERMS = 32u;
// The splat is cut by a union: the record holds the planes' complements, and what it keeps is the rest of what these keep
// together. A plane alone is a union only where it is weighed as several are: in mode `rara`, and with CUT_FRONT.
const uint CUT_UNION = 8u;
// The surfaces may bend, and combine by their operators.
const uint CUT_COMBINED = 16u;
// The record's last vec4 is an OpenStrip.
const uint CUT_STRIP = 64u;
// More surfaces cut the splat than the record has room for: its last vec4's x names a long record as z does, which holds them all. It
// lies behind those of all Gaussians and takes several of their places.
const uint CUT_LONG = 128u;
// The record is combined and has the faces of a mesh (region/faces.glsl).
const uint CUT_FACES = CUT_COMBINED | CUT_UNION;
const uint CUT_COUNT_SHIFT = 8u;
// The most surfaces of a long record, whose number is exact as a float.
const uint LONG_SURFACES = 0xffffu;
// How deep a stack of a record's answers may be: see answers.glsl.
const uint LONG_DEPTH = 8u;

// The rasteriser carries z at a splat's centre, dz/dx, dz/dy and the curvature, so that the usual case, one plane, needs
// no record in the fragment stage. Beyond Z_RANGE, z says that the splat is whole; below -Z_RANGE its bits are Z_RECORD
// plus the number of the splat's record, and slopes and curvature hold an OpenStrip.
const float Z_RANGE = 1e30;
const float Z_WHOLE = 2e30;
const uint Z_RECORD = 0xff800000u - MAX_RECORDS; // up to minus infinity
// In a reclipped frame the splats are all that is in view; this z says that a splat is clipped away.
const float Z_CUT_AWAY = 4e30;

// True when a plane keeps the far part of a line of sight, by its normal's component along the line. Where that is zero
// (a Gaussian without thickness) any fixed rule would do, if it distinguished opposed planes: the normal's first
// non-zero component does.
bool keeps_far(float along, vec3 normal) {
    float first = along != 0.0 ? along : normal.x != 0.0 ? normal.x : normal.y != 0.0 ? normal.y : normal.z;
    return first >= 0.0;
}

// Converts a number from 0 to below 2^31. CPU drivers convert to signed integers a vector at a time, to unsigned ones each
// by itself.
uint to_uint(float number) {
    return uint(int(number));
}

// The number of the record that a carried z names.
uint record_number(float z) {
    return floatBitsToUint(z) - Z_RECORD;
}

// The strip of the picture in which the weight of a splat with a record is open: with d from the splat's centre, px, nothing is left
// of the splat where away + slope . d is negative, and all where whole + slope . d is positive.
struct OpenStrip {
    vec2 slope;
    float away, whole;
};

// The strip as slopes and curvature hold it.
OpenStrip open_strip_of(vec3 linear, vec3 curvature) {
    return OpenStrip(linear.yz, curvature.x, curvature.y);
}

#endif
