// The share of a splat that the surfaces of a record keep together, whatever they are and however they combine. Included after the buffer
// `cut_records` and the constants of weight_constants.glsl are declared. Twin: src/reference/region/combination.rs and crossing.rs.
#ifndef RARA_REGION_COMBINATION
#define RARA_REGION_COMBINATION
#include "region/answers.glsl"
#include "region/crossing.glsl"
#include "region/entry.glsl"
#include "region/face_mass.glsl"
#include "region/lines.glsl"
#include "region/share.glsl"

// True where pipelines for surfaces that bend weigh lists by the same code: CPU drivers compile half as long then. On GPUs that code would
// need a third more registers.
#ifdef RARA_SUBGROUP
#define LISTS_TOO COMBINED
#else
#define LISTS_TOO false
#endif

// The sides of a record's surfaces in all pixels that are looked at, a bit for each surface.
struct RecordSides {
    uint cutting;
    uint visible; // of those that do not cut
    TileFaces faces; // those of a mesh that cuts the splat alone
};

RecordSides all_cutting() {
    return RecordSides(~0u, 0u, no_tile_faces());
}

// Surfaces whose sides are known, one a bit. Any beyond count as cutting.
const uint SIDES_KNOWN = 32u;

bool is_cutting(RecordSides sides, uint i) {
    return (MANY && i >= SIDES_KNOWN) || (sides.cutting >> i & 1u) != 0u;
}

// Where at most two surfaces of a record cut a tile: these, and for each combination of their sides whether the region keeps that,
// a bit each; 0 where it is not known.
struct TileSurfaces {
    UnitSurface first, second;
    uint answers;
};
// The combinations in which one of two surfaces is on its kept side: where the region keeps these, the other does not matter.
const uint FIRST_KEEPS = 0xau;
const uint BOTH_KEEP = 8u;
const uint EITHER_KEEPS = 14u;
const uint SECOND_KEEPS = 0xcu;

// Gauss and Hermite's nodes and weights for a normal variable: the middle one and three on either side.
const vec4 BEND_NODE = vec4(0.0, 1.1544054, 2.3667594, 3.7504397);
const vec4 BEND_WEIGHT = vec4(0.45714286, 0.24012318, 0.030757124, 5.4826886e-4);

// The share that two crossings leave.
float share_of_two(float z, float other, bool between) {
    float near = phi(z);
    return between ? max(near - phi(-other), 0.0) : min(near + phi(other), 1.0);
}

// The chance that at + slope t + bend t^2 is positive for a normal t.
float interval_share(float at, float slope, float bend) {
    float square = slope * slope - 4.0 * bend * at;
    float sum = abs(slope) + sqrt(max(square, 0.0));
    if (square < 0.0 || !(sum > 0.0)) {
        return at >= 0.0 ? 1.0 : 0.0;
    }
    float z = 2.0 * at / sum;
    float other = -sum / (2.0 * bend);
    return abs(other) < 8.0 ? share_of_two(z, other, bend < 0.0) : phi(z);
}

// The share of a surface that bends across the direction in which it varies most.
float bent_share(Line line, UnitSurface surface) {
    float size = length(line.s.c);
    if (!(size > 0.0)) {
        return value_at(surface, line.mean) >= 0.0 ? 1.0 : 0.0;
    }
    vec3 direction = line.s.c / size;
    vec3 gradient = gradient_at(surface, line.mean);
    float slope = dot(gradient, direction);
    vec3 aside = spread(line, gradient) - direction * slope;
    float lateral = sqrt(max(dot(gradient, aside), 0.0));
    if (lateral > 1e-6 * length(gradient)) {
        aside /= lateral;
    } else {
        vec3 widest = dot(line.s.b1, line.s.b1) < dot(line.s.b2, line.s.b2) ? line.s.b1 : line.s.b2;
        aside = spread(line, widest) - direction * dot(widest, direction);
        aside *= inversesqrt(max(dot(widest, aside), 1e-30));
    }
    float a = bend_along(surface, direction);
    float e = 2.0 * dot(direction, bent(surface, aside));
    float g = bend_along(surface, aside);
    float value = value_at(surface, line.mean) + trace_of(line, surface) - a - g;
    bool by_line = slope * slope + 2.0 * a * a >= lateral * lateral + 2.0 * g * g;
    vec4 terms = by_line ? vec4(slope, a, lateral, g) : vec4(lateral, g, slope, a); // steep, bend, flat, its bend
    float share = 0.0;
    for (int i = -3; i <= 3; i++) {
        float x = sign(float(i)) * BEND_NODE[abs(i)];
        share += BEND_WEIGHT[abs(i)] * interval_share(value + x * (terms.z + x * terms.w), terms.x + e * x, terms.y);
    }
    return share;
}

