#version 460
// A host's own shader, which bends a scene: it reads Gaussians and writes them, bent, into an editor's buffer at param[0..2].
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
// rara's PlainGaussian.
struct PlainGaussian { vec4 position_opacity; vec4 scale; vec4 rotation; vec4 colour; };
layout(push_constant, std430) uniform Push { uvec2 address[10]; uint param[12]; } push;
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Source { PlainGaussian at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Target { PlainGaussian at[]; };
void main() {
    uint i = gl_WorkGroupID.x * 64u + gl_LocalInvocationID.x;
    if (i >= push.param[2]) return;
    Source source = Source(push.address[0]);
    Target target = Target(uvec2(push.param[0], push.param[1]));
    float amount = uintBitsToFloat(push.param[3]);
    vec4 p = source.at[i].position_opacity;
    vec4 q = source.at[i].rotation;
    precise float bent = p.x + amount * (p.y * p.y);
    // A quarter of a turn about z.
    const float h = 0.70710677;
    precise vec4 turned = h * vec4(q.x + q.y, q.y - q.x, q.z + q.w, q.w - q.z);
    target.at[i].position_opacity = vec4(bent, p.yzw);
    target.at[i].rotation = turned;
}
