#version 460
// An octahedron: three corners a face, no buffers.
layout(push_constant) uniform Push {
    mat4 world_to_clip;
    vec4 centre_radius;
};
layout(location = 0) flat out vec3 colour;

void main() {
    uint face = gl_VertexIndex / 3u;
    vec3 sides = vec3((uvec3(face) >> uvec3(0u, 1u, 2u)) & 1u) * 2.0 - 1.0;
    vec3 corner = vec3(0.0);
    corner[gl_VertexIndex % 3u] = sides[gl_VertexIndex % 3u];
    colour = vec3(0.5) + sides * vec3(0.25, -0.15, -0.2);
    gl_Position = world_to_clip * vec4(centre_radius.xyz + centre_radius.w * corner, 1.0);
}
