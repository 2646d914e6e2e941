// Meshes in a combined record (cut.glsl): a group of entries for each surface that is a mesh. The first entry has the map from the
// Gaussian's unit space to that of the faces, and the number of entries behind it. Where few faces are near, each has an entry, its corners
// in an even space about the Gaussian's centre, in which its largest deviation is 1; the first entry then also has how often the mesh winds
// around the centre. Else lines walk the mesh's hierarchy, which lies behind all records: the second entry has the centre in the mesh's
// space and, with the first one, where the hierarchy begins, and the third one has the plane of the face nearest to the centre. Included
// after the buffer `cut_records` is declared. Twin: src/reference/region/inside.rs.
#ifndef RARA_REGION_FACES
#define RARA_REGION_FACES
#include "region/entry.glsl"
#include "region/face_crossing.glsl"

// An entry's last number: 0 for a surface by itself, else one of these, or a group's first entry's, which is a sum of the others below.
const float ENTRY_FACE = 64.0;
const float ENTRY_PLACE = 65.0; // a walked mesh's centre
const float ENTRY_PLANE = 66.0; // and the plane of its nearest face
const uint GROUP = 1u;
const uint GROUP_KEEPS_OUTSIDE = 2u;
const uint GROUP_OVERLAPS = 4u; // its faces may cut each other
const uint GROUP_WALKED = 8u; // lines walk its hierarchy
// The entries of a mesh whose hierarchy is walked.
const uint WALKED_ENTRIES = 3u;
// Where a hierarchy begins takes two numbers, so that each is exact.
const uint ROOT_SHIFT = 16u;

float entry_kind(uint base, uint entry) {
    return cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * entry + 2u].w;
}

bool is_group(uint base, uint entry) {
    float kind = entry_kind(base, entry);
    return kind > 0.0 && kind < ENTRY_FACE;
}

// A group of entries.
struct Faces {
    mat3 map; // to the space of the faces
    uint first, count; // the entries behind the first one
    float winding; // around the centre, where they are faces
    bool keeps_outside;
    bool overlaps;
    bool is_walked;
    uint root; // of the hierarchy
    vec3 centre; // in its space
};

Faces faces_of(uint base, uint entry) {
    uint at = base + CUT_HEADER + ENTRY_VECTORS * entry;
    vec4 x = cut_records.at[at];
    vec4 y = cut_records.at[at + 1u];
    vec4 z = cut_records.at[at + 2u];
    uint kind = to_uint(z.w);
    Faces faces;
    faces.map = mat3(x.xyz, y.xyz, z.xyz);
    faces.first = entry + 1u;
    faces.count = to_uint(x.w);
    faces.winding = y.w;
    faces.keeps_outside = (kind & GROUP_KEEPS_OUTSIDE) != 0u;
    faces.overlaps = (kind & GROUP_OVERLAPS) != 0u;
    faces.is_walked = (kind & GROUP_WALKED) != 0u;
    vec4 place = faces.is_walked ? cut_records.at[at + ENTRY_VECTORS] : vec4(0.0);
    faces.root = faces.is_walked ? to_uint(place.w) << ROOT_SHIFT | to_uint(y.w) : 0u;
    faces.centre = place.xyz;
    return faces;
}

Face face_of(uint base, uint entry) {
    uint at = base + CUT_HEADER + ENTRY_VECTORS * entry;
    return Face(cut_records.at[at].xyz, cut_records.at[at + 1u].xyz, cut_records.at[at + 2u].xyz);
}

// The plane of a face in the unit space.
UnitSurface face_plane(uint base, uint entry, mat3 map) {
    Face face = face_of(base, entry);
    vec3 normal = cross(face.b - face.a, face.c - face.a);
    return UnitSurface(vec4(normal * map, -dot(normal, face.a)), vec3(0.0), vec3(0.0));
}

// The surface that an entry is to first order, or nothing where another entry has it. The map is that of the group before.
UnitSurface seen_surface(uint base, uint entry, inout mat3 map) {
    float kind = entry_kind(base, entry);
    if (kind == ENTRY_FACE) {
        return face_plane(base, entry, map);
    }
    if (is_group(base, entry)) {
        map = faces_of(base, entry).map;
    }
    return kind == 0.0 || kind == ENTRY_PLANE ? entry_of(base, entry) : UnitSurface(vec4(0.0), vec3(0.0), vec3(0.0));
}

// The map from the faces' space to the unit space.
mat3 to_unit(Faces faces) {
    // The columns of the other way's map are at right angles.
    vec3 squares = vec3(dot(faces.map[0], faces.map[0]), dot(faces.map[1], faces.map[1]), dot(faces.map[2], faces.map[2]));
    return transpose(mat3(faces.map[0] / squares.x, faces.map[1] / squares.y, faces.map[2] / squares.z));
}

