#version 460
#extension GL_GOOGLE_include_directive : require
// The third step of a pass of the sort for GPUs, on any device.
#include "radix_scatter.glsl"
