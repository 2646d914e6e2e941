// What orders the survivors. The buffer `depth_keys` holds the keys of their depths, and behind room for as many as there are
// Gaussians their numbers in the scene, by which those of one key are ordered.
#ifndef RARA_DEPTH_KEYS
#define RARA_DEPTH_KEYS
#include "frame.glsl"

uint number_place(uint survivor) {
    return FRAME.scene.gaussian_count + survivor;
}

#endif
