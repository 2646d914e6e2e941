#version 460
#extension GL_GOOGLE_include_directive : require
// Writes how far what is seen in a pixel has moved since the frame before, px, and the number of its layer: that of the splat that
// adds most to the pixel's alpha, where this splat is on the pixel's line of sight.
struct Params {
    vec2 origin; // where the viewport begins in the attachment, px
    float least_alpha; // pixels below it keep what they have
};
#define PARAMS Params
#include "tile_pixel.glsl"

BUFFER(readonly, 3, vec4, splats)
BUFFER(readonly, 4, uint, splat_gaussians)
BUFFER(readonly, 5, LayerMotion, motions)
#include "splats.glsl"
#include "mean_depth.glsl"
#include "layer.glsl"

layout(location = 0) out vec4 moved; // px to the right and down, the layer's number, 1

vec4 motion_of(uint splat) {
    vec2 pixel = gl_FragCoord.xy - push.params.origin;
    SplatDepth depth = SplatDepth(SPLAT_MEAN_DEPTH(splat), SPLAT_FAR_BOUND(splat), SPLAT_NEAR_BOUND(splat));
    float z = mean_depth(depth, pixel - SPLAT_CENTRE(splat).xy);
    enter_layer_of_block(splat_gaussians.at[splat] / BLOCK_SIZE);
    LayerMotion motion = motions.at[layer_number];
    vec4 point = is_orthographic() ? vec4(pixel, z, 1.0) : vec4(pixel * z, z, 1.0);
    float change = dot(motion.depth, point);
    float before = (is_orthographic() ? 1.0 : z) + change;
    vec2 way = vec2(dot(motion.right, point), dot(motion.down, point)) - pixel * change;
    // A point that was behind the eye was in no pixel.
    return vec4(before > 0.0 ? way / before : vec2(0.0), layer_number, 1.0);
}

void main() {
    uint at;
    bool shows = find_pixel(at) && picture.at[at].a >= push.params.least_alpha;
    uint splat = shows ? behind(at, STRONGEST_WORDS) : NO_SPLAT;
    // Drivers for CPUs go on behind a discard, and would read the splat that there is not.
    if (splat != NO_SPLAT) {
        moved = motion_of(splat);
    } else {
        discard;
    }
}
