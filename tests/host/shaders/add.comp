#version 460
// target[i] = FACTOR * source[i] + param[1] for i below param[0].
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FACTOR = 1u;
#ifdef ADDRESS
layout(push_constant, std430) uniform Push { uvec2 address[10]; uint param[12]; } push;
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Source { uint x[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) writeonly buffer Target { uint x[]; };
#define source Source(push.address[0])
#define target Target(push.address[1])
#else
layout(push_constant, std430) uniform Push { uint param[12]; } push;
layout(set = 0, binding = 0, std430) readonly buffer Source { uint x[]; } source;
layout(set = 0, binding = 1, std430) writeonly buffer Target { uint x[]; } target;
#endif
void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (i < push.param[0]) target.x[i] = FACTOR * source.x[i] + push.param[1];
}
