// What the surfaces of a combined record keep of lines through a splat. Included after the buffer `cut_records` is declared. Twin:
// src/reference/region/lines.rs.
#ifndef RARA_REGION_LINES
#define RARA_REGION_LINES
#include "region/answers.glsl"
#include "region/crossing.glsl"
#include "region/faces.glsl"
#include "tail.glsl"

// The stretch of a line between a surface's crossings, and whether what is kept lies in it.
struct Stretch {
    float start, end;
    bool between;
};

Stretch stretch_of(UnitSurface surface, vec3 at, vec3 direction) {
    float value = value_at(surface, at);
    float slope = dot(gradient_at(surface, at), direction);
    float bend = bend_along(surface, direction);
    float square = slope * slope - 4.0 * bend * value;
    float sum = abs(slope) + sqrt(max(square, 0.0));
    if (square < 0.0 || !(sum > 0.0)) {
        return Stretch(-NO_CROSSING, NO_CROSSING, value >= 0.0);
    }
    sum = slope < 0.0 ? -sum : sum;
    float first = -2.0 * value / sum;
    float second = -sum / (2.0 * bend);
    if (!(abs(second) < FAR_AWAY)) {
        return slope < 0.0 ? Stretch(-NO_CROSSING, first, true) : Stretch(first, NO_CROSSING, true);
    }
    return Stretch(min(first, second), max(first, second), bend < 0.0);
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

// Surfaces whose stretches of a line are found once, where that is worth the memory: not on GPUs, whose registers it would take.
const uint KNOWN_STRETCHES = 8u;
#ifdef RARA_SUBGROUP
#define KEEPS_STRETCHES (!MESHES)
#else
#define KEEPS_STRETCHES false
#endif

// The measure of what the surfaces keep of a line from `start` to `end`, one stretch between crossings after the other.
float measured(uint base, uint count, vec3 at, vec3 direction, float start, float end, uint measure, float front) {
    float total = 0.0;
    float before = measure_to(measure, start, front);
    Stretch known[KNOWN_STRETCHES];
    for (uint i = 0u; KEEPS_STRETCHES && i < min(count, KNOWN_STRETCHES); i++) {
        known[i] = stretch_of(entry_of(base, i), at, direction);
    }
    for (float t = start; t < end;) {
        float next = end;
        uint stack = 0u;
        for (uint i = 0u; i < count; i++) {
            bool keeps;
            if (MESHES && is_group(base, i)) {
                Faces faces = faces_of(base, i);
                keeps = faces_keep(base, faces, at, direction, t, next);
                i += faces.count;
            } else {
                Stretch stretch;
                if (KEEPS_STRETCHES && i < KNOWN_STRETCHES) {
                    stretch = known[i];
                } else {
                    stretch = stretch_of(entry_of(base, i), at, direction);
                }
                next = stretch.start > t ? min(next, stretch.start) : next;
                next = stretch.end > t ? min(next, stretch.end) : next;
                // The side of what comes next on the line.
                keeps = (t >= stretch.start && t < stretch.end) == stretch.between;
            }
            stack = answered(stack, keeps, operators_of(base, i));
        }
        float here = measure_to(measure, next, front);
        total += (stack & 1u) != 0u ? here - before : 0.0;
        before = here;
        t = next;
    }
    return total;
}

// Lines at the points of a lattice stand for what varies across them. The lattice is turned, so that the edges in which surfaces meet
// do not run along its rows. Distances are in deviations.
const float LATTICE = 0.74;
const float LATTICE_RADIUS = 4.2;
const vec2 LATTICE_TURN = vec2(0.8506508, 0.5257311);
// Surfaces that turn away from their mean direction by less are seen by every second row and column, or by a single line.
const float TURNS_LITTLE = 0.1;
const float TURNS_NOT = 0.001;

// How wide a pixel's part of a splat is to how long it is. Below the first a single line of sight stands for all, below the second nine by
// a rule that is exact up to the fifth power of what varies across, below the third every second row and column of the lattice.
const float WIDTH_ONE = 0.002;
const float WIDTH_NINE = 0.01;
const float WIDTH_LINES = 0.05;
// The rule's places, and how its weights fall.
const float NINE_STEP = 1.7320508;
const float NINE_FALL = 0.4620981;

// The unit vector of this direction, or that along the line.
vec3 unit_of(vec3 v) {
    return dot(v, v) > 0.0 ? normalize(v) : vec3(1.0, 0.0, 0.0);
}

// The direction that all surfaces cross, as well as one can, among a line's deviations: a unit vector. It does not depend on the
// surfaces' order, and a region's complement has the same one, so that what both keep adds up to the whole.
vec3 direction_through(Line line, mat3 deviations, uint base, uint count) {
    vec3 nearest = vec3(0.0);
    vec3 sum;
    // The first turn finds the nearest surface, and the second one takes all in its direction.
    for (uint turn = 0u; turn < 2u; turn++) {
        sum = vec3(0.0);
        mat3 map;
        for (uint i = 0u; i < count; i++) {
            UnitSurface surface = MESHES ? seen_surface(base, i, map) : entry_of(base, i);
            vec3 a = gradient_at(surface, line.mean) * deviations;
            float square = max(dot(a, a), 1e-30);
            float value = value_at(surface, line.mean);
            a *= exp(-0.5 * min(value * value / square, 20.0)) * inversesqrt(square);
            nearest = turn == 0u && dot(a, a) > dot(nearest, nearest) ? a : nearest;
            sum += dot(a, nearest) < 0.0 ? -a : a;
        }
    }
    float first = sum.x != 0.0 ? sum.x : sum.y != 0.0 ? sum.y : sum.z;
    return unit_of(first < 0.0 ? -sum : sum);
}

// Crossings on lines of this direction move by no more than this for each deviation across it.
float turn_of(Line line, mat3 deviations, vec3 direction, uint base, uint count) {
    float most = 0.0;
    mat3 map;
    for (uint i = 0u; i < count; i++) {
        UnitSurface surface = MESHES ? seen_surface(base, i, map) : entry_of(base, i);
        if (MESHES && entry_kind(base, i) == ENTRY_PLACE) {
            return 1.0; // its faces may turn in any way
        }
        vec3 a = gradient_at(surface, line.mean) * deviations;
        float along = abs(dot(a, direction));
        float bend = 0.0;
        for (uint k = 0u; k < 3u; k++) {
            bend += (1.0 - direction[k] * direction[k]) * abs(bend_along(surface, deviations[k]));
        }
        most = max(most, (length(a - dot(a, direction) * direction) + bend) / max(along, 1e-30));
    }
    return most;
}

// The measure of what the surfaces keep of all lines of a direction among a line's deviations. `start` and `end` are counted from the mean.
// With a width these are lines of sight.
float measured_across(Line line, mat3 deviations, vec3 h, float width, uint base, uint count, float start, float end, uint measure, float front) {
    vec3 direction = deviations * h;
    vec3 g = perpendicular(h);
    vec3 first = deviations * g;
    vec3 second = deviations * cross(h, g);
    bool is_along = MESHES && width < WIDTH_LINES;
    float turn = measure == MEASURE_LENGTH || is_along ? 0.0 : turn_of(line, deviations, h, base, count);
    float step = turn < TURNS_LITTLE ? 2.0 * LATTICE : LATTICE;
    int rows = turn < TURNS_NOT ? 0 : int(LATTICE_RADIUS / step) + 1;
    float fall = 0.5;
    if (is_along) {
        bool are_nine = width < WIDTH_NINE;
        step = are_nine ? NINE_STEP : step;
        fall = are_nine ? NINE_FALL : fall;
        rows = width < WIDTH_ONE ? 0 : are_nine ? 1 : int(LATTICE_RADIUS / step) + 1;
    }
    float share = 0.0;
    float weights = 0.0;
    for (int row = -rows; row <= rows; row++) {
        for (int column = -rows; column <= rows; column++) {
            vec2 at = step * (float(row) * LATTICE_TURN + float(column) * vec2(-LATTICE_TURN.y, LATTICE_TURN.x));
            if (dot(at, at) > LATTICE_RADIUS * LATTICE_RADIUS) {
                continue;
            }
            float weight = exp(-fall * dot(at, at));
            weights += weight;
            share += weight * measured(base, count, line.mean + at.x * first + at.y * second, direction, start, end, measure, front);
        }
    }
    return share / weights;
}

#endif
