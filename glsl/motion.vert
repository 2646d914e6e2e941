#version 460
#extension GL_GOOGLE_include_directive : require
// The quads of the tiles' picture, whose pixels get motion.
#include "filled_quads.glsl"
