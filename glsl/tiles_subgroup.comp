#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// The tile rasteriser where workgroups are whole subgroups: an invocation loads one splat for all of them. CPU drivers
// load for each invocation by itself, so that of a splat which all look at one load in eight is left, and the eight do
// not wait for memory one after the other.
#define RARA_SUBGROUP
#include "tiles.glsl"