// The answers of a region for eight combinations of sides, a byte on a stack of eight.
uvec2 bytes_answered(uvec2 stack, uint answers, uint operators) {
    stack = uvec2(stack.x << 8 | answers, stack.y << 8 | stack.x >> 24);
    for (uint i = 0u; i < operator_count(operators); i++) {
        uvec2 below = uvec2(stack.x >> 8 | stack.y << 24, stack.y >> 8);
        uint top = stack.x & 0xffu;
        stack = uvec2(is_or(operators, i) ? below.x | top : below.x & (top | ~0xffu), below.y);
    }
    return stack;
}

// The combinations of three crossings in which each is on its kept side.
const uint SIDE_PATTERN[3] = uint[](0xaau, 0xccu, 0xf0u);

float bit_of(uint answers, uint sides) {
    return float(answers >> sides & 1u);
}

// The chance of the combinations of three sides that the region keeps, from the chances that each is the kept one, that the first
// two are, the first and the third, the last two, and all three.
float share_of_answers(uint answers, float p, float q, float r, vec3 pairs, float all) {
    return bit_of(answers, 7u) * all + bit_of(answers, 3u) * (pairs.x - all) + bit_of(answers, 5u) * (pairs.y - all)
        + bit_of(answers, 6u) * (pairs.z - all) + bit_of(answers, 1u) * (p - pairs.x - pairs.y + all)
        + bit_of(answers, 2u) * (q - pairs.x - pairs.z + all) + bit_of(answers, 4u) * (r - pairs.y - pairs.z + all)
        + bit_of(answers, 0u) * (1.0 - p - q - r + pairs.x + pairs.y + pairs.z - all);
}

// The share of a single surface that bends little by mode `exact`, from its crossing.
float share_of_crossing(Crossed crossing) {
    if (crossing.at.other != NO_CROSSING) {
        return share_of_two(crossing.at.z, crossing.at.other, crossing.at.between);
    }
    return abs(crossing.at.z) < PHI_ONE ? phi(crossing.at.z) : crossing.at.z > 0.0 ? 1.0 : 0.0;
}

// Where a plane of a list is crossed.
Crossed crossed_plane(Line line, vec4 half_space) {
    bool far;
    Crossed crossing;
    crossing.at.z = beam_z(line.s, line.det, half_space, far);
    crossing.at.other = NO_CROSSING;
    crossing.gradient = half_space.xyz;
    return crossing;
}

