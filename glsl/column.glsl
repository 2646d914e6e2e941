// The weights of a column of pixels in one cut splat, for the tile rasteriser: what glsl/weight.glsl computes a pixel at
// a time. Along a column a line of sight's gradients are linear in the row, so everything in z is a polynomial of degree
// two: exact, and for eight rows a fifth of the work.
#ifndef RARA_COLUMN
#define RARA_COLUMN
#include "weight.glsl"
#include "record.glsl"

// Rows count from the column's middle, so that the polynomials' terms stay small.
float row_place(uint row) {
    return float(row) - 0.5 * float(ROWS - 1u);
}

// c.x + c.y y + c.z y^2.
float quadratic(vec3 c, float y) {
    return c.x + y * (c.y + y * c.z);
}

// The product of two linear functions, each a vec2 of its value at 0 and its slope.
vec3 product(vec2 a, vec2 b) {
    return vec3(a.x * b.x, a.x * b.y + a.y * b.x, a.y * b.y);
}

// The scalar product of two linear vector functions.
vec3 product(vec3 a0, vec3 a1, vec3 b0, vec3 b1) {
    return vec3(dot(a0, b0), dot(a0, b1) + dot(a1, b0), dot(a1, b1));
}

// The shares of a column, whose pixels without alpha need none. False when all are whole. Less than Phi(-PHI_ONE) is
// nothing, so that tiles' lists may leave out what would add no more.
bool shares(float z[ROWS], float alpha[ROWS], out float share[ROWS]) {
    float low = 8.0;
    for (uint row = 0u; row < ROWS; row++) {
        low = min(low, alpha[row] > 0.0 ? z[row] : 8.0);
    }
    bool open = low <= PHI_ONE;
    for (uint row = 0u; row < ROWS; row++) {
        share[row] = 1.0;
    }
    if (open) {
        for (uint row = 0u; row < ROWS; row++) {
            share[row] = z[row] < -PHI_ONE ? 0.0 : phi(z[row]);
        }
    }
    return open;
}

// The weights of a splat that carries its curve, a polynomial of degree two in the pixel.
bool carried_weights(vec3 linear, vec3 curvature, vec2 delta, float alpha[ROWS], out float weight[ROWS]) {
    float at = linear.x + delta.x * (linear.y + curvature.x * delta.x);
    float slope = linear.z + curvature.y * delta.x;
    float z[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        float y = delta.y + float(row);
        z[row] = at + y * (slope + y * curvature.z);
    }
    return shares(z, alpha, weight);
}

// True when nothing of a column is visible. Outside reclipped frames the tiles' lists leave most such splats out.
bool is_carried_away(vec3 linear, vec3 curvature, vec2 delta) {
    float at = linear.x + delta.x * (linear.y + curvature.x * delta.x);
    float slope = linear.z + curvature.y * delta.x;
    float high = -8.0;
    for (uint row = 0u; row < ROWS; row++) {
        float y = delta.y + float(row);
        high = max(high, at + y * (slope + y * curvature.z));
    }
    return high < -PHI_ONE;
}

// The weights of a record that is a curve, a polynomial of degree four in the splat's own coordinates: u is the column's,
// v the first row's, and v changes by v_step a row.
bool curve_weights(Record record, float u, float v, float v_step, float alpha[ROWS], out float weight[ROWS]) {
    Section along = section(curve_of(RECORD_AT(record, 0), RECORD_AT(record, 1), RECORD_AT(record, 2), RECORD_AT(record, 3)), u);
    float z[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        z[row] = section_z(along, v + float(row) * v_step);
    }
    return shares(z, alpha, weight);
}

// The same of a record of a surface's terms.
void terms_weights(Record record, float u, float v, float v_step, out float weight[ROWS]) {
    TermCurves t = record_terms(record);
    Section value = section(t.value, u);
    Section variance = section(t.variance, u);
    Section bend = section(t.bend, u);
    for (uint row = 0u; row < ROWS; row++) {
        float w = v + float(row) * v_step;
        weight[row] = terms_share(Terms(section_z(value, w), section_z(variance, w), section_z(bend, w)));
    }
}

