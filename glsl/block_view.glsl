// The side of a whole block of Gaussians in view and clip, from its bounds. The answers are conservative: a block has a
// side only where each of its Gaussians has it. SIDE_CUTOFF says that they may differ, so that each has to be looked
// at.
#ifndef RARA_BLOCK_VIEW
#define RARA_BLOCK_VIEW
#include "beam.glsl"
#include "block.glsl"

// Contour of 1/255 of an opaque splat, standard deviations.
const float EXTENT_MAX = 3.33;

// A linear function of the camera's frame over the box, whose gradient is the sum of rows times factors that add up to
// `size`: its middle and by how much it can differ from that, the scene's units.
vec2 range_along(vec3 relative, vec3 half_box, vec3 gradient, float size) {
    float spread = dot(abs(gradient), half_box);
    // The eye's rows and the differences are rounded.
    float slack = LAYER_VIEW.unit * 4e-6 * size * (length(relative) + length(half_box));
    return vec2(dot(gradient, relative), spread + slack);
}

vec2 depth_range(vec3 relative, vec3 half_box) {
    return range_along(relative, half_box, LAYER_VIEW.rotation_z.xyz, 1.0);
}

// The same of a x + b w, with the homogeneous coordinate w.
vec2 range_over(vec3 relative, vec3 half_box, vec3 row, float a, float b) {
    float along = is_orthographic() ? 0.0 : b;
    vec2 range = range_along(relative, half_box, a * row + along * LAYER_VIEW.rotation_z.xyz, abs(a) + abs(along));
    return is_orthographic() ? vec2(range.x + b, range.y + 4e-6 * abs(b)) : range;
}

// The side along one axis of the picture: SIDE_CULLED where no splat reaches it, SIDE_VISIBLE where all centres are half a
// pixel inside, else SIDE_CUTOFF. A splat at x, w spans f x/w + c +- K (f sigma/w sqrt(1 + s^2) + sqrt(L)), with s the slope
// of its Jacobian, which an orthographic view has none of; times w all of this is linear.
uint axis_side(vec3 relative, vec3 half_box, vec3 row, float focal, float centre, float size, vec2 slopes, float reach) {
    float steepest = max(abs(slopes.x), abs(slopes.y));
    float span = 1.001 * focal * reach * (is_orthographic() ? 1.0 : sqrt(1.0 + steepest * steepest));
    float edge = EXTENT_MAX * sqrt(LAYER.content.low_pass) + 1.0;
    vec2 before = range_over(relative, half_box, row, focal, centre + edge);
    vec2 behind = range_over(relative, half_box, row, focal, centre - size - edge);
    if (before.x + before.y + span < 0.0 || behind.x - behind.y - span > 0.0) {
        return SIDE_CULLED;
    }
    vec2 first = range_over(relative, half_box, row, focal, centre - 0.51);
    vec2 last = range_over(relative, half_box, row, focal, centre - size + 0.51);
    return first.x - first.y >= 0.0 && last.x + last.y <= 0.0 ? SIDE_VISIBLE : SIDE_CUTOFF;
}

// True when what makes up for the low-pass L leaves each Gaussian of a block in view opaque enough to span a pixel. The
// gradients are B = J M, with J J^T >= g^2 and g the pixels a unit at the block's farthest depth: so B's singular values are
// at least g times the middle and the least deviation, and the factor, a product of l / (l + L) over their squares l, grows
// with g. `spanning_scale` is the g from which it is large enough, by a margin for single precision: that finds |b1 x b2|,
// which is at least .0032 |b| whatever L is (opacity_spanning in src/passes/block_order.rs), to 1e-6 of the product of the
// largest deviations, so to two hundredths where these are at most MOST_COMPENSATED.
bool compensated_block_spans(Block block, float nearest, float farthest) {
    const float MOST_COMPENSATED = 64.0; // px
    vec4 bounds = abs(VIEW.slope_bounds);
    float steepest = is_orthographic() ? 0.0 : max(max(bounds.x, bounds.y), max(bounds.z, bounds.w));
    vec2 focal = LAYER_VIEW.unit * VIEW.focal.xy;
    float largest = abs(block.high_sigma.w) * max(focal.x, focal.y) * (1.0 + 2.0 * steepest * steepest);
    return largest < MOST_COMPENSATED * homogeneous(nearest)
        && min(focal.x, focal.y) > 1.0001 * block.spanning_scale * homogeneous(farthest);
}

