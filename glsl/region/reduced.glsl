// A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided. Included
// after the buffer `cut_records` is declared. Twin: src/reference/region/reduced.rs.
#ifndef RARA_REGION_REDUCED
#define RARA_REGION_REDUCED
#include "cut.glsl"
#include "footprint.glsl"
#include "region/faces.glsl"
#include "region/gaussian_side.glsl"

#define HAS_PARTS COMBINED
#include "region/parts.glsl"

// The place of the record that is written.
uint written_record;

uint listed_operators(uint entry) {
    return operators_of(written_record, entry);
}

void list_operators(uint entry, uint operators) {
    cut_records.at[written_record + CUT_HEADER + ENTRY_VECTORS * entry + 1u].w = float(operators);
}

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

void write_entry(uint entry, UnitSurface s, uint operators) {
    uint at = written_record + CUT_HEADER + ENTRY_VECTORS * entry;
    cut_records.at[at] = s.half_space;
    cut_records.at[at + 1u] = vec4(s.diagonal, float(operators));
    cut_records.at[at + 2u] = vec4(s.across, 0.0);
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

// The most planes as which a mesh is written. They take what is known of planes, and what they keep is that to the bit.
const uint MESH_PLANES = 4u;
// Faces are in a plane if they are no farther from it, deviations.
const float MESH_FLAT = 1e-3;
// How much farther than the Gaussian its faces are looked for, deviations: lines across it reach there.
const float MESH_BEYOND = 1.0;

// After so many faces that no plane holds, the nearest of them counts for the nearest of all.
const uint MESH_SEEN = 64u;

// What a mesh is to a Gaussian.
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

// Many small faces that are one sheet near a Gaussian are the quadric that fits them, if no pixel's alpha changes by more than this times
// 100. The sheet is sampled along its nearest face's normal in rows and columns so many deviations apart, and at the corners of so
// many faces.
const float SHEET_ERROR = 5e-3;
const float SHEET_STEP = 1.2;
const int SHEET_ROWS = 2;
const int SHEET_ACROSS = 2 * SHEET_ROWS + 1;
const float SHEET_RADIUS = 3.0;
const float SHEET_DEPTH = 4.0;
const uint SHEET_CROSSINGS = 4u;
const uint SHEET_FACES = 256u;
// The terms of a quadric's height, and the equations that they solve.
const uint SHEET_TERMS = 6u;

struct Sheet {
    vec3 normal, right, up;
    float terms[SHEET_TERMS]; // of 1, s, t, s^2, s t and t^2
};

float sheet_term(uint term, vec2 at) {
    return term == 0u ? 1.0 : term == 1u ? at.x : term == 2u ? at.y : term == 3u ? at.x * at.x : term == 4u ? at.x * at.y : at.y * at.y;
}

float sheet_height(Sheet sheet, vec2 at) {
    float height = 0.0;
    for (uint term = 0u; term < SHEET_TERMS; term++) {
        height += sheet.terms[term] * sheet_term(term, at);
    }
    return height;
}

// How much a height that is wrong by `off` matters at a place.
bool sheet_fits(float off, float square) {
    return abs(off) * exp(-0.5 * square) < SHEET_ERROR;
}

// The quadric of a sheet; false where the faces near a Gaussian are no such sheet.
bool fitted_sheet(Faces faces, MeshTree tree, MeshBall ball, float deviations, vec4 nearest, out UnitSurface surface) {
    Sheet sheet;
    sheet.normal = nearest.xyz;
    sheet.right = perpendicular(sheet.normal);
    sheet.up = cross(sheet.normal, sheet.right);
    float heights[SHEET_ACROSS * SHEET_ACROSS];
    float equations[SHEET_TERMS * (SHEET_TERMS + 1u)];
    for (uint i = 0u; i < SHEET_TERMS * (SHEET_TERMS + 1u); i++) {
        equations[i] = 0.0;
    }
    for (int place = 0; place < SHEET_ACROSS * SHEET_ACROSS; place++) {
        vec2 at = SHEET_STEP * vec2(place % SHEET_ACROSS - SHEET_ROWS, place / SHEET_ACROSS - SHEET_ROWS);
        float square = dot(at, at);
        heights[place] = SHEET_DEPTH;
        if (square > SHEET_RADIUS * SHEET_RADIUS) {
            continue;
        }
        vec3 start = at.x * sheet.right + at.y * sheet.up - SHEET_DEPTH * sheet.normal;
        FaceLine line = face_line(faces.map * start, faces.map * sheet.normal);
        float second = SHEET_DEPTH;
        float grows = 0.0;
        float t = 0.0;
        for (uint i = 0u; i < SHEET_CROSSINGS && t < 2.0 * SHEET_DEPTH; i++) {
            Ahead ahead = looked_ahead(faces, line, t);
            t = ahead.t;
            float height = t - SHEET_DEPTH;
            if (abs(height) < abs(heights[place])) {
                second = heights[place];
                heights[place] = height;
                grows = ahead.grows;
            } else if (abs(height) < abs(second)) {
                second = height;
            }
        }
        float first = heights[place];
        // Another sheet there, or the wrong side of this one.
        if (!sheet_fits(1.0, square + second * second) || (!sheet_fits(1.0, square + first * first) && grows > 0.0 == faces.keeps_outside)) {
            return false;
        }
        float weight = exp(-0.5 * (square + first * first));
        for (uint i = 0u; i < SHEET_TERMS; i++) {
            float term = weight * sheet_term(i, at);
            for (uint k = 0u; k < SHEET_TERMS; k++) {
                equations[i * (SHEET_TERMS + 1u) + k] += term * sheet_term(k, at);
            }
            equations[i * (SHEET_TERMS + 1u) + SHEET_TERMS] += term * first;
        }
    }
    for (uint i = 0u; i < SHEET_TERMS; i++) {
        float pivot = equations[i * (SHEET_TERMS + 1u) + i];
        if (!(pivot > 1e-7)) {
            return false;
        }
        for (uint row = 0u; row < SHEET_TERMS; row++) {
            float factor = row == i ? 0.0 : equations[row * (SHEET_TERMS + 1u) + i] / pivot;
            for (uint k = i; k <= SHEET_TERMS; k++) {
                equations[row * (SHEET_TERMS + 1u) + k] -= factor * equations[i * (SHEET_TERMS + 1u) + k];
            }
        }
    }
    for (uint i = 0u; i < SHEET_TERMS; i++) {
        sheet.terms[i] = equations[i * (SHEET_TERMS + 1u) + SHEET_TERMS] / equations[i * (SHEET_TERMS + 1u) + i];
    }
    for (int place = 0; place < SHEET_ACROSS * SHEET_ACROSS; place++) {
        vec2 at = SHEET_STEP * vec2(place % SHEET_ACROSS - SHEET_ROWS, place / SHEET_ACROSS - SHEET_ROWS);
        float square = dot(at, at);
        float here = sheet_height(sheet, at);
        float off = here - heights[place];
        // Where there is no crossing the sheet has none either.
        float near = min(abs(here), abs(heights[place]));
        if (square <= SHEET_RADIUS * SHEET_RADIUS && !sheet_fits(off, square + near * near)) {
            return false;
        }
    }
    FaceSearch search = FaceSearch(0u, 0u);
    uint face;
    for (uint seen = 0u; seen < SHEET_FACES && next_face(tree, ball, deviations, search, face); seen++) {
        Face unit = unit_face(ball, mesh_face(tree, face));
        for (uint corner = 0u; corner < 3u; corner++) {
            vec3 u = corner == 0u ? unit.a : corner == 1u ? unit.b : unit.c;
            float off = dot(u, sheet.normal) - sheet_height(sheet, vec2(dot(u, sheet.right), dot(u, sheet.up)));
            if (!sheet_fits(off, dot(u, u))) {
                return false;
            }
        }
    }
    vec3 r = sheet.right;
    vec3 p = sheet.up;
    surface.half_space = vec4(sheet.normal - sheet.terms[1] * r - sheet.terms[2] * p, -sheet.terms[0]);
    surface.diagonal = -(sheet.terms[3] * r * r + sheet.terms[4] * r * p + sheet.terms[5] * p * p);
    surface.across = -(sheet.terms[3] * r.xxy * r.yzz + 0.5 * sheet.terms[4] * (r.xxy * p.yzz + r.yzz * p.xxy) + sheet.terms[5] * p.xxy * p.yzz);
    return true;
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
            UnitSurface sheet;
            if (!tree.overlaps && fitted_sheet(whole_mesh(surface, ball), tree, ball, deviations, nearest, sheet)) {
                rest.needed = 1u;
                if (first < room) {
                    write_entry(first, sheet, 0u);
                }
                return rest;
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