// The values that all planes of a splat share in a column: the line of sight in its middle, by how much b2 and c change
// a row, and the determinant, a polynomial in the row.
struct ColumnSight {
    Sight s;
    vec3 b2_step;
    vec3 c_step;
    vec2 delta_y;
    vec3 det;
};

// `delta` and `pixel_centre` are those of the first row.
ColumnSight column_sight(Record record, vec2 delta, vec2 pixel_centre) {
    vec2 middle = vec2(0.0, 0.5 * float(ROWS - 1u));
    delta += middle;
    pixel_centre += middle;
    ColumnSight column;
    Sight s = sight_through(RECORD_AT(record, 0), RECORD_AT(record, 1), RECORD_AT(record, 2), pixel_centre - principal_point(), delta);
    column.s = s;
    column.b2_step = -RECORD_AT(record, 2).xyz;
    column.c_step = cross(s.b1, column.b2_step);
    column.delta_y = vec2(s.delta.y, RECORD_AT(record, 1).w);
    vec3 c_step = column.c_step;
    column.det = product(s.c, c_step, s.c, c_step) + s.low_pass * product(s.b2, column.b2_step, s.b2, column.b2_step);
    column.det.x += s.low_pass * (dot(s.b1, s.b1) + s.low_pass);
    return column;
}

// A plane's z in each row: beam_z of glsl/sight.glsl.
void beam_zs(ColumnSight column, vec4 half_space, out float z[ROWS]) {
    Sight s = column.s;
    vec3 c_step = column.c_step;
    vec3 a = half_space.xyz;
    vec3 a1 = cross(a, s.b1);
    vec3 a2 = cross(a, s.b2);
    vec3 a2_step = cross(a, column.b2_step);
    vec2 along = vec2(dot(a, s.c), dot(a, c_step));
    vec3 variance = product(along, along) + s.low_pass * product(a2, a2_step, a2, a2_step);
    variance.x += s.low_pass * (dot(a1, a1) + s.low_pass * dot(a, a));
    vec3 kx = product(s.c, c_step, a2, a2_step);
    kx.x += s.low_pass * dot(a, s.b1);
    vec2 ky = s.low_pass * vec2(dot(a, s.b2), dot(a, column.b2_step)) - vec2(dot(s.c, a1), dot(c_step, a1));
    vec3 mean = half_space.w * column.det + s.delta.x * kx + product(column.delta_y, ky);
    for (uint row = 0u; row < ROWS; row++) {
        float y = row_place(row);
        float inverse = 1.0 / quadratic(column.det, y);
        z[row] = quadratic(mean, y) * inverse * inversesqrt(max(quadratic(variance, y) * inverse, 1e-30));
    }
}

// `exact` with the camera outside the splat. `delta` and `pixel_centre` are the first row's. `edges` are the pixels that see several
// planes, a bit each: their weights are not found here.
bool exact_weights(Record record, uint flags, vec2 delta, vec2 pixel_centre, float alpha[ROWS], out float weight[ROWS], inout uint edges) {
    ColumnSight column = column_sight(record, delta, pixel_centre);
    float z[ROWS];
    uint count = flags >> CUT_COUNT_SHIFT;
    if (!SEVERAL || count == 1u) {
        beam_zs(column, RECORD_AT(record, CUT_HEADER), z);
        return shares(z, alpha, weight);
    }
    if (count == 2u && RECORD_AT(record, CUT_HEADER).xyz == -plane_of(record_base(record), 1u).xyz) {
        // The planes bound a slab: both are thresholds in one variable.
        float other[ROWS];
        beam_zs(column, RECORD_AT(record, CUT_HEADER), z);
        shares(z, alpha, weight);
        beam_zs(column, plane_of(record_base(record), 1u), z);
        shares(z, alpha, other);
        for (uint row = 0u; row < ROWS; row++) {
            weight[row] = combined(flags, max(0.0, weight[row] - (1.0 - other[row])));
        }
        return true;
    }
    // The least z of each row, and how many planes leave it open.
    float least[ROWS];
    uint opens[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        least[row] = 8.0;
        opens[row] = 0u;
    }
    for (uint plane = 0u; plane < count; plane++) {
        beam_zs(column, plane_of(record_base(record), plane), z);
        for (uint row = 0u; row < ROWS; row++) {
            least[row] = min(least[row], z[row]);
            opens[row] += z[row] < PHI_ONE ? 1u : 0u;
        }
    }
    shares(least, alpha, weight);
    for (uint row = 0u; row < ROWS; row++) {
        weight[row] = combined(flags, weight[row]);
        edges |= opens[row] > 1u && least[row] > -PHI_ONE && alpha[row] > 0.0 ? 1u << row : 0u;
    }
    return true;
}

