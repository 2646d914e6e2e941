// A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided. Included
// after the buffer `cut_records` is declared. Twin: src/reference/region/reduced.rs.
#ifndef RARA_REGION_REDUCED
#define RARA_REGION_REDUCED
#include "cut.glsl"
#include "footprint.glsl"
#include "region/gaussian_side.glsl"
#include "region/mesh_rest.glsl"
#include "region/written.glsl"

#define HAS_PARTS COMBINED
#include "region/parts.glsl"

// A surface is taken to keep no more than another if it reaches beyond that by at most this, deviations.
const float IMPLIED = 3e-4;

// About how far a surface that cuts a Gaussian is from its centre, in standard deviations.
float nearness(UnitSurface s) {
    float slope = length(s.half_space.xyz) + sqrt(abs(s.half_space.w) * bend_norm(s));
    return min(abs(s.half_space.w) / max(slope, 1e-30), 1e29);
}

// The order in which surfaces take the places of a record that has not room for all. Of a list those come first that leave least
// of the splat, and else those that are nearest its centre.
float precedence(UnitSurface s) {
    if (LAYER.region.combined != 0u) {
        return nearness(s);
    }
    float leaves = clamp(s.half_space.w / max(length(s.half_space.xyz), 1e-30), -1e29, 1e29);
    return LAYER.region.op == OP_OR ? -leaves : leaves;
}

// The precedence of the last of the surfaces that have room, and how many of that precedence have.
float last_precedence(Footprint f, vec3 position, float deviations, inout uint room) {
    float farthest = -1e30;
    while (true) {
        float next = 1e30;
        uint ties = 0u;
        for (uint i = 0u; i < surface_count(); i++) {
            uint surface = surface_at(i);
            if (surface_gaussian_side(surface, f.axes, position, deviations) == SIDE_CUTOFF) {
                float here = precedence(unit_surface(surface, f.axes, position));
                ties = here > farthest && here < next ? 1u : here == next ? ties + 1u : ties;
                next = here > farthest ? min(next, here) : next;
            }
        }
        if (ties == 0u || ties >= room) {
            return next;
        }
        room -= ties;
        farthest = next;
    }
}

// True when a surface keeps nothing of a Gaussian, as far as `deviations`, that another one does not keep. It follows if the
// difference of their functions, with a little of the squared distance added, is nowhere negative: if a matrix is positive definite.
bool implies(UnitSurface one, UnitSurface other, float deviations) {
    float slack = IMPLIED * min(length(one.half_space.xyz), length(other.half_space.xyz));
    vec4 plane = other.half_space - one.half_space;
    vec3 d = other.diagonal - one.diagonal + 0.5 * slack / (deviations * deviations);
    vec3 a = other.across - one.across;
    vec3 n = 0.5 * plane.xyz;
    mat4 rest = mat4(vec4(d.x, a.xy, n.x), vec4(a.x, d.y, a.z, n.y), vec4(a.yz, d.z, n.z), vec4(n, plane.w + 0.5 * slack));
    for (uint i = 0u; i < 4u; i++) {
        if (!(rest[i][i] > 0.0)) {
            return false;
        }
        for (uint j = i + 1u; j < 4u; j++) {
            rest[j] -= rest[i] * (rest[i][j] / rest[i][i]);
        }
    }
    return true;
}

// Takes a surface off the list that changes nothing beside the one that it is joined with: as a capsule's ball within its tube.
void leave_out_implied(float deviations, inout uint entries) {
    for (uint i = 1u; i < entries;) {
        uint operators = listed_operators(i);
        uint count = operator_count(operators);
        if (operator_count(listed_operators(i - 1u)) > 0u || count == 0u) {
            i++;
            continue;
        }
        UnitSurface below = entry_of(written_record, i - 1u);
        UnitSurface top = entry_of(written_record, i);
        bool top_implies = implies(top, below, deviations);
        if (!top_implies && !implies(below, top, deviations)) {
            i++;
            continue;
        }
        uint ors = operators >> OPERATOR_SHIFT;
        if (top_implies != is_or(operators, 0u)) {
            write_entry(i - 1u, top, 0u);
        }
        list_operators(i - 1u, count - 1u | (ors >> 1) << OPERATOR_SHIFT);
        entries--;
        for (uint j = i; j < entries; j++) {
            write_entry(j, entry_of(written_record, j + 1u), listed_operators(j + 1u));
        }
        i = max(i - 1u, 1u);
    }
}

