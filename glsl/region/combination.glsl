// The share of a splat that the surfaces of a combined record keep together, whatever they are and however they combine.
// Included after the buffer `cut_records` and the constants of weight_constants.glsl are declared. Twin:
// src/reference/region/combination.rs and crossing.rs.
#ifndef RARA_REGION_COMBINATION
#define RARA_REGION_COMBINATION
#include "region/answers.glsl"
#include "region/crossing.glsl"
#include "region/entry.glsl"
#include "orthant.glsl"
#include "tail.glsl"

// The sides of a record's surfaces in all pixels that are looked at, a bit for each surface.
struct RecordSides {
    uint cutting;
    uint visible; // of those that do not cut
};

RecordSides all_cutting() {
    return RecordSides(~0u, 0u);
}

// Where at most two surfaces of a record cut a tile: these, and for each combination of their sides whether the region keeps that,
// a bit each; 0 where it is not known.
struct TileSurfaces {
    UnitSurface first, second;
    uint answers;
};
// The combinations in which one of two surfaces is on its kept side: where the region keeps these, the other does not matter.
const uint FIRST_KEEPS = 0xau;
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

// The stretch of a line between a surface's crossings, counted from the mean, and whether what is kept lies in it.
struct Stretch {
    float start, end;
    bool between;
};

Stretch stretch_of(Line line, UnitSurface surface) {
    float moved;
    Crossed crossing = crossed(line, surface, moved);
    bool far = keeps_far(dot(crossing.gradient, line.s.c), crossing.gradient);
    float first = far ? -crossing.at.z : crossing.at.z;
    if (crossing.at.other == NO_CROSSING) {
        return far ? Stretch(first, NO_CROSSING, true) : Stretch(-NO_CROSSING, first, true);
    }
    float second = far ? crossing.at.other : -crossing.at.other;
    return Stretch(min(first, second), max(first, second), crossing.at.between);
}

// What a stretch of the line counts.
const uint MEASURE_MASS = 0u;
const uint MEASURE_LENGTH = 1u;
const uint MEASURE_FRONT = 2u;

float measure_to(uint measure, float t, float front) {
    if (measure == MEASURE_LENGTH) {
        return t;
    }
    if (measure == MEASURE_FRONT) {
        return t >= NO_CROSSING ? 1.0 : 1.0 - tail_ratio(-t, front);
    }
    return phi(t);
}

// The measure of what the surfaces keep of a line from `start` to `end`, one stretch between crossings after the other.
float measured(Line line, uint base, uint count, float start, float end, uint measure, float front) {
    float total = 0.0;
    float before = measure_to(measure, start, front);
    for (float t = start; t < end;) {
        float next = end;
        uint stack = 0u;
        for (uint i = 0u; i < count; i++) {
            Stretch stretch = stretch_of(line, entry_of(base, i));
            next = stretch.start > t ? min(next, stretch.start) : next;
            next = stretch.end > t ? min(next, stretch.end) : next;
            // The side of what comes next on the line.
            bool keeps = (t >= stretch.start && t < stretch.end) == stretch.between;
            stack = answered(stack, keeps, operators_of(base, i));
        }
        float here = measure_to(measure, next, front);
        total += (stack & 1u) != 0u ? here - before : 0.0;
        before = here;
        t = next;
    }
    return total;
}

// The share of the variance across a line that lines beside it stand for. They are at 0 and 1.5 deviations: Gauss and
// Hermite's nodes, for that share.
const float BY_NODES = 0.75;
const float BESIDE = 1.5;

// A vector's variance across a line, and the deviation that it has there.
float across(Line line, vec3 v, out vec3 deviation) {
    vec3 direction = direction_of(line);
    vec3 moved = spread(line, v) - direction * dot(direction, v);
    float variance = dot(v, moved);
    deviation = variance > 0.0 ? moved * inversesqrt(variance) : vec3(0.0);
    return variance > 0.0 ? variance : 1.0;
}

