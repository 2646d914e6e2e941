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
BUFFER(readonly, 6, Gaussian, gaussians)
BUFFER(readonly, 7, Gaussian, earlier) // as edit.comp has it
#include "splats.glsl"
#include "mean_depth.glsl"
#include "footprint.glsl"

layout(location = 0) out vec4 moved; // px to the right and down, the layer's number, 1

// How far a place in a pixel, at a depth, was from where it is, in the layer's axes and units, where an edit has moved its Gaussian:
// it is carried by the Gaussian's axes as they have turned and stretched.
vec3 way_of_edit(uint place, uint since, vec2 pixel, float z) {
    // Deviations from the centre beyond which what shows is the low-pass, which stretches with nothing.
    const float REACH = 4.0;
    Gaussian was = earlier.at[place];
    if (floatBitsToUint(was.position_opacity.w) <= since) {
        return vec3(0.0);
    }
    Gaussian gaussian = gaussians.at[place];
    vec3 position = gaussian.position_opacity.xyz;
    vec3 away = vec3((pixel - VIEW.focal.zw) / VIEW.focal.xy * homogeneous(z), z) - view_position(position, eye_relative(position));
    vec3 from_centre = mat3(LAYER_VIEW.rotation_x.xyz, LAYER_VIEW.rotation_y.xyz, LAYER_VIEW.rotation_z.xyz) * away
        / (LAYER_VIEW.unit * LAYER_VIEW.unit);
    mat3 axes = half_axes(gaussian);
    mat3 axes_before = half_axes(was);
    vec3 way = was.position_opacity.xyz - position - from_centre;
    for (uint axis = 0u; axis < 3u; axis++) {
        float deviations = dot(axes[axis], from_centre) / dot(axes[axis], axes[axis]);
        float held = clamp(deviations, -REACH, REACH);
        float stretch = inversesqrt(dot(axes_before[axis], axes_before[axis])) * length(axes[axis]);
        way += axes_before[axis] * (held + stretch * (deviations - held));
    }
    return way;
}

vec4 motion_of(uint splat) {
    vec2 pixel = gl_FragCoord.xy - push.params.origin;
    SplatDepth depth = SplatDepth(SPLAT_MEAN_DEPTH(splat), SPLAT_FAR_BOUND(splat), SPLAT_NEAR_BOUND(splat));
    float z = mean_depth(depth, pixel - SPLAT_CENTRE(splat).xy);
    uint place = splat_gaussians.at[splat];
    enter_layer_of_block(place / BLOCK_SIZE);
    LayerMotion motion = motions.at[layer_number];
    vec4 point = is_orthographic() ? vec4(pixel, z, 1.0) : vec4(pixel * z, z, 1.0);
    vec3 change = vec3(dot(motion.right, point), dot(motion.down, point), dot(motion.depth, point));
    if (motion.since != NO_EDITS) {
        vec3 way = way_of_edit(place, motion.since, pixel, z);
        change += vec3(dot(motion.way_right.xyz, way), dot(motion.way_down.xyz, way), dot(motion.way_depth.xyz, way));
    }
    float before = homogeneous(z) + change.z;
    vec2 moved_by = change.xy - pixel * change.z;
    // A point that was behind the eye was in no pixel.
    return vec4(before > 0.0 ? moved_by / before : vec2(0.0), layer_number, 1.0);
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
