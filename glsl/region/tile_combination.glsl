// The side of a tile in a splat with a combined record, from the sides of its surfaces. Included by tile_side.glsl. Twin:
// src/reference/region/tile_combination.rs.
#ifndef RARA_REGION_TILE_COMBINATION
#define RARA_REGION_TILE_COMBINATION

// Faces are in a plane if they are no farther from it so far from the centre, deviations.
const float TILE_FLAT = 1e-3;
const float TILE_FLAT_REACH = 5.0;

// The points of a splat that count in any of a tile's pixels: as far as `deviations` along the middle pixel's line of sight from
// the mean given that pixel, and as far as `aside` from there in any direction.
struct TilePoints {
    vec3 mean;
    vec3 along; // one deviation along the line of sight
    float deviations;
    float aside;
};

TilePoints tile_points(TileSight tile, float deviations) {
    Sight s = tile.s;
    TilePoints points;
    points.mean = line_through(s).mean;
    points.along = s.c * inversesqrt(tile.det.x);
    points.deviations = deviations;
    // The mean is moves . delta / det, each bounded by itself.
    vec3 move_x = cross(s.b2, s.c) + s.low_pass * s.b1;
    vec3 move_y = cross(s.c, s.b1) + s.low_pass * s.b2;
    vec2 moves = vec2(length(move_x), length(move_y));
    vec2 b_most = vec2(length(s.b1), length(s.b2)) + tile.b_reach;
    vec2 moves_reach = b_most.yx * tile.c_reach + tile.c_length * tile.b_reach.yx + s.low_pass * tile.b_reach;
    float moved = dot(abs(s.delta), moves_reach) + dot(tile.delta_reach, moves + moves_reach)
        + length(points.mean) * max(tile.det.x - tile.det.y, tile.det.z - tile.det.x);
    // So is the deviation along a pixel's own line of sight. No deviation across it exceeds the root of `across`.
    float longest = inversesqrt(tile.det.y);
    float turned = tile.c_reach * longest + tile.c_length * (longest - inversesqrt(tile.det.z));
    float across = s.low_pass * (dot(b_most, b_most) + s.low_pass) / tile.det.y;
    points.aside = moved / tile.det.y + deviations * (turned + sqrt(across));
    return points;
}

