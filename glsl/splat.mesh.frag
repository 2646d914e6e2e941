#version 460
#extension GL_GOOGLE_include_directive : require
// The fragment shader behind splat.mesh: what is one for a splat is an attribute of its triangles, not of their corners.
#extension GL_EXT_mesh_shader : require
#define ONE_A_SPLAT perprimitiveEXT
#include "splat_fragment.glsl"