// The share by mode `exact`, by the sides of at most three open crossings. `open` is how many there are, and more than three where a
// surface that bends much is one of several. The surfaces of a list are planes, all of which keep together.
float share_of_sides(Line line, uint base, uint count, bool is_list, RecordSides sides, out uint open) {
    open = 0u;
    if (!SEVERAL) {
        UnitSurface surface = entry_of(base, 0u);
        float moved;
        Crossed crossing = crossed(line, surface, moved);
        return is_bent(crossing, moved) ? bent_share(line, surface) : share_of_crossing(crossing);
    }
    uint bent = count;
    uvec2 stack = uvec2(0u);
    Threshold t0;
    Threshold t1;
    Threshold t2;
    for (uint i = 0u; i < count; i++) {
        uint operators = is_list ? min(i, 1u) : operators_of(base, i); // of a list one `and` for each but the first
        Crossed crossing;
        if (is_list) {
            crossing = crossed_plane(line, plane_of(base, i));
        } else if (!is_cutting(sides, i)) {
            stack = bytes_answered(stack, (sides.visible >> i & 1u) != 0u ? 0xffu : 0u, operators);
            continue;
        } else {
            float moved;
            crossing = crossed(line, entry_of(base, i), moved);
            if (count == 1u && moved == 0.0) {
                return share_of_crossing(crossing);
            }
            if (is_bent(crossing, moved)) {
                stack = bytes_answered(stack, SIDE_PATTERN[0], operators);
                bent = i;
                open++;
                continue;
            }
        }
        uint pattern = 0u;
        for (uint side = 0u; side < (crossing.at.other == NO_CROSSING ? 1u : 2u); side++) {
            float z = side == 0u ? crossing.at.z : crossing.at.other;
            uint here = z > 0.0 ? 0xffu : 0u;
            if (abs(z) < PHI_ONE) {
                vec3 a = side == 0u ? crossing.gradient : crossing.other_gradient;
                Threshold t = Threshold(z, direction(line.s, a));
                if (open == 0u) {
                    t0 = t;
                } else if (open == 1u) {
                    t1 = t;
                } else {
                    t2 = t;
                }
                here = SIDE_PATTERN[min(open, 2u)];
                open++;
            }
            pattern = side == 0u ? here : crossing.at.between ? pattern & here : pattern | here;
        }
        stack = bytes_answered(stack, pattern, operators);
    }
    uint answers = stack.x & 0xffu;
    if (bent < count && open > 1u) {
        open = 4u;
    }
    if (open == 0u || open > 3u) {
        return bit_of(answers, 0u);
    }
    float p = bent < count ? bent_share(line, entry_of(base, bent)) : phi(t0.z);
    float q = 0.0;
    float r = 0.0;
    vec3 pairs = vec3(0.0); // of the first two, of the first and the third, of the last two
    float all = 0.0;
    if (open == 2u) {
        q = phi(t1.z);
        pairs.x = both_positive(t0, t1);
    } else if (open == 3u) {
        q = phi(t1.z);
        r = phi(t2.z);
        all = three_positive(t0, t1, t2, pairs);
    }
    return share_of_answers(answers, p, q, r, pairs, all);
}

// The share by mode `exact` that a tile's surfaces keep together. False where one of two is crossed twice, or bends much.
bool share_of_tile_surfaces(Line line, TileSurfaces surfaces, out float share) {
    float moved;
    Crossed first = crossed(line, surfaces.first, moved);
    if (!SEVERAL || surfaces.answers == FIRST_KEEPS) {
        share = share_of_crossing(first);
        return moved == 0.0;
    }
    bool bends = is_bent(first, moved);
    Crossed second = crossed(line, surfaces.second, moved);
    bends = bends || is_bent(second, moved);
    vec2 z = vec2(first.at.z, second.at.z);
    bvec2 open = lessThan(abs(z), vec2(PHI_ONE));
    float p = open.x ? phi(z.x) : z.x > 0.0 ? 1.0 : 0.0;
    float q = open.y ? phi(z.y) : z.y > 0.0 ? 1.0 : 0.0;
    float both = p * q;
    if (all(open)) {
        Sight s = line.s;
        both = both_positive(Threshold(z.x, direction(s, first.gradient)), Threshold(z.y, direction(s, second.gradient)));
    }
    share = share_of_answers(surfaces.answers, p, q, 0.0, vec3(both, 0.0, 0.0), 0.0);
    return !bends && min(abs(first.at.other), abs(second.at.other)) >= PHI_ONE;
}