// The same of a line and of lines beside it, which stand for the variance across it.
float measured_widely(Line line, uint base, uint count, float start, float end, uint measure, float front) {
    bool is_wide = measure == MEASURE_MASS;
    vec3 p = dot(line.s.b1, line.s.b1) < dot(line.s.b2, line.s.b2) ? line.s.b2 : line.s.b1;
    p /= max(length(p), 1e-30);
    vec3 q = cross(direction_of(line), p);
    vec3 first;
    float variance = across(line, p, first);
    q -= p * (dot(q, first) * inversesqrt(variance));
    vec3 second;
    across(line, q, second);
    vec3 middle = line.mean;
    line.lateral = is_wide ? 1.0 - BY_NODES : 1.0;
    float share = 0.0;
    int nodes = is_wide ? 9 : 1;
    for (int node = 0; node < nodes; node++) {
        vec2 at = is_wide ? BESIDE * vec2(node / 3 - 1, node % 3 - 1) : vec2(0.0);
        line.mean = middle + at.x * first + at.y * second;
        float weight = (at.x == 0.0 ? 2.0 / 3.0 : 1.0 / 6.0) * (at.y == 0.0 ? 2.0 / 3.0 : 1.0 / 6.0);
        share += (is_wide ? weight : 1.0) * measured(line, base, count, start, end, measure, front);
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

// The share of a single surface by mode `exact`, from its crossing.
float share_of_surface(Line line, UnitSurface surface, Crossed crossing, float moved) {
    if (moved > 0.0) {
        return bent_share(line, surface);
    }
    if (crossing.at.other != NO_CROSSING) {
        return share_of_two(crossing.at.z, crossing.at.other, crossing.at.between);
    }
    return abs(crossing.at.z) < PHI_ONE ? phi(crossing.at.z) : crossing.at.z > 0.0 ? 1.0 : 0.0;
}

// The share by mode `exact`, by the sides of at most three open crossings. `open` is how many there are.
float share_of_sides(Line line, uint base, uint count, RecordSides sides, out uint open) {
    open = 0u;
    uvec2 stack = uvec2(0u);
    Threshold t0;
    Threshold t1;
    Threshold t2;
    for (uint i = 0u; i < count; i++) {
        if ((sides.cutting >> i & 1u) == 0u) {
            stack = bytes_answered(stack, (sides.visible >> i & 1u) != 0u ? 0xffu : 0u, operators_of(base, i));
            continue;
        }
        UnitSurface surface = entry_of(base, i);
        float moved;
        Crossed crossing = crossed(line, surface, moved);
        if (count == 1u) {
            return share_of_surface(line, surface, crossing, moved);
        }
        uint pattern = 0u;
        for (uint side = 0u; side < (crossing.at.other == NO_CROSSING ? 1u : 2u); side++) {
            float z = side == 0u ? crossing.at.z : crossing.at.other;
            uint here = z > 0.0 ? 0xffu : 0u;
            if (abs(z) < PHI_ONE) {
                vec3 a = side == 0u ? crossing.gradient : crossing.other_gradient;
                Threshold t = Threshold(z, keeps_far(dot(a, line.s.c), a), direction(line.s, a));
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
        stack = bytes_answered(stack, pattern, operators_of(base, i));
    }
    uint answers = stack.x & 0xffu;
    if (open == 0u || open > 3u) {
        return bit_of(answers, 0u);
    }
    float p = phi(t0.z);
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

// The share by mode `exact` that a tile's surfaces keep together. False where one of two is crossed twice.
bool share_of_tile_surfaces(Line line, TileSurfaces surfaces, out float share) {
    float moved;
    Crossed first = crossed(line, surfaces.first, moved);
    if (surfaces.answers == FIRST_KEEPS) {
        share = share_of_surface(line, surfaces.first, first, moved);
        return true;
    }
    Crossed second = crossed(line, surfaces.second, moved);
    vec2 z = vec2(first.at.z, second.at.z);
    bvec2 open = lessThan(abs(z), vec2(PHI_ONE));
    float p = open.x ? phi(z.x) : z.x > 0.0 ? 1.0 : 0.0;
    float q = open.y ? phi(z.y) : z.y > 0.0 ? 1.0 : 0.0;
    float both = p * q;
    if (all(open)) {
        vec3 a = first.gradient;
        vec3 b = second.gradient;
        Sight s = line.s;
        both = both_positive(Threshold(z.x, keeps_far(dot(a, s.c), a), direction(s, a)),
                             Threshold(z.y, keeps_far(dot(b, s.c), b), direction(s, b)));
    }
    share = share_of_answers(surfaces.answers, p, q, 0.0, vec3(both, 0.0, 0.0), 0.0);
    return min(abs(first.at.other), abs(second.at.other)) >= PHI_ONE;
}

// True when the surfaces keep a point of the unit space.
bool combined_keeps(uint base, uint count, vec3 point) {
    uint stack = 0u;
    for (uint i = 0u; i < count; i++) {
        stack = answered(stack, value_at(entry_of(base, i), point) >= 0.0, operators_of(base, i));
    }
    return (stack & 1u) != 0u;
}

// The weight of a splat with a combined record, by the frame's mode: in mode `rara` the share of the chord that is kept (the
// paper, section 3.4), else the share of the splat.
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
    float start = -NO_CROSSING;
    float end = NO_CROSSING;
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
        measure = MEASURE_FRONT;
    } else {
        uint open;
        float share = share_of_sides(line, base, count, sides, open);
        if (open <= 3u) {
            return clamp(share, 0.0, 1.0);
        }
    }
    return clamp(measured_widely(line, base, count, start, end, measure, front_z) / whole, 0.0, 1.0);
}

#endif
