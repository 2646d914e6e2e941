// The axes of a Gaussian in its layer.
#ifndef RARA_AXES
#define RARA_AXES
#include "types.glsl"
#include "extent.glsl"

mat3 rotation_matrix(vec4 q) {
    vec3 d = q.xyz + q.xyz;
    vec3 x = q.x * d;
    vec3 w = q.w * d;
    float yy = q.y * d.y;
    float yz = q.y * d.z;
    float zz = q.z * d.z;
    return mat3(1.0 - (yy + zz), x.y + w.z, x.z - w.y,
                x.y - w.z, 1.0 - (x.x + zz), yz + w.x,
                x.z + w.y, yz - w.x, 1.0 - (x.x + yy));
}

// A disc has a thickness, so that a plane in which it lies keeps half of it and not all, as for any other thickness.
mat3 half_axes(Gaussian gaussian) {
    mat3 turn = rotation_matrix(gaussian.rotation);
    vec3 scale = max(gaussian.scale.xyz, THINNEST * largest(gaussian.scale.xyz));
    return mat3(turn[0] * scale.x, turn[1] * scale.y, turn[2] * scale.z);
}

#endif
