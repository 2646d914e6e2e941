#version 460
#extension GL_GOOGLE_include_directive : require
// The tile rasteriser, on any device: every invocation loads every splat of its tile.
#include "tiles.glsl"