// SIDE_CULLED where no Gaussian is in view, SIDE_VISIBLE where all are, else SIDE_CUTOFF.
uint block_view_side(Block block) {
    float reach = LAYER_VIEW.unit * block.low_reach.w;
    float sigma = LAYER_VIEW.unit * block.high_sigma.w;
    if (reach < 0.0 || LAYER.content.visible == 0u) {
        return SIDE_CULLED;
    }
    vec3 relative = eye_relative(block_middle(block));
    vec3 half_box = block_half(block);
    vec2 depth = depth_range(relative, half_box);
    float farthest = depth.x + depth.y;
    float nearest = depth.x - depth.y;
    if (farthest < VIEW.near_cut) {
        return SIDE_CULLED;
    }
    vec4 focal = VIEW.focal;
    uint x = axis_side(relative, half_box, LAYER_VIEW.rotation_x.xyz, focal.x, focal.z, VIEW.size.x, VIEW.slope_bounds.xy, reach);
    uint y = axis_side(relative, half_box, LAYER_VIEW.rotation_y.xyz, focal.y, focal.w, VIEW.size.y, VIEW.slope_bounds.zw, reach);
    if (x == SIDE_CULLED || y == SIDE_CULLED) {
        return SIDE_CULLED;
    }
    // A layer's opacity may leave some of them fainter than the block knows.
    bool drawable = sigma >= 0.0 && LAYER.content.opacity == 1.0 && nearest > 1.0001 * VIEW.near_cut
        && 4.0 * sigma * max(focal.x, focal.y) < DRAWABLE_DEVIATION * homogeneous(nearest)
        && (LAYER.content.antialiased == 0u || compensated_block_spans(block, nearest, farthest));
    return x == SIDE_VISIBLE && y == SIDE_VISIBLE && drawable ? SIDE_VISIBLE : SIDE_CUTOFF;
}

// Least depth of a centre, the scene's units.
float block_nearest(Block block) {
    vec2 depth = depth_range(eye_relative(block_middle(block)), block_half(block));
    return depth.x - depth.y;
}

// True when the exact form of some splat may follow true rays, because the splat is large or its slope is clamped.
bool may_be_beam(Block block) {
    if (CUT.region.mode != MODE_EXACT || EYE.weight.form == FORM_AFFINE || is_orthographic()) {
        return false;
    }
    vec3 relative = eye_relative(block_middle(block));
    vec3 half_box = block_half(block);
    vec4 bounds = VIEW.slope_bounds;
    vec2 left = range_over(relative, half_box, LAYER_VIEW.rotation_x.xyz, 1.0, -bounds.x);
    vec2 right = range_over(relative, half_box, LAYER_VIEW.rotation_x.xyz, 1.0, -bounds.y);
    vec2 top = range_over(relative, half_box, LAYER_VIEW.rotation_y.xyz, 1.0, -bounds.z);
    vec2 bottom = range_over(relative, half_box, LAYER_VIEW.rotation_y.xyz, 1.0, -bounds.w);
    bool clamped = !(left.x - left.y > 0.0 && right.x + right.y < 0.0 && top.x - top.y > 0.0 && bottom.x + bottom.y < 0.0);
    return EYE.weight.form == FORM_BEAM || clamped || LAYER_VIEW.unit * abs(block.high_sigma.w) > EYE.weight.beam_switch * max(block_nearest(block), 0.0);
}

// The clip's side of a block that is in view as a whole, so that no slope is clamped. Where no splat is large, it does not
// depend on the camera and is `side`.
uint block_side_in_view(Block block, uint side) {
    if (!may_be_beam(block)) {
        return side;
    }
    float rest = 1.0 - 1.001 * LAYER_VIEW.unit * block.low_reach.w / block_nearest(block);
    if (SHORTLIST_WIDENING * rest < 1.0) {
        leave_shortlist();
    }
    return rest > WIDENING_REST ? block_clip_side(block, 1.0 / rest) : SIDE_CUTOFF;
}

#endif
