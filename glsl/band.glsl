// How far from a Gaussian's centre a surface cuts it, whatever eye sees it.
#ifndef RARA_BAND
#define RARA_BAND
#include "layer.glsl"

// How far the band reaches, in standard deviations. Mode `rara` also traces its own ellipsoid.
float band(float extent) {
    return CUT.region.mode == MODE_RARA ? max(extent, CUT.region.sigma) : extent;
}

#endif
