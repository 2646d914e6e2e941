#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
// The third step of a pass of the sort for GPUs, where subgroups are whole and have 8 invocations or more.
#define RARA_SUBGROUP
#include "radix_scatter.glsl"
