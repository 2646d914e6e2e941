#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// The tile rasteriser on CPU drivers, whose workgroups are whole subgroups run as masked vectors (passes/tiles.rs). Every
// invocation needs every splat of the tile, and these drivers load for each invocation by itself. Loading a different splat
// in each divides the loads by the subgroup's size, and lets them wait for memory together.
#define RARA_SUBGROUP
#include "tiles.glsl"
