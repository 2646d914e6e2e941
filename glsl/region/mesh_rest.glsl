// A mesh as one Gaussian sees it: few planes, a sheet that a quadric fits, its faces, or the whole of it. Included after the buffer
// `cut_records` is declared. Twin: src/reference/region/inside.rs, which always takes the whole.
#ifndef RARA_REGION_MESH_REST
#define RARA_REGION_MESH_REST
#include "region/faces.glsl"
#include "region/mesh.glsl"
#include "region/sheet.glsl"
#include "region/written.glsl"

// The most planes as which a mesh is written. They take what is known of planes, and what they keep is that to the bit.
const uint MESH_PLANES = 4u;
// Faces are in a plane if they are no farther from it, deviations.
const float MESH_FLAT = 1e-3;
// How much farther than the Gaussian its faces are looked for, deviations: lines across it reach there.
const float MESH_BEYOND = 1.0;

// After so many faces that no plane holds, the nearest of them counts for the nearest of all.
const uint MESH_SEEN = 64u;

// The rest of a mesh, as a Gaussian sees it.
struct MeshRest {
    uint needed; // entries; 0 where no face comes near
    float winding; // of the mesh around the centre, where it is needed
    bool has_faces; // it is no combination of planes that is known
};

// True where planes together keep the centre.
bool planes_keep(vec4 planes[MESH_PLANES], uint count, bool is_all) {
    bool keeps = is_all;
    for (uint i = 0u; i < count; i++) {
        keeps = is_all ? keeps && planes[i].w >= 0.0 : keeps || planes[i].w >= 0.0;
    }
    return keeps;
}

// Where a surface's mesh begins behind the records.
uint mesh_root(uint surface) {
    return EYE.weight.meshes + surfaces.at[surface].mesh;
}

// All faces of a mesh, as lines walk them.
Faces whole_mesh(uint surface, MeshBall ball) {
    return Faces(ball.axes, 0u, 0u, 0.0, mesh_keeps_outside(surface), false, true, mesh_root(surface), ball.centre);
}

void write_part(uint entry, uint part, vec4 x, vec4 y, vec4 z) {
    uint at = written_record + CUT_HEADER + ENTRY_VECTORS * (entry + part);
    cut_records.at[at] = x;
    cut_records.at[at + 1u] = y;
    cut_records.at[at + 2u] = z;
}

