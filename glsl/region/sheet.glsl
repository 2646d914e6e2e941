// A sheet of small faces near a Gaussian, as the quadric that fits it. Included after the buffer `cut_records` is declared.
#ifndef RARA_REGION_SHEET
#define RARA_REGION_SHEET
#include "region/crossing.glsl"
#include "region/faces.glsl"
#include "region/mesh.glsl"

// Many small faces that are one sheet near a Gaussian are the quadric that fits them, if no pixel's alpha changes by more than half of
// this, but where a line of sight goes along the sheet. The sheet is sampled along its nearest face's normal in rows and columns so many
// deviations apart, and along the edges of so many faces. Of one that is farther than SHEET_FARTHEST, samples tell too little.
const float SHEET_ERROR = 5e-3;
const float SHEET_STEP = 1.2;
const int SHEET_ROWS = 2;
const int SHEET_ACROSS = 2 * SHEET_ROWS + 1;
const float SHEET_RADIUS = 3.0;
const float SHEET_DEPTH = 4.0;
const float SHEET_FARTHEST = 2.0;
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
    if (abs(nearest.w) > SHEET_FARTHEST) {
        return false;
    }
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
        // Where its edges come nearest, and as far from there as the rows are apart.
        for (uint i = 0u; i < 9u; i++) {
            vec3 from = i < 3u ? unit.a : i < 6u ? unit.b : unit.c;
            vec3 along = (i < 3u ? unit.b : i < 6u ? unit.c : unit.a) - from;
            float square = max(dot(along, along), 1e-30);
            float place = -dot(from, along) / square + (float(i % 3u) - 1.0) * SHEET_STEP * inversesqrt(square);
            vec3 u = from + clamp(place, 0.0, 1.0) * along;
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

#endif