// `exact` with the camera inside the splat: front_weight of glsl/weight.glsl. `delta` and `pixel_centre` are the first
// row's.
void front_weights(Record record, uint flags, vec2 delta, vec2 pixel_centre, out float weight[ROWS]) {
    uint count = flags >> CUT_COUNT_SHIFT;
    ColumnSight column = column_sight(record, delta, pixel_centre);
    float front[ROWS];
    beam_zs(column, plane_of(record_base(record), count), front);
    float far[ROWS];
    float gone[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        far[row] = 1.0;
        gone[row] = 0.0;
    }
    for (uint plane = 0u; plane < count; plane++) {
        vec4 half_space = plane_of(record_base(record), plane);
        float z[ROWS];
        beam_zs(column, half_space, z);
        vec2 along = vec2(dot(half_space.xyz, column.s.c), dot(half_space.xyz, column.c_step));
        for (uint row = 0u; row < ROWS; row++) {
            bool keeps = keeps_far(along.x + row_place(row) * along.y, half_space.xyz);
            float share = tail_ratio(keeps ? z[row] : -z[row], front[row]);
            far[row] = keeps ? min(far[row], share) : far[row];
            gone[row] = keeps ? gone[row] : max(gone[row], share);
        }
    }
    for (uint row = 0u; row < ROWS; row++) {
        weight[row] = combined(flags, max(0.0, far[row] - gone[row]));
    }
}

// `rara` with the camera outside the splat: chord_weight of glsl/weight.glsl. `delta` and `pixel_centre` are the first
// row's.
void chord_weights(Record record, uint flags, vec2 delta, vec2 pixel_centre, out float weight[ROWS]) {
    uint count = flags >> CUT_COUNT_SHIFT;
    ColumnSight column = column_sight(record, delta, pixel_centre);
    Sight s = column.s;
    vec3 c_step = column.c_step;
    // |offset|^2 / |c|^2 is the square of the line's distance from the centre, offset x c / |c|^2 its nearest point.
    vec3 offset = s.delta.x * s.b2 - s.delta.y * s.b1;
    vec3 offset_step = s.delta.x * column.b2_step - column.delta_y.y * s.b1;
    vec3 cc = product(s.c, c_step, s.c, c_step);
    vec3 square = product(offset, offset_step, offset, offset_step);
    float sigma = push.params.sigma;
    float inverse[ROWS];
    float low[ROWS];
    float high[ROWS];
    float whole[ROWS];
    uint inside = (1u << ROWS) - 1u;
    for (uint row = 0u; row < ROWS; row++) {
        float y = row_place(row);
        float length_square = quadratic(cc, y);
        inverse[row] = length_square > 0.0 ? 1.0 / length_square : 0.0;
        float half_square = length_square > 0.0 ? sigma * sigma - quadratic(square, y) * inverse[row] : -1.0;
        high[row] = half_square > 0.0 ? sqrt(half_square) : 0.0;
        low[row] = -high[row];
        whole[row] = 2.0 * high[row];
    }
    for (uint plane = 0u; plane < count; plane++) {
        vec4 half_space = plane_of(record_base(record), plane);
        vec2 along = vec2(dot(half_space.xyz, s.c), dot(half_space.xyz, c_step));
        vec3 nearest = product(offset, offset_step, cross(s.c, half_space.xyz), cross(c_step, half_space.xyz));
        for (uint row = 0u; row < ROWS; row++) {
            float y = row_place(row);
            float value = half_space.w + quadratic(nearest, y) * inverse[row];
            float slope = (along.x + y * along.y) * sqrt(inverse[row]);
            if (!(whole[row] > 0.0) || slope == 0.0) {
                bool is_inside = value > 0.0 || (value == 0.0 && (flags & CUT_UNION) == 0u);
                inside &= is_inside ? ~0u : ~(1u << row);
            } else if (slope > 0.0) {
                low[row] = max(low[row], -value / slope);
            } else {
                high[row] = min(high[row], -value / slope);
            }
        }
    }
    for (uint row = 0u; row < ROWS; row++) {
        bool miss = !(whole[row] > 0.0);
        bool is_inside = (inside >> row & 1u) != 0u;
        float share = !is_inside ? 0.0 : miss ? 1.0 : max(0.0, high[row] - low[row]) / whole[row];
        weight[row] = !miss || MISS == MISS_PEAK ? combined(flags, share) : MISS == MISS_KEEP ? 1.0 : 0.0;
    }
}

