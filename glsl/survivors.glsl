// What the buffer `survivors` holds: the Gaussian of each survivor, and, where the clip cuts any, behind room for as many as
// there are Gaussians the numbers of those that are cut, among the cut ones.
#ifndef RARA_SURVIVORS
#define RARA_SURVIVORS
#include "frame.glsl"

uint cut_place(uint survivor) {
    return FRAME.scene.gaussian_count + survivor;
}

#endif