// The side of the points that count in a surface. Its function is that of the plane that touches it in the middle pixel's mean,
// and what bends away from that plane.
uint surface_side(TileSight tile, TilePoints points, UnitSurface surface) {
    vec3 gradient = gradient_at(surface, points.mean);
    PlaneRange plane = plane_range(tile, vec4(gradient, value_at(surface, points.mean) - dot(gradient, points.mean)));
    vec3 bend = bent(surface, points.along);
    float away = points.deviations * (points.deviations * abs(dot(points.along, bend)) + 2.0 * points.aside * length(bend))
        + bend_norm(surface) * points.aside * points.aside;
    float reach = points.deviations * sqrt(plane.variance_most / tile.det.y) + away;
    // The comparisons are such that a bound that is no number settles nothing.
    return plane.low > reach * tile.det.z ? SIDE_VISIBLE : plane.high < -reach * tile.det.z ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#ifdef RARA_SUBGROUP

// The side of a tile; the record gets those of its surfaces.
uint combination_side(inout Record record, uint flags, vec2 delta, vec2 middle) {
    if ((flags & CUT_FRONT) != 0u) {
        return SIDE_CUTOFF; // only what is in front of the eye counts
    }
    TileSight tile = tile_sight(record, delta, middle);
    TilePoints points = tile_points(tile, TILE_MARGIN * (CLIP_MODE == MODE_RARA ? push.params.sigma : PHI_ONE));
    uint stack = 0u;
    record.sides = RecordSides(0u, 0u, no_tile_faces());
    for (uint i = 0u; i < flags >> CUT_COUNT_SHIFT; i++) {
        UnitSurface surface = entry_of(record_base(record), i);
        uint side = surface_side(tile, points, surface);
        uint answers = side == SIDE_VISIBLE ? 15u : 0u;
        uint bit = MANY && i >= SIDES_KNOWN ? 0u : 1u << i;
        record.sides.visible |= side == SIDE_VISIBLE ? bit : 0u;
        if (side == SIDE_CUTOFF) {
            bool is_first = record.sides.cutting == 0u;
            answers = is_first ? FIRST_KEEPS : SECOND_KEEPS;
            if (is_first) {
                record.surfaces.first = surface;
            } else {
                record.surfaces.second = surface;
            }
            record.sides.cutting |= bit;
        }
        stack = four_answered(stack, answers, operators_of(record_base(record), i));
    }
    uint answers = stack & 15u;
    if (answers == SECOND_KEEPS) {
        record.surfaces.first = record.surfaces.second;
        answers = FIRST_KEEPS;
    }
    bool are_known = !MANY || flags >> CUT_COUNT_SHIFT <= SIDES_KNOWN;
    record.surfaces.answers = are_known && bitCount(record.sides.cutting) <= 2 ? answers : 0u;
    // No operator drops what would be kept of less, so that the other combinations lie between.
    return (answers & 1u) != 0u ? SIDE_VISIBLE : (answers & 8u) == 0u ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif

// The box in which the points of a splat lie that count in a tile: from -1 to 1 after `map`, which takes points of the faces' space, and
// `middle`.
struct TileBox {
    mat3 map;
    vec3 middle;
};

TileBox tile_box(Faces faces, TilePoints points) {
    float size = length(points.along);
    vec3 x = size > 0.0 ? points.along / size : vec3(1.0, 0.0, 0.0);
    vec3 y = perpendicular(x);
    vec3 sizes = vec3(points.deviations * size + points.aside, points.aside, points.aside);
    mat3 map = transpose(mat3(x / sizes.x, y / sizes.y, cross(x, y) / sizes.z));
    return TileBox(map * to_unit(faces), map * points.mean);
}

// True where a face comes into the box: no plane of the box, of the face, or along an edge of both lies between them.
bool comes_into(TileBox box, Face face) {
    vec3 a = box.map * face.a - box.middle;
    vec3 b = box.map * face.b - box.middle;
    vec3 c = box.map * face.c - box.middle;
    vec3 low = min(min(a, b), c);
    vec3 high = max(max(a, b), c);
    vec3 far = max(-low, high);
    float slack = 1.0 + 1e-6 * max(max(far.x, far.y), far.z);
    vec3 normal = cross(b - a, c - a);
    // Bounds that are no numbers tell nothing.
    bool is_apart = any(greaterThan(low, vec3(slack))) || any(lessThan(high, vec3(-slack)))
        || abs(dot(normal, a)) > slack * dot(abs(normal), vec3(1.0));
    for (uint i = 0u; i < 3u; i++) {
        vec3 from = i == 0u ? a : i == 1u ? b : c;
        vec3 along = (i == 0u ? b : i == 1u ? c : a) - from;
        vec3 one = cross(from, along);
        vec3 other = cross(i == 0u ? c : i == 1u ? a : b, along);
        vec3 reach = slack * (abs(along.yzx) + abs(along.zxy));
        is_apart = is_apart || any(greaterThan(min(one, other), reach)) || any(lessThan(max(one, other), -reach));
    }
    return !is_apart;
}

// The plane of a face in the faces' space, where its numbers are exact; its values are deviations of the Gaussian.
vec4 kept_half(Faces faces, Face face) {
    vec3 normal = cross(face.b - face.a, face.c - face.a);
    return vec4(normal, -dot(normal, face.a)) * (faces.keeps_outside ? 1.0 : -1.0) / max(length(normal * faces.map), 1e-30);
}

bool are_one_plane(Faces faces, vec4 one, vec4 other) {
    return dot(one.xyz, other.xyz) > 0.0
        && length((one.xyz - other.xyz) * faces.map) * TILE_FLAT_REACH + abs(one.w - other.w) < TILE_FLAT;
}

UnitSurface seen_half(Faces faces, vec4 plane) {
    return UnitSurface(vec4(plane.xyz * faces.map, plane.w), vec3(0.0), vec3(0.0));
}

// The side of a tile in a splat that a mesh cuts and nothing else does: that of the mean, if no face comes near what counts. Where those
// that do lie in one plane, or in two that meet alike, the record gets these: what bounds a face there are other faces that come near.
uint faces_side(inout Record record, uint flags, TileSight tile) {
    uint base = record_base(record);
    uint count = flags >> CUT_COUNT_SHIFT;
    if (!is_group(base, 0u)) {
        return SIDE_CUTOFF;
    }
    Faces faces = faces_of(base, 0u);
    if (faces.count + 1u != count) {
        return SIDE_CUTOFF;
    }
    bool has_front = (flags & CUT_FRONT) != 0u;
    if (has_front) {
        // Where the eye is behind the mean, more than half of the splat is in front of it, and what counts is where it would be otherwise.
        ZRange front = z_range(tile, cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * count]);
        if (!(front.low >= 0.0)) {
            return SIDE_CUTOFF;
        }
    }
    TilePoints points = tile_points(tile, TILE_MARGIN * (CLIP_MODE == MODE_RARA ? push.params.sigma : PHI_ONE));
    // The mean that is nearest to the centre: a record knows nothing of what is far from that.
    Sight s = tile.s;
    s.delta = sign(s.delta) * max(abs(s.delta) - tile.delta_reach, vec2(0.0));
    vec3 nearest = line_through(s).mean;
    TileBox box = tile_box(faces, points);
    mat3 sizes = mat3(abs(box.map[0]), abs(box.map[1]), abs(box.map[2]));
    vec4 planes[2];
    uint plane_count = 0u;
    bool are_all_kept = true; // each face by the other plane
    bool are_all_dropped = true;
    for (uint turn = 0u; turn < 2u; turn++) {
        for (FaceWalk walk = face_walk(faces);;) {
            while (is_at_node(walk)) {
                WalkedNode node = walked_node(faces, walk.node);
                vec3 from = abs(box.map * (0.5 * (node.low + node.high)) - box.middle);
                vec3 reach = 1.0001 + 1.0001 * (sizes * (0.5 * (node.high - node.low)));
                enter(walk, node, !any(greaterThan(from, reach)));
            }
            Face face;
            if (!takes_face(base, faces, walk, face)) {
                break;
            }
            if (!comes_into(box, face)) {
                continue;
            }
#ifdef RARA_SUBGROUP
            if (has_front || faces.overlaps) {
                return SIDE_CUTOFF;
            }
            vec4 plane = kept_half(faces, face);
            uint own = 0u;
            while (own < min(plane_count, 2u) && !are_one_plane(faces, planes[own], plane)) {
                own++;
            }
            if (turn == 0u && faces.is_walked) {
                add_tile_face(record.sides.faces, walk.face - 1u);
            }
            if (own == plane_count && plane_count < 2u) {
                planes[plane_count] = plane;
            }
            plane_count = max(plane_count, own + 1u);
            if (turn == 1u) {
                vec4 other = planes[1u - own];
                vec3 values = vec3(dot(other.xyz, face.a), dot(other.xyz, face.b), dot(other.xyz, face.c)) + other.w;
                are_all_kept = are_all_kept && min(min(values.x, values.y), values.z) >= -TILE_FLAT;
                are_all_dropped = are_all_dropped && max(max(values.x, values.y), values.z) <= TILE_FLAT;
            }
#else
            return SIDE_CUTOFF;
#endif
        }
        if (plane_count == 0u) {
            return faces_keep(base, faces, nearest) ? SIDE_VISIBLE : SIDE_INVISIBLE;
        }
        turn += plane_count != 2u ? 1u : 0u;
    }
#ifdef RARA_SUBGROUP
    if (plane_count > 2u || !(are_all_kept || are_all_dropped)) {
        if (is_list(record.sides.faces)) {
            record.sides.faces.known = nearest;
            record.sides.faces.winding = faces_keep(base, faces, nearest) != faces.keeps_outside ? 1.0 : 0.0;
        }
    } else {
        record.surfaces.answers = plane_count == 1u ? FIRST_KEEPS : are_all_kept ? BOTH_KEEP : EITHER_KEEPS;
        record.surfaces.first = seen_half(faces, planes[0]);
        record.surfaces.second = seen_half(faces, planes[1]);
    }
#endif
    return SIDE_CUTOFF;
}

#endif
