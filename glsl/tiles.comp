#version 460
#extension GL_GOOGLE_include_directive : require
// The tile rasteriser, on any device: a workgroup loads a batch of splats at once into shared memory.
#include "tiles.glsl"