// A node of the hierarchy, its box about the centre. Where it is entered, its faces come next and then the node behind it, else `skip`.
struct WalkedNode {
    vec3 low, high;
    uint skip;
    uint first, count; // faces
};

WalkedNode walked_node(Faces faces, uint at) {
    vec4 low = cut_records.at[faces.root + 1u + 2u * at];
    vec4 high = cut_records.at[faces.root + 2u + 2u * at];
    uint leaf = floatBitsToUint(high.w);
    return WalkedNode(low.xyz - faces.centre, high.xyz - faces.centre, floatBitsToUint(low.w), leaf >> 3, leaf & 7u);
}

// The faces of a group that come into a tile: a bit each in two runs of 64 faces, the first face of each in `first`; or no list.
struct TileFaces {
    uvec2 one, other;
    uvec2 first;
    vec3 known; // where it is known how often the mesh winds around it, in the unit space
    float winding;
};

TileFaces no_tile_faces() {
    return TileFaces(uvec2(0u), uvec2(0u), uvec2(~0u), vec3(0.0), 0.0);
}

// A list that has no room for a face is none: its first run is behind all faces.
const uint NO_LIST = ~0u - 1u;

bool is_list(TileFaces list) {
    return list.first.x < NO_LIST;
}

uvec2 run_bit(uint place) {
    return place < 32u ? uvec2(1u << place, 0u) : uvec2(0u, 1u << (place - 32u));
}

void add_tile_face(inout TileFaces list, uint face) {
    list.first.x = list.first.x == ~0u ? face : list.first.x;
    uint place = face - list.first.x;
    if (place < 64u) {
        list.one |= run_bit(place);
        return;
    }
    list.first.y = list.first.y == ~0u ? face : list.first.y;
    place = face - list.first.y;
    list.other |= place < 64u ? run_bit(place) : uvec2(0u);
    list.first.x = place < 64u ? list.first.x : NO_LIST;
}

// Takes the first bit off a run that has one.
uint first_in(inout uvec2 run) {
    bool is_low = run.x != 0u;
    uint word = is_low ? run.x : run.y;
    run = is_low ? uvec2(word & word - 1u, run.y) : uvec2(0u, word & word - 1u);
    return uint(findLSB(word)) + (is_low ? 0u : 32u);
}

// Takes the first face off a list that is not empty.
uint first_of(inout TileFaces list) {
    return list.one != uvec2(0u) ? list.first.x + first_in(list.one) : list.first.y + first_in(list.other);
}

// A walk over a group: over its faces, over those of a list, or over those of the nodes that are entered.
struct FaceWalk {
    uint nodes;
    uint corners; // where those of the hierarchy begin
    uint node;
    uint face, left; // faces
    TileFaces list;
};

FaceWalk face_walk(Faces faces, TileFaces list) {
    uvec4 head = faces.is_walked ? floatBitsToUint(cut_records.at[faces.root]) : uvec4(0u);
    if (is_list(list)) {
        ivec2 counts = bitCount(list.one) + bitCount(list.other);
        return FaceWalk(0u, faces.root + head.z, 0u, 0u, uint(counts.x + counts.y), list);
    }
    return FaceWalk(head.x, faces.root + head.z, 0u, faces.first, faces.is_walked ? 0u : faces.count, list);
}

FaceWalk face_walk(Faces faces) {
    return face_walk(faces, no_tile_faces());
}

// True where the walk is at a node, which `enter` leaves.
bool is_at_node(FaceWalk walk) {
    return walk.left == 0u && walk.node < walk.nodes;
}

void enter(inout FaceWalk walk, WalkedNode node, bool enters) {
    walk.left = enters ? node.count : 0u;
    walk.face = node.first;
    walk.node = enters ? walk.node + 1u : node.skip;
}

// Takes the next face of a walk, in the space of the faces. Returns false behind the last one.
bool takes_face(uint base, Faces faces, inout FaceWalk walk, out Face face) {
    if (walk.left == 0u) {
        return false;
    }
    if (is_list(walk.list)) {
        walk.face = first_of(walk.list);
    }
    if (faces.is_walked) {
        uint first = 9u * walk.face;
        uint at = walk.corners + (first >> 2);
        face = packed_face(first & 3u, cut_records.at[at], cut_records.at[at + 1u], cut_records.at[at + 2u]);
        face = Face(face.a - faces.centre, face.b - faces.centre, face.c - faces.centre);
    } else {
        face = face_of(base, walk.face);
    }
    walk.face++;
    walk.left--;
    return true;
}

// The part of a mesh that a half-line meets: the nearest crossing, how the winding number grows there, and how often the mesh winds
// around where it begins.
struct Ahead {
    float t;
    float grows;
    float winding;
};

