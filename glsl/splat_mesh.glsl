// One invocation a splat, four corners and two triangles each, in order. Included by the mesh shaders, which say how what is one
// for a splat goes to the fragment shader, ONE_A_SPLAT, and in how many copies, COPIES.
#ifndef RARA_SPLAT_MESH
#define RARA_SPLAT_MESH
#extension GL_EXT_mesh_shader : require
#include "splat_params.glsl"
#include "corners.glsl"

layout(local_size_x = MESH_GROUP_SIZE) in;
layout(triangles, max_vertices = MESH_GROUP_SIZE * 4, max_primitives = MESH_GROUP_SIZE * 2) out;

layout(location = 0) ONE_A_SPLAT out vec4 centre_conic[];
layout(location = 1) ONE_A_SPLAT out vec4 conic_cut[];
layout(location = 2) ONE_A_SPLAT out vec4 colour_cut[];
layout(location = 3) ONE_A_SPLAT out vec3 curvature[];

void main() {
    uint total = counts.at[0].mesh_groups.w;
    uint begin = min(LINEAR_GROUP * MESH_GROUP_SIZE, total);
    uint here = min(MESH_GROUP_SIZE, total - begin);
    SetMeshOutputsEXT(4u * here, 2u * here);
    uint local = gl_LocalInvocationIndex;
    if (local >= here) {
        return;
    }
    uint splat_index = splat_index_at(begin + local);
    Splat splat = splat_at(splat_index);
    Quad quad = quads.at[splat_index];
    for (uint i = 0u; i < 4u; i++) {
        gl_MeshVerticesEXT[4u * local + i].gl_Position = corner(splat, quad, i);
    }
    for (uint i = COPIES * local; i < COPIES * (local + 1u); i++) {
        centre_conic[i] = fragment_centre(splat);
        conic_cut[i] = splat.conic_cut;
        colour_cut[i] = splat.colour_cut;
        curvature[i] = splat.curvature_depth.xyz;
    }
    gl_PrimitiveTriangleIndicesEXT[2u * local] = 4u * local + uvec3(0u, 1u, 2u);
    gl_PrimitiveTriangleIndicesEXT[2u * local + 1u] = 4u * local + uvec3(2u, 1u, 3u);
}

#endif
