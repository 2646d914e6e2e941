#version 460
#extension GL_GOOGLE_include_directive : require
// The fragment shader behind splat.vert.
#define ONE_A_SPLAT flat
#include "splat_fragment.glsl"