// How far rounding may move what is compared with a node's box, relatively.
const float WALK_ROUNDING = 1e-6;

// Walks the hierarchy of a group that has one for the part of a line behind `from`. Where faces do not cut each other, nothing behind
// the nearest crossing counts.
Ahead looked_ahead(Faces faces, FaceLine line, float from) {
    Ahead ahead = Ahead(1e30, 0.0, 0.0);
    for (FaceWalk walk = face_walk(faces);;) {
        while (is_at_node(walk)) {
            WalkedNode node = walked_node(faces, walk.node);
            vec3 low = turned_to_axis(node.low - line.origin, line.axis);
            vec3 high = turned_to_axis(node.high - line.origin, line.axis);
            vec2 near = line.slope * low.z;
            vec2 far = line.slope * high.z;
            vec2 ends = vec2(low.z, high.z) / line.speed;
            vec2 slack = WALK_ROUNDING * (max(abs(low.xy), abs(high.xy)) + max(abs(near), abs(far)));
            bool passes = all(lessThanEqual(low.xy - max(near, far), slack)) && all(greaterThanEqual(high.xy - min(near, far), -slack));
            bool counts = max(ends.x, ends.y) >= from && (faces.overlaps || min(ends.x, ends.y) <= ahead.t);
            enter(walk, node, passes && counts);
        }
        Face face;
        if (!takes_face(0u, faces, walk, face)) {
            return ahead;
        }
        float here;
        float grows = face_crossing(line, face, here);
        if (grows != 0.0 && here > from) {
            ahead.winding -= grows;
            ahead.grows = here < ahead.t ? grows : ahead.grows;
            ahead.t = min(ahead.t, here);
        }
    }
}

// True where the mesh is around the points just before what is ahead.
bool is_inside(Faces faces, Ahead ahead) {
    return faces.overlaps ? ahead.winding != 0.0 : ahead.grows < 0.0;
}

// How much more often the mesh winds around the points of a line at `to` than at `from`.
float winding_between(uint base, Faces faces, FaceLine line, float from, float to) {
    float grown = 0.0;
    for (uint i = 0u; i < faces.count; i++) {
        float here;
        float grows = face_crossing(line, face_of(base, faces.first + i), here);
        grown += here > min(from, to) && here <= max(from, to) ? grows : 0.0;
    }
    return from <= to ? grown : -grown;
}

// How often the mesh winds around a point, from what is between it and the centre.
float winding_at(uint base, Faces faces, vec3 at) {
    vec3 direction = faces.map * at;
    if (!(dot(direction, direction) > 0.0)) {
        return faces.winding;
    }
    return faces.winding + winding_between(base, faces, face_line(vec3(0.0), direction), 0.0, 1.0);
}

bool faces_keep(uint base, Faces faces, vec3 at) {
    if (faces.is_walked) {
        FaceLine line = face_line(faces.map * at, vec3(0.0, 0.0, 1.0));
        return is_inside(faces, looked_ahead(faces, line, 0.0)) != faces.keeps_outside;
    }
    return winding_at(base, faces, at) != 0.0 != faces.keeps_outside;
}

// True when the mesh keeps the points of a line just behind `t`; `next` becomes the next crossing if that is nearer. Where its faces do
// not cut each other, what is between two crossings follows from either of them: one that leaves the mesh comes from inside.
bool faces_keep(uint base, Faces faces, vec3 at, vec3 direction, float t, inout float next) {
    FaceLine line = face_line(faces.map * at, faces.map * direction);
    if (faces.is_walked) {
        Ahead ahead = looked_ahead(faces, line, t);
        next = min(next, ahead.t);
        return is_inside(faces, ahead) != faces.keeps_outside;
    }
    float before = -1e30;
    float behind = 1e30;
    float grows_before = 0.0;
    float grows_behind = 0.0;
    for (uint i = 0u; i < faces.count; i++) {
        float here;
        float grows = face_crossing(line, face_of(base, faces.first + i), here);
        if (grows == 0.0) {
            continue;
        }
        if (here > t && here < behind) {
            behind = here;
            grows_behind = grows;
        } else if (here <= t && here > before) {
            before = here;
            grows_before = grows;
        }
    }
    next = min(next, behind);
    bool is_held = grows_behind != 0.0 ? grows_behind < 0.0 : grows_before > 0.0;
    if (faces.overlaps || grows_behind == 0.0 && grows_before == 0.0) {
        float winding = winding_at(base, faces, at);
        // A line that crosses no face is as a whole where one of its points is.
        is_held = winding + (faces.overlaps ? winding_between(base, faces, line, 0.0, t) : 0.0) != 0.0;
    }
    return is_held != faces.keeps_outside;
}

#endif
