// The buffer `splat_gaussians` holds the Gaussian of each splat, and, where the clip cuts any, behind room for as many as there are
// Gaussians the numbers of those that are cut, among the cut ones.
#ifndef RARA_SPLAT_GAUSSIANS
#define RARA_SPLAT_GAUSSIANS
#include "frame.glsl"

uint cut_place(uint splat_index) {
    return CUT.scene.gaussian_count + splat_index;
}

// The buffer `depth_keys` holds the key of each splat, and behind room for as many as there are Gaussians its number in the scene:
// Gaussians are so far apart that splats of one depth would wait for theirs.
uint number_place(uint splat_index) {
    return CUT.scene.gaussian_count + splat_index;
}

#endif
