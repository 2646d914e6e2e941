#version 460
#extension GL_GOOGLE_include_directive : require
// Writes how far what is seen in a pixel has moved since the frame before, px, the number of its layer, and whether it was kept then:
// of the splat that adds most to the pixel's alpha, where this splat is on the pixel's line of sight.
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
#define MESHES_BINDING 9
#define SURFACES_BINDING 8 // those of the frame before, and behind them those of this one
#include "region/surface.glsl"
#include "region/answers.glsl"

layout(location = 0) out vec4 moved; // px to the right and down, the layer's number, 1 if it was kept in the frame before

// The place of a pixel's content at a depth, relative to a Gaussian's centre, in the layer's axes and units.
vec3 from_centre_of(vec3 centre, vec2 pixel, float z) {
    vec3 away = vec3((pixel - VIEW.focal.zw) / VIEW.focal.xy * homogeneous(z), z) - view_position(centre, eye_relative(centre));
    return mat3(LAYER_VIEW.rotation_x.xyz, LAYER_VIEW.rotation_y.xyz, LAYER_VIEW.rotation_z.xyz) * away
        / (LAYER_VIEW.unit * LAYER_VIEW.unit);
}

// How far that was from where it is, if an edit has moved the Gaussian: it is carried by the Gaussian's axes as they have turned and
// stretched.
vec3 way_of_edit(Gaussian gaussian, Gaussian was, vec3 from_centre) {
    // Deviations from the centre beyond which what shows is the low-pass, which stretches with nothing.
    const float REACH = 4.0;
    mat3 axes = half_axes(gaussian);
    mat3 axes_before = half_axes(was);
    vec3 way = was.position_opacity.xyz - gaussian.position_opacity.xyz - from_centre;
    for (uint axis = 0u; axis < 3u; axis++) {
        float deviations = dot(axes[axis], from_centre) / dot(axes[axis], axes[axis]);
        float held = clamp(deviations, -REACH, REACH);
        float stretch = inversesqrt(dot(axes_before[axis], axes_before[axis])) * length(axes[axis]);
        way += axes_before[axis] * (held + stretch * (deviations - held));
    }
    return way;
}

// The same of any Gaussian; 0 where no edit has moved it.
vec3 way_in_layer(uint place, uint since, Gaussian gaussian, vec3 from_centre) {
    bool is_moved = since != NO_EDITS && floatBitsToUint(earlier.at[place].position_opacity.w) > since;
    return is_moved ? way_of_edit(gaussian, earlier.at[place], from_centre) : vec3(0.0);
}

// True where a region keeps a point. So much is added to the numbers of its surfaces.
bool keeps(LayerRegion region, uint first_surface, vec3 point) {
    bool all = true;
    bool any = region.surface_count == 0u;
    uint stack = 1u;
    for (uint i = 0u; i < region.surface_count; i++) {
        uint surface = first_surface + region.first_surface + i;
        bool is_kept = surface_distance(surface, point) >= 0.0;
        all = all && is_kept;
        any = any || is_kept;
        if (region.op == OP_PARTS) {
            stack = answered(stack, is_kept, surfaces.at[surface].operators);
        }
    }
    return region.op == OP_PARTS ? (stack & 1u) != 0u : region.op == OP_OR ? any : all;
}

// True where the clip keeps what it cut away in the frame before. A hard clip asks for the Gaussian's centre.
bool is_uncovered(LayerMotion motion, uint place, Gaussian gaussian, vec3 from_centre) {
    vec3 asked = CUT.region.mode == MODE_HARD ? vec3(0.0) : from_centre;
    vec3 point = gaussian.position_opacity.xyz + asked;
    return !keeps(motion.region, 0u, point + way_in_layer(place, motion.since, gaussian, asked))
        && keeps(LAYER.region, motion.first_surface, point);
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
    bool was_kept = motion.was_shown != 0u;
    if (motion.since != NO_EDITS || motion.clip_has_moved != 0u) {
        Gaussian gaussian = gaussians.at[place];
        vec3 from_centre = from_centre_of(gaussian.position_opacity.xyz, pixel, z);
        vec3 way = way_in_layer(place, motion.since, gaussian, from_centre);
        change += vec3(dot(motion.way_right.xyz, way), dot(motion.way_down.xyz, way), dot(motion.way_depth.xyz, way));
        was_kept = was_kept && !(motion.clip_has_moved != 0u && is_uncovered(motion, place, gaussian, from_centre));
    }
    float before = homogeneous(z) + change.z;
    // A point that was behind the eye was in no pixel.
    if (!(before > 0.0)) {
        return vec4(0.0, 0.0, layer_number, 0.0);
    }
    return vec4((change.xy - pixel * change.z) / before, layer_number, was_kept ? 1.0 : 0.0);
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