// True when the surfaces keep a point of the unit space.
bool combined_keeps(uint base, uint count, vec3 point) {
    uint stack = 0u;
    for (uint i = 0u; i < count; i++) {
        bool keeps;
        if (MESHES && is_group(base, i)) {
            Faces faces = faces_of(base, i);
            keeps = faces_keep(base, faces, point);
            i += faces.count;
        } else {
            keeps = value_at(entry_of(base, i), point) >= 0.0;
        }
        stack = answered(stack, keeps, operators_of(base, i));
    }
    return (stack & 1u) != 0u;
}

// The share of a splat that a record's surfaces keep, by the frame's mode: in mode `rara` that of the chord (the paper, section 3.4),
// else that of the splat. Of a list it is what all planes keep of the splat.
float combined_weight(Sight s, uint base, uint flags, RecordSides sides, float sigma) {
    uint count = flags >> CUT_COUNT_SHIFT;
    bool is_chord = CLIP_MODE == MODE_RARA;
    s.low_pass = is_chord ? 0.0 : s.low_pass;
    Line line = line_through(s);
    vec4 front = vec4(0.0);
    bool has_front = (flags & CUT_FRONT) != 0u;
    if (has_front) {
        front = cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * count];
    }
    float start = -PHI_ONE;
    float end = PHI_ONE;
    uint measure = MEASURE_MASS;
    float whole = 1.0;
    float front_z = 0.0;
    if (is_chord) {
        bool is_line = dot(s.c, s.c) > 0.0;
        vec3 peak = is_line ? line.mean : vec3(0.0);
        float square = is_line ? sigma * sigma - dot(peak, peak) : -1.0;
        end = sqrt(max(square, 0.0));
        start = -end;
        if (is_line && has_front) {
            float slope = max(dot(front.xyz, direction_of(line)), 1e-30);
            start = max(start, -(front.w + dot(front.xyz, peak)) / slope);
        }
        whole = end - start;
        measure = MEASURE_LENGTH;
        if (!(square > 0.0) || !(whole > 0.0)) {
            return MISS == MISS_KEEP ? 1.0 : MISS == MISS_DROP ? 0.0 : combined_keeps(base, count, peak) ? 1.0 : 0.0;
        }
    } else if (has_front) {
        bool far;
        front_z = beam_z(s, line.det, front, far);
        start = -front_z;
        end = NO_CROSSING;
        measure = MEASURE_FRONT;
    } else if (!MESHES || (flags & CUT_FACES) != CUT_FACES) {
        bool is_list = LISTS_TOO && (flags & CUT_COMBINED) == 0u;
        uint open;
        float share = share_of_sides(line, base, count, is_list, sides, open);
        if (open <= 3u) {
            return clamp(share, 0.0, 1.0);
        }
        if (SEVERAL && is_list) {
            return polytope_weight(s, base, count);
        }
    }
    // Most pixels do not come here. All lines of the direction begin on the half-space in front of the eye, where that counts.
    mat3 back;
    mat3 deviations = deviations_of(line, back);
    float width = 1.0;
    if (MESHES && (flags & CUT_FACES) == CUT_FACES && !is_chord) {
        vec3 squares = vec3(dot(deviations[0], deviations[0]), dot(deviations[1], deviations[1]), dot(deviations[2], deviations[2]));
        width = sqrt(max(squares.y, squares.z) / max(squares.x, 1e-30));
        if (measure == MEASURE_MASS && width > WIDTH_ONE && is_group(base, 0u)) {
            Faces faces = faces_of(base, 0u);
            if (faces.count + 1u == count && !faces.overlaps) {
                return faces_share(base, faces, sides.faces, line.mean, deviations, back);
            }
        }
    }
    vec3 h = is_chord || width < WIDTH_LINES ? vec3(1.0, 0.0, 0.0)
        : has_front ? unit_of(front.xyz * deviations)
        : direction_through(line, deviations, base, count);
    return clamp(measured_across(line, deviations, h, is_chord ? 0.0 : width, base, count, start, end, measure, front_z) / whole, 0.0, 1.0);
}

#endif
