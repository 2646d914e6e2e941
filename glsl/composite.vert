#version 460
#extension GL_GOOGLE_include_directive : require
// The quads of the tiles' picture.
#include "filled_quads.glsl"
