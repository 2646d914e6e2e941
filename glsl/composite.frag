#version 460
#extension GL_GOOGLE_include_directive : require
// Reads the tiles' picture, which is blended onto what the host has drawn: as it is, or where one of both is linear light and
// the other is not turned into the host's once, after the splats were blended. The expected depths that lie behind it are blended
// likewise.
#include "composite.glsl"

layout(constant_id = 0) const bool LINEAR = false; // what was blended as stored becomes linear light
layout(constant_id = 1) const bool STORED = false; // linear light becomes what is stored
layout(constant_id = 2) const bool DEPTHS = false; // draws expected depths: depth times alpha, and alpha

layout(location = 0) out vec4 colour;

// The linear light of colours as sRGB stores them; beyond white the curve goes on.
vec3 linear_light(vec3 stored) {
    stored = max(stored, 0.0);
    return mix(pow((stored + 0.055) / 1.055, vec3(2.4)), stored / 12.92, lessThanEqual(stored, vec3(0.04045)));
}

// The inverse.
vec3 stored_colour(vec3 light) {
    light = max(light, 0.0);
    return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, light * 12.92, lessThanEqual(light, vec3(0.0031308)));
}

void main() {
    uint at;
    colour = vec4(0.0);
    if (find_pixel(at)) {
        if (DEPTHS) {
            vec2 sums = uintBitsToFloat(uvec2(behind(2u * at, EXPECTED_WORDS), behind(2u * at + 1u, EXPECTED_WORDS)));
            colour = vec4(sums.x * push.params.unit, sums.y, 0.0, sums.y);
        } else {
            colour = picture.at[at];
        }
    }
    // A premultiplied colour is the pixel's own times its alpha.
    if (LINEAR && colour.a > 0.0) {
        colour.rgb = colour.a * linear_light(colour.rgb / colour.a);
    }
    if (STORED && colour.a > 0.0) {
        colour.rgb = colour.a * stored_colour(colour.rgb / colour.a);
    }
}