// The weights of a combined record; false when all are whole. `rows` are the pixels whose weights are not found here, a bit each.
bool combined_weights(Record record, vec2 delta, vec2 pixel_centre, float alpha[ROWS], out float weight[ROWS], inout uint rows) {
    TileSurfaces surfaces = record_surfaces(record);
    if (surfaces.answers == FIRST_KEEPS && is_plane(surfaces.first)) {
        float z[ROWS];
        beam_zs(column_sight(record, delta, pixel_centre), surfaces.first.half_space, z);
        return shares(z, alpha, weight);
    }
    for (uint row = 0u; row < ROWS; row++) {
        weight[row] = 1.0;
        rows |= alpha[row] > 0.0 ? 1u << row : 0u;
    }
    return false;
}

// The weight of each pixel of a column; false when all are whole. `delta`, `uv` and `pixel_centre` are the first row's;
// v changes by `v_step` a row.
bool cut_weights(Record record, vec2 delta, vec2 uv, float v_step, vec2 pixel_centre, float alpha[ROWS],
                 out float weight[ROWS]) {
    uint flags = record_flags(record);
    bool open = true;
    uint rows = 0u; // that need all surfaces
    if (COMBINED && (flags & CUT_COMBINED) != 0u) {
        open = combined_weights(record, delta, pixel_centre, alpha, weight, rows);
    } else if (COMBINED && CLIP_MODE == MODE_EXACT && (flags & CUT_TERMS) != 0u) {
        terms_weights(record, uv.x, uv.y, v_step, weight);
    } else if (CLIP_MODE == MODE_EXACT && (flags & CUT_CURVE) != 0u) {
        open = curve_weights(record, uv.x, uv.y, v_step, alpha, weight);
    } else if (CLIP_MODE == MODE_EXACT && (flags & CUT_FRONT) != 0u) {
        front_weights(record, flags, delta, pixel_centre, weight);
    } else if (CLIP_MODE == MODE_EXACT) {
        open = exact_weights(record, flags, delta, pixel_centre, alpha, weight, rows);
    } else if ((flags & CUT_FRONT) == 0u) {
        chord_weights(record, flags, delta, pixel_centre, weight);
    } else {
        for (uint row = 0u; row < ROWS; row++) {
            vec2 below = vec2(0.0, float(row));
            weight[row] = chord_weight(record_base(record), flags, delta + below, pixel_centre + below);
        }
    }
    // A loop over all rows would be unrolled, with the body once for each.
    for (; (COMBINED || (SEVERAL && CLIP_MODE == MODE_EXACT)) && rows != 0u; rows &= rows - 1u) {
        uint at = uint(findLSB(rows));
        vec2 below = vec2(0.0, float(at));
        Sight s = sight_through(RECORD_AT(record, 0), RECORD_AT(record, 1), RECORD_AT(record, 2), pixel_centre + below - principal_point(), delta + below);
        // Where one or two surfaces cut the tile, all its pixels have them at hand.
        TileSurfaces surfaces = record_surfaces(record);
        float share;
        if (!COMBINED || surfaces.answers == 0u || !share_of_tile_surfaces(line_through(s), surfaces, share)) {
            share = surfaces_weight(s, record_base(record), flags, record_sides(record));
        }
        open = open || share < 1.0;
        for (uint row = 0u; row < ROWS; row++) {
            weight[row] = row == at ? share : weight[row];
        }
    }
    return open;
}

#endif
