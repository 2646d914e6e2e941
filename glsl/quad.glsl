// The quad that a splat is drawn with: a parallelogram that covers every pixel to which it contributes, and few others.
#ifndef RARA_QUAD
#define RARA_QUAD
#include "footprint.glsl"
#include "cut.glsl"

// A little wider than exact: the fragment stage decides what is inside, and the quad must only not be too small.
// Rasterisers may move its corners by half of the least precision that Vulkan allows them, 1/32 px.
float widened(float half_side) {
    return 1.001 * half_side + 0.04;
}

// The smallest rectangle around the contour q = extent^2. det comes as a sum of squares, so the thin axis of a needle
// is right where a difference of eigenvalues would be noise.
Quad along_axes(Footprint f, float extent) {
    float mean = 0.5 * (f.xx + f.yy);
    float radius = length(vec2(0.5 * (f.xx - f.yy), f.xy));
    float long_variance = mean + radius;
    float short_variance = f.det / long_variance;
    vec2 direction = f.xx > f.yy ? vec2(long_variance - f.yy, f.xy) : vec2(f.xy, long_variance - f.xx);
    float size = length(direction);
    direction = size > 0.0 ? direction / size : vec2(1.0, 0.0);
    return Quad(vec2(0.0), widened(extent * sqrt(long_variance) / f.scale) * direction,
                widened(extent * sqrt(short_variance) / f.scale) * vec2(-direction.y, direction.x));
}

// The rectangle around the same contour with a side along a direction.
Quad along_direction(Footprint f, float extent, vec2 direction) {
    vec2 across = vec2(-direction.y, direction.x);
    // |B^T d|^2 + L for each side: sums of squares, where d^T (B B^T) d would cancel for needles.
    vec3 along = f.b1 * direction.x + f.b2 * direction.y;
    vec3 aside = f.b1 * across.x + f.b2 * across.y;
    vec2 half_sides = extent * sqrt(vec2(dot(along, along), dot(aside, aside)) + f.low_pass) / f.scale;
    return Quad(vec2(0.0), widened(half_sides.x) * direction, widened(half_sides.y) * across);
}

// The part of [-1, 1] in which slope s + offset can be positive, as middle and half length.
vec2 kept_interval(float slope, float offset) {
    float low = slope > 0.0 ? clamp(-offset / slope, -1.0, 1.0) : -1.0;
    float high = slope < 0.0 ? clamp(-offset / slope, -1.0, 1.0) : 1.0;
    return vec2(0.5 * (low + high), 0.5 * (high - low));
}

// The part of a cut splat's weight that the rasteriser carries: see cut.glsl.
struct Carried {
    vec3 linear; // z at the centre, dz/dx, dz/dy
    vec3 curvature; // the factors of dx^2, dx dy and dy^2
};

// By how much curvature can raise z anywhere in the quad.
float rise(Quad quad, vec3 curvature) {
    vec2 u = quad.first;
    vec2 v = quad.second;
    float ss = curvature.x * u.x * u.x + curvature.y * u.x * u.y + curvature.z * u.y * u.y;
    float tt = curvature.x * v.x * v.x + curvature.y * v.x * v.y + curvature.z * v.y * v.y;
    float st = 2.0 * curvature.x * u.x * v.x + curvature.y * (u.x * v.y + u.y * v.x) + 2.0 * curvature.z * u.y * v.y;
    return max(ss, 0.0) + max(tt, 0.0) + abs(st);
}

// Cuts off what lies wholly where line.x + line.yz . delta is negative.
Quad trimmed(Quad quad, vec3 line) {
    float a = dot(line.yz, quad.first);
    float b = dot(line.yz, quad.second);
    vec2 s = kept_interval(a, line.x + abs(b));
    vec2 t = kept_interval(b, line.x + abs(a));
    return Quad(quad.middle + s.x * quad.first + t.x * quad.second, s.y * quad.first, t.y * quad.second);
}

float area(Quad quad) {
    return length(quad.first) * length(quad.second);
}

Quad quad_around(Footprint f, float extent, Carried weight) {
    Quad quad = along_axes(f, extent);
    if (max(largest(vec3(quad.first, 0.0)), largest(vec3(quad.second, 0.0))) > QUAD_MAX_EXTENT) {
        vec2 box = box_half_sides(f, extent);
        vec2 low = max(f.screen_centre - vec2(widened(box.x), widened(box.y)), vec2(0.0));
        vec2 high = min(f.screen_centre + vec2(widened(box.x), widened(box.y)), VIEW.size.xy);
        // A centre far outside the picture is known to a few units in its last place only, and the corners are sums
        // with it.
        vec2 half_sides = 0.5 * (high - low) + 1.0 + 1e-6 * abs(f.screen_centre);
        return Quad(0.5 * (low + high) - f.screen_centre, vec2(half_sides.x, 0.0), vec2(0.0, half_sides.y));
    }
    float steepness = length(weight.linear.yz);
    if (abs(weight.linear.x) < Z_RANGE && steepness > 0.0) {
        vec3 line = vec3(weight.linear.x + TRIM_DEVIATIONS + rise(quad, weight.curvature), weight.linear.yz);
        Quad straight = trimmed(quad, line);
        // The contour is inside the first quad too, so its bound on the rise serves both.
        Quad turned = trimmed(along_direction(f, extent, weight.linear.yz / steepness), line);
        return area(turned) < area(straight) ? turned : straight;
    }
    return quad;
}

#endif
