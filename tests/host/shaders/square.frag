#version 460
// One colour from a buffer.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(location = 0) out vec4 colour;
#ifdef ADDRESS
layout(push_constant, std430) uniform Push { uvec2 address[10]; uint param[12]; } push;
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Colour { vec4 x[]; };
#define paint Colour(push.address[1])
#else
layout(push_constant, std430) uniform Push { uint param[12]; } push;
layout(set = 0, binding = 1, std430) readonly buffer Colour { vec4 x[]; } paint;
#endif
void main() { colour = paint.x[0]; }
