// The side of a tile in a splat with a combined record, from the sides of its surfaces. Included by tile_side.glsl. Twin:
// src/reference/region/tile_combination.rs.
#ifndef RARA_REGION_TILE_COMBINATION
#define RARA_REGION_TILE_COMBINATION

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
    record.sides = RecordSides(0u, 0u);
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

// The side of a tile in a splat that a mesh cuts and nothing else does: that of the mean, if no face comes near what counts.
uint faces_side(uint base, uint flags, TileSight tile) {
    uint count = flags >> CUT_COUNT_SHIFT;
    if (!is_group(base, 0u)) {
        return SIDE_CUTOFF;
    }
    Faces faces = faces_of(base, 0u);
    if (faces.count + 1u != count) {
        return SIDE_CUTOFF;
    }
    if ((flags & CUT_FRONT) != 0u) {
        // Where the eye is behind the mean, more than half of the splat is in front of it, and what counts is where it would be otherwise.
        ZRange front = z_range(tile, cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * count]);
        if (!(front.low >= 0.0)) {
            return SIDE_CUTOFF;
        }
    }
    TilePoints points = tile_points(tile, TILE_MARGIN * (CLIP_MODE == MODE_RARA ? push.params.sigma : PHI_ONE));
    vec3 middle = faces.map * points.mean;
    vec3 along = points.deviations * (faces.map * points.along);
    mat3 rows = transpose(faces.map);
    vec3 reach = abs(along) + points.aside * vec3(length(rows[0]), length(rows[1]), length(rows[2]));
    for (FaceWalk walk = face_walk(faces);;) {
        while (is_at_node(walk)) {
            WalkedNode node = walked_node(faces, walk.node);
            vec3 from = abs(0.5 * (node.low + node.high) - middle);
            enter(walk, node, all(lessThanEqual(from, reach + 0.5 * (node.high - node.low))));
        }
        Face here;
        if (!takes_face(base, faces, walk, here)) {
            break;
        }
        vec3 low = min(min(here.a, here.b), here.c) - middle;
        vec3 high = max(max(here.a, here.b), here.c) - middle;
        vec3 normal = cross(here.b - here.a, here.c - here.a);
        float across = abs(dot(normal, along)) + points.aside * length(normal * faces.map);
        bool is_far = any(greaterThan(low, reach)) || any(lessThan(high, -reach)) || abs(dot(normal, here.a - middle)) > 1.0001 * across;
        // A bound that is no number settles nothing.
        if (!is_far) {
            return SIDE_CUTOFF;
        }
    }
    return faces_keep(base, faces, points.mean) ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

#endif