// Writes what a mesh is to a Gaussian from an entry on, if there is room. Where the faces near it lie in few planes that all meet alike, it
// is their intersection or their union; else it is its faces, or where they have no room the whole mesh.
MeshRest write_mesh(uint surface, mat3 axes, vec3 position, float deviations, uint first, uint room) {
    MeshTree tree = mesh_tree(surface);
    MeshBall ball = mesh_ball(surface, axes, position);
    bool keeps_outside = mesh_keeps_outside(surface);
    float inverse = 1.0 / max(ball.size, 1e-30);
    vec4 planes[MESH_PLANES];
    uint plane_count = 0u;
    bool are_planes = true;
    bool are_all_kept = true; // each face by all planes but its own
    bool are_all_dropped = true;
    vec4 nearest = vec4(0.0);
    float least = 1e30;
    uint face_count = 0u;
    MeshRest rest = MeshRest(0u, 0.0, false);
    // There is one copy of the search for all turns: it finds the planes, how they meet, how many faces there are, and writes these.
    for (uint turn = 0u; turn < 4u; turn++) {
        if (turn == 2u) {
            are_planes = are_planes && (are_all_kept || are_all_dropped);
            UnitSurface sheet;
            if (!are_planes && !tree.overlaps && fitted_sheet(whole_mesh(surface, ball), tree, ball, deviations, nearest, sheet)) {
                rest.needed = 1u;
                if (first < room) {
                    write_entry(first, sheet, 0u);
                }
                return rest;
            }
            if (plane_count == 0u || tree.overlaps || !are_planes) {
                rest.winding = mesh_winding(tree, ball.centre);
            }
            if (plane_count == 0u) {
                return rest;
            }
            // Faces within a mesh that overlaps bound nothing.
            are_planes = are_planes && (!tree.overlaps || rest.winding == (planes_keep(planes, plane_count, are_all_kept) != keeps_outside ? 1.0 : 0.0));
            if (are_planes) {
                break;
            }
        }
        FaceSearch search = FaceSearch(0u, 0u);
        uint face;
        uint seen = 0u;
        while (next_face(tree, ball, turn < 2u ? deviations : deviations + MESH_BEYOND, search, face)) {
            Face here = mesh_face(tree, face);
            seen++;
            if (turn == 2u) {
                face_count++;
                if (first + 1u + face_count > room) {
                    break;
                }
                continue;
            }
            if (turn == 3u) {
                // In even space, where thin Gaussians keep their digits.
                write_part(first, seen, vec4((here.a - ball.centre) * inverse, 0.0), vec4((here.b - ball.centre) * inverse, 0.0),
                    vec4((here.c - ball.centre) * inverse, ENTRY_FACE));
                continue;
            }
            vec4 plane = face_half_space(ball, here, keeps_outside);
            Face unit = unit_face(ball, here);
            uint own = 0u;
            while (own < plane_count && !(dot(planes[own].xyz, plane.xyz) > 0.0 && length(planes[own].xyz - plane.xyz) * deviations
                    + abs(planes[own].w - plane.w) < MESH_FLAT)) {
                own++;
            }
            if (turn == 0u) {
                float square = face_square(unit.a, unit.b, unit.c);
                nearest = square < least ? plane : nearest;
                least = min(least, square);
                if (own == plane_count && plane_count < MESH_PLANES) {
                    planes[plane_count++] = plane;
                } else if (own == plane_count) {
                    are_planes = false;
                }
                if (!are_planes && seen >= MESH_SEEN) {
                    break;
                }
                continue;
            }
            for (uint i = 0u; i < plane_count; i++) {
                vec3 values = vec3(dot(planes[i].xyz, unit.a), dot(planes[i].xyz, unit.b), dot(planes[i].xyz, unit.c)) + planes[i].w;
                are_all_kept = are_all_kept && (i == own || min(min(values.x, values.y), values.z) >= -MESH_FLAT);
                are_all_dropped = are_all_dropped && (i == own || max(max(values.x, values.y), values.z) <= MESH_FLAT);
            }
        }
        // All is known already.
        turn += turn == 0u && (!are_planes || plane_count <= 1u) ? 1u : 0u;
        turn += turn == 2u && first + 1u + face_count > room ? 1u : 0u;
    }
    rest.has_faces = !are_planes;
    bool is_walked = rest.has_faces && first + 1u + face_count > room;
    rest.needed = are_planes ? plane_count : is_walked ? WALKED_ENTRIES : 1u + face_count;
    if (first + rest.needed > room) {
        return rest;
    }
    if (rest.has_faces) {
        uint root = mesh_root(surface);
        uint kind = GROUP | (keeps_outside ? GROUP_KEEPS_OUTSIDE : 0u) | (tree.overlaps ? GROUP_OVERLAPS : 0u) | (is_walked ? GROUP_WALKED : 0u);
        float scale = is_walked ? 1.0 : inverse;
        float known = is_walked ? float(root & (1u << ROOT_SHIFT) - 1u) : rest.winding;
        write_part(first, 0u, vec4(ball.axes[0] * scale, float(rest.needed - 1u)), vec4(ball.axes[1] * scale, known),
            vec4(ball.axes[2] * scale, float(kind)));
        if (is_walked) {
            write_part(first, 1u, vec4(ball.centre, float(root >> ROOT_SHIFT)), vec4(0.0), vec4(vec3(0.0), ENTRY_PLACE));
            write_part(first, 2u, nearest, vec4(0.0), vec4(vec3(0.0), ENTRY_PLANE));
        }
        return rest;
    }
    for (uint i = 0u; i < plane_count; i++) {
        uint operators = i == 0u ? 0u : 1u | (are_all_kept ? 0u : 1u << OPERATOR_SHIFT);
        write_entry(first + i, UnitSurface(planes[i], vec3(0.0), vec3(0.0)), operators);
    }
    return rest;
}

#endif
