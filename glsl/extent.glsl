// How far a splat reaches.
#ifndef RARA_EXTENT
#define RARA_EXTENT
#include "limits.glsl"

// K, the contour at which alpha falls to 1/255, in standard deviations: opacity exp(-K^2/2) = 1/255.
float opacity_extent(float opacity) {
    return sqrt(max(0.0, 2.0 * log(opacity * ALPHA_MIN_INVERSE)));
}

float largest(vec3 v) {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// Nothing is drawn this many deviations behind the plane: a little more than where tiles take a weight for zero.
const float TRIM_DEVIATIONS = 4.55;

#endif
