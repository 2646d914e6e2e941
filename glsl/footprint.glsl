// A Gaussian on the screen, by EWA projection as published with 3DGS (Kerbl et al. 2023), in forms without cancelling
// determinants. With the view-space factor M (rows m1 m2 m3, covariance M M^T) the screen gradient in the Gaussian's
// own unit space is b1 = fx/Z (m1 - X/Z m3), b2 = fy/Z (m2 - Y/Z m3); the 2D covariance is
// [b1.b1 + L, b1.b2; b1.b2, b2.b2 + L] with the low-pass L, and its determinant |b1 x b2|^2 + L(|b1|^2+|b2|^2) + L^2
// is a sum of non-negative terms where the textbook subtracts.
//
// A pixel is fx X/w + cx, with the homogeneous coordinate w: Z in perspective, and 1 in an orthographic view. With the
// gradient of w, m3 or nothing, b1 = fx/w (m1 - X/w dw) holds for both.
#ifndef RARA_FOOTPRINT
#define RARA_FOOTPRINT
#include "axes.glsl"
#include "layer.glsl"
#include "two_float.glsl"

struct Footprint {
    vec3 view_centre; // the centre in the camera's frame, the scene's units
    vec3 relative; // the centre relative to the eye, the layer's axes and units
    mat3 axes; // the half axes in the layer, one standard deviation long: the columns of M
    vec3 m1, m2, m3; // the rows of M in camera axes
    float w; // the centre's homogeneous coordinate
    vec3 w_gradient; // its gradient in unit space
    vec3 b1, b2; // the gradients on the screen, times scale
    vec2 slope; // x/w and y/w at which they were evaluated
    float scale; // 1 / max(1, |b|): keeps every product below in range
    float low_pass; // the layer's low-pass times scale^2
    float xx, xy, yy, det; // 2D covariance and determinant, times scale^2 and scale^4
    vec2 screen_centre; // px
    bool clamped; // whether the slope was clamped
};

// The centre relative to the eye, the layer's axes and units.
vec3 eye_relative(vec3 position) {
    return two_float_difference(position, LAYER_VIEW.eye_high.xyz, LAYER_VIEW.eye_low.xyz);
}

vec3 to_view(vec3 relative) {
    return vec3(dot(LAYER_VIEW.rotation_x.xyz, relative), dot(LAYER_VIEW.rotation_y.xyz, relative),
                dot(LAYER_VIEW.rotation_z.xyz, relative));
}

// The centre in the camera's frame.
vec3 view_position(vec3 position, vec3 relative) {
    if (VIEW.precise_view == 0u) {
        return to_view(relative);
    }
    vec3 high = LAYER_VIEW.eye_high.xyz;
    vec3 low = LAYER_VIEW.eye_low.xyz;
    return vec3(two_float_view(LAYER_VIEW.rotation_x.xyz, LAYER_VIEW.rotation_low[0].xyz, position, high, low),
                two_float_view(LAYER_VIEW.rotation_y.xyz, LAYER_VIEW.rotation_low[1].xyz, position, high, low),
                two_float_view(LAYER_VIEW.rotation_z.xyz, LAYER_VIEW.rotation_low[2].xyz, position, high, low));
}

// The homogeneous coordinate of what is as deep as this.
float homogeneous(float depth) {
    return is_orthographic() ? 1.0 : depth;
}

// a / b for all b that are positive. Vulkan promises a quotient for b up to 2^126 only.
vec2 quotient(vec2 a, float b) {
    return 0.25 * a / (0.25 * b);
}

vec3 quotient(vec3 a, float b) {
    return 0.25 * a / (0.25 * b);
}

// Screen gradients at a slope, unscaled.
void screen_gradients(Footprint f, vec2 slope, out vec3 b1, out vec3 b2) {
    vec2 magnification = quotient(VIEW.focal.xy, f.w);
    b1 = magnification.x * (f.m1 - slope.x * f.w_gradient);
    b2 = magnification.y * (f.m2 - slope.y * f.w_gradient);
}

// Makes a footprint without what projection finds.
Footprint unprojected(Gaussian gaussian) {
    Footprint f;
    f.relative = eye_relative(gaussian.position_opacity.xyz);
    f.view_centre = view_position(gaussian.position_opacity.xyz, f.relative);
    f.axes = half_axes(gaussian);
    f.m1 = LAYER_VIEW.rotation_x.xyz * f.axes;
    f.m2 = LAYER_VIEW.rotation_y.xyz * f.axes;
    f.m3 = LAYER_VIEW.rotation_z.xyz * f.axes;
    f.w = homogeneous(f.view_centre.z);
    f.w_gradient = is_orthographic() ? vec3(0.0) : f.m3;
    f.clamped = false;
    return f;
}

Footprint footprint(Gaussian gaussian) {
    Footprint f = unprojected(gaussian);
    vec2 slope = quotient(f.view_centre.xy, f.w);
    f.screen_centre = VIEW.focal.xy * slope + VIEW.focal.zw;
    f.slope = clamp(slope, VIEW.slope_bounds.xz, VIEW.slope_bounds.yw);
    f.clamped = f.slope != slope;
    screen_gradients(f, f.slope, f.b1, f.b2);
    f.scale = 1.0 / max(1.0, max(largest(f.b1), largest(f.b2)));
    f.b1 *= f.scale;
    f.b2 *= f.scale;
    f.low_pass = LAYER.content.low_pass * f.scale * f.scale;
    float n1 = dot(f.b1, f.b1);
    float n2 = dot(f.b2, f.b2);
    vec3 c = cross(f.b1, f.b2);
    f.xx = n1 + f.low_pass;
    f.yy = n2 + f.low_pass;
    f.xy = dot(f.b1, f.b2);
    f.det = dot(c, c) + f.low_pass * (n1 + n2) + f.low_pass * f.low_pass;
    return f;
}

// The Cholesky factor k0 k1 k2 of the inverse 2D covariance, 1/px: q = (k0 dx)^2 + (k1 dx + k2 dy)^2. This is a sum of
// squares, so that alpha never exceeds the opacity; the three coefficients of the inverse would cancel for needles.
vec3 conic_of(Footprint f) {
    float k2 = sqrt(f.xx / f.det);
    return vec3(inversesqrt(f.xx), -k2 * (f.xy / f.xx), k2) * f.scale;
}

// The opacity on the screen. The low-pass makes a splat larger; where its Gaussians are antialiased, it gets no brighter: its
// opacity is multiplied by the root of the ratio of the determinants without the low-pass, |b1 x b2|^2, and with it (the 2D
// Mip filter of Yu et al. 2024). Whatever does not depend on the camera takes the opacity in the layer, which is no less.
float opacity_on_screen(Footprint f, Gaussian gaussian) {
    float opacity = opacity_in_layer(gaussian);
    if (LAYER.content.antialiased != 0u) {
        vec3 c = cross(f.b1, f.b2);
        opacity *= sqrt(max(dot(c, c) / f.det, COMPENSATION_SQUARE_MIN));
    }
    return opacity;
}

// Half the sides of the bounding box of the splat's contour at q = extent^2, px.
vec2 box_half_sides(Footprint f, float extent) {
    return extent * sqrt(vec2(f.xx, f.yy)) / f.scale;
}

#endif
