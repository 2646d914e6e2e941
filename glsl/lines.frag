#version 460
#extension GL_GOOGLE_include_directive : require
// A line with round ends, so that lines which meet leave no notch between them; its edge fades over a pixel.
#include "lines.glsl"

layout(location = 0) flat in uint number;
layout(location = 0) out vec4 colour;

void main() {
    vec4 ends = lines.at[2u * number];
    vec4 colour_radius = lines.at[2u * number + 1u];
    vec2 along = ends.zw - ends.xy;
    vec2 from = gl_FragCoord.xy - ends.xy;
    float squared = dot(along, along);
    float share = squared > 0.0 ? clamp(dot(from, along) / squared, 0.0, 1.0) : 0.0;
    float coverage = clamp(colour_radius.w + 0.5 - length(from - share * along), 0.0, 1.0);
    colour = coverage * vec4(colour_radius.rgb, 1.0);
}
