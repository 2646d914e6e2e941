#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The quads of the tiles' picture, in a scope of several views.
#define RARA_MULTIVIEW
#include "filled_quads.glsl"
