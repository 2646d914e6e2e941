#version 460
// Corners from a buffer.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#ifdef ADDRESS
layout(push_constant, std430) uniform Push { uvec2 address[10]; uint param[12]; } push;
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Corners { float x[]; };
#define corners Corners(push.address[0])
#else
layout(push_constant, std430) uniform Push { uint param[12]; } push;
layout(set = 0, binding = 0, std430) readonly buffer Corners { float x[]; } corners;
#endif
void main() { gl_Position = vec4(corners.x[2 * gl_VertexIndex], corners.x[2 * gl_VertexIndex + 1], 0.0, 1.0); }
