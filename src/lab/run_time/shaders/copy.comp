#version 460
#extension GL_GOOGLE_include_directive : require
// The cost of moving bytes: 16 of them an invocation, read once and written once.
#include "buffers.glsl"

layout(local_size_x = 64) in;

BUFFER(readonly, 0, vec4, source)
BUFFER(writeonly, 1, vec4, target)

void main() {
    uint i = LINEAR_GROUP * 64u + gl_LocalInvocationIndex;
    if (i < push.param[0]) {
        target.at[i] = source.at[i];
    }
}
