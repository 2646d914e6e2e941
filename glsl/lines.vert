#version 460
#extension GL_GOOGLE_include_directive : require
// Draws lines over a picture: one instance a line, a strip of four corners that hold all pixels near it.
#include "lines.glsl"

layout(location = 0) flat out uint number;

void main() {
    number = uint(gl_InstanceIndex);
    vec4 ends = lines.at[2u * number];
    // Pixels fade out over one pixel around half the width.
    float reach = lines.at[2u * number + 1u].w + 1.0;
    vec2 along = ends.zw - ends.xy;
    float size = length(along);
    along = size > 0.0 ? along * (reach / size) : vec2(reach, 0.0);
    vec2 across = vec2(-along.y, along.x);
    vec2 corner = gl_VertexIndex < 2 ? ends.xy - along : ends.zw + along;
    corner += (gl_VertexIndex & 1) == 0 ? across : -across;
    gl_Position = vec4(corner * push.params.pixel - 1.0, 0.0, 1.0);
}