// A region as one Gaussian sees it.
struct Rest {
    uint decided; // 0 or 1 where nothing or all is kept, whatever the pixel, else 2
    uint cutting; // how many surfaces cut the Gaussian
    uint entries; // how many of them are written; a mesh has several
    bool has_faces; // whether some are of a mesh
    uint depth; // how deep a stack of their answers may be
};

// Writes the surfaces that cut a Gaussian behind the header of `written_record`, those that come first where there is no room for all.
Rest write_reduced(Footprint f, vec3 position, float deviations, uint room) {
    uint first_part = gl_LocalInvocationIndex * PART_DEPTH;
    float last = 1e30;
    bool is_again = false;
    uint room_at_last = room;
    uint depth = 0u;
    Rest rest = Rest(2u, 0u, 0u, false, 0u);
    for (uint i = 0u; i <= surface_count(); i++) {
        if (i == surface_count()) {
            if (!MANY || rest.cutting <= room || is_again) {
                break;
            }
            // There are more than have room, so all is done again for the first.
            is_again = true;
            last = last_precedence(f, position, deviations, room_at_last);
            depth = 0u;
            rest.entries = 0u;
            rest.has_faces = false;
            i = 0u;
        }
        uint surface = surface_at(i);
        uint side = surface_gaussian_side(surface, f.axes, position, deviations);
        uint part = side == SIDE_VISIBLE ? 1u : 0u;
        bool is_written = false;
        if (MESHES && side == SIDE_CUTOFF && !is_again && surfaces.at[surface].kind == SURFACE_MESH) {
            MeshRest mesh = write_mesh(surface, f.axes, position, deviations, rest.entries, room);
            is_written = mesh.needed == 0u || rest.entries + mesh.needed <= room;
            part = mesh.needed == 0u ? (mesh.winding != 0.0 != mesh_keeps_outside(surface) ? 1u : 0u) : 2u + rest.entries;
            if (is_written) {
                rest.cutting += mesh.needed;
                rest.entries += mesh.needed;
                rest.has_faces = rest.has_faces || (mesh.needed > 0u && mesh.has_faces);
            } else {
                rest.cutting += mesh.needed - 1u;
            }
        }
        if (side == SIDE_CUTOFF && !is_written) {
            rest.cutting += is_again ? 0u : 1u;
            UnitSurface s = unit_surface(surface, f.axes, position);
            part = s.half_space.w >= 0.0 ? 1u : 0u;
            float here = precedence(s);
            bool counts = !is_again || here < last || (here == last && room_at_last > 0u);
            room_at_last -= is_again && here == last && room_at_last > 0u ? 1u : 0u;
            if (counts && rest.entries < room) {
                write_entry(rest.entries, s, 0u);
                part = 2u + rest.entries++;
            }
        }
        rest.depth = max(rest.depth, depth + 1u);
        push_part(part, operators_at(i), first_part, depth, rest.entries);
    }
    rest.decided = min(parts[first_part], 2u);
    if (SEVERAL && !rest.has_faces) {
        leave_out_implied(deviations, rest.entries);
    }
    for (uint i = 0u; i < rest.entries; i++) {
        if (MESHES && entry_kind(written_record, i) != 0.0) {
            continue;
        }
        UnitSurface s = entry_of(written_record, i);
        float size = max(largest(s.half_space.xyz), max(largest(s.diagonal), largest(s.across)));
        float inverse = size > 0.0 ? 1.0 / size : 1.0;
        write_entry(i, UnitSurface(s.half_space * inverse, s.diagonal * inverse, s.across * inverse), listed_operators(i));
    }
    return rest;
}

#endif
