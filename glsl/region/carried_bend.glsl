// The weight of a splat that one surface cuts which bends little within it, as a polynomial of degree two in the pixel: to
// second order in the bend, low-pass included. There is no twin: pictures are held to the crossing that it stands for.
#ifndef RARA_REGION_CARRIED_BEND
#define RARA_REGION_CARRIED_BEND
#include "region/crossing.glsl"

// The largest bend, relative to the deviation given the pixel, for which that is within a twentieth of a level of 8 bits. Near
// a silhouette the surface's function hardly varies given the pixel, and a small bend is much.
const float LITTLE_BEND = 0.01;

// With m = G delta the mean given the pixel, h the gradient there and n^2 = h . C h, the surface's function has the value
// F(m) + shift, and z solves F + shift = n z - k z^2, with k the bend along C h / n. All of it to second order in delta. False
// where the surface bends too much for that.
bool carried_bend(Sight s, UnitSurface surface, float scale, out vec3 linear, out vec3 curvature) {
    s.delta = vec2(0.0);
    Line line = line_through(s);
    vec3 gx = scale / line.det * (cross(s.b2, s.c) + s.low_pass * s.b1);
    vec3 gy = scale / line.det * (cross(s.c, s.b1) + s.low_pass * s.b2);
    vec3 a = surface.half_space.xyz;
    vec3 along;
    float n = steepest(line, a, along);
    if (!(bend_norm(surface) * length(a) <= LITTLE_BEND * n * n)) {
        return false;
    }
    float k = bend_along(surface, along) / n;
    vec3 qx = bent(surface, gx);
    vec3 qy = bent(surface, gy);
    float f = (surface.half_space.w + trace_of(line, surface)) / n - k;
    vec2 slope = vec2(dot(a, gx), dot(a, gy)) / n;
    vec3 bend = vec3(dot(gx, qx), 2.0 * dot(gx, qy), dot(gy, qy)) / n;
    // n^2 = n0^2 (1 + e . delta + delta . g delta)
    vec2 e = 4.0 / n * vec2(dot(along, qx), dot(along, qy));
    vec3 g = 4.0 / (n * n) * vec3(dot(qx, spread(line, qx)), 2.0 * dot(qx, spread(line, qy)), dot(qy, spread(line, qy)));
    vec3 ee = vec3(e.x * e.x, 2.0 * e.x * e.y, e.y * e.y);
    linear = vec3(f, slope - 0.5 * f * e);
    curvature = bend - 0.5 * vec3(e.x * slope.x, e.x * slope.y + e.y * slope.x, e.y * slope.y) + f * (0.375 * ee - 0.5 * g);
    // z = q + k q^2 + 2 k^2 q^3, with q the polynomial so far.
    float q = linear.x;
    vec2 q1 = linear.yz;
    vec3 squares = vec3(q1.x * q1.x, 2.0 * q1.x * q1.y, q1.y * q1.y);
    curvature = curvature * (1.0 + 2.0 * k * q) + (k + 6.0 * k * k * q) * squares;
    linear = vec3(q + k * q * q + 2.0 * k * k * q * q * q, q1 * (1.0 + 2.0 * k * q + 6.0 * k * k * q * q));
    return true;
}

#endif
