// The share of a normal distribution that lies within a closed mesh, as a sum over its faces. Seen from the mean, a face hides a cone; what
// lies behind the face in it is 1/(4 pi) of the integral, over the face's solid angle, of the part of the distribution that is farther away
// than the face. A mesh's faces together hide what is outside of it, if the mean is inside, and else, less that, what is inside. So the
// sum is the share but for its whole part, and faces that are far away do not count.
//
// In the space where the distribution has deviations of 1 and mean 0, a face at the distance p has an integral that goes around its
// edges: that of 1 - p/r - 2 p (e(p) - e(r)) over the angle about the foot of the mean on its plane, where r is the distance of the
// edge, and e(r) = (Phi(r) - 1/2)/r is smooth. The first two terms give the solid angle, which is known (Van Oosterom and Strackee 1983);
// the rest changes so little that four points on an edge suffice to 1e-4. Twin: src/reference/region/face_mass.rs.
#ifndef RARA_REGION_FACE_MASS
#define RARA_REGION_FACE_MASS
#include "region/faces.glsl"
#include "phi.glsl"

// Beyond so many deviations nothing counts.
const float MASS_REACH = 4.5;
// An edge's points are chosen as if it were seen from this far, by half the tangent of half the angle.
const float EDGE_REACH = 2.0;
// Gauss and Legendre's two points, for short edges, and four with their weights; the others are the same on the other side.
const float EDGE_SHORT = 1.5;
const float EDGE_POINT = 0.5773503;
const vec2 EDGE_POINTS = vec2(0.3399810, 0.8611363);
const vec2 EDGE_WEIGHTS = vec2(0.6521452, 0.3478548);

float excess(float square) {
    float r = sqrt(square);
    return square < 1e-4 ? 0.3989423 * (1.0 - square / 6.0) : (phi(r) - 0.5) / r;
}

// The integral over an edge of what a face's solid angle is too large by. `a` and `b` are its ends from the foot.
float edge_mass(vec3 a, vec3 b, vec3 normal, float p) {
    vec3 along = b - a;
    float size = length(along);
    if (!(size > 0.0)) {
        return 0.0;
    }
    along /= size;
    float start = dot(a, along);
    float aside = dot(cross(a, along), normal);
    float reach = sqrt(aside * aside + EDGE_REACH * EDGE_REACH);
    vec2 ends = vec2(start, start + size);
    ends /= reach + sqrt(reach * reach + ends * ends);
    float middle = 0.5 * (ends.x + ends.y);
    float half_size = 0.5 * (ends.y - ends.x);
    float nearest = excess(p * p);
    bool is_short = size < EDGE_SHORT;
    float sum = 0.0;
    for (uint i = 0u; i < (is_short ? 2u : 4u); i++) {
        float point = is_short ? EDGE_POINT : EDGE_POINTS[i >> 1];
        float weight = is_short ? 1.0 : EDGE_WEIGHTS[i >> 1];
        float at = middle + ((i & 1u) == 0u ? half_size : -half_size) * point;
        float rest = 1.0 / (1.0 - at * at);
        float along_edge = 2.0 * reach * at * rest;
        float square = aside * aside + along_edge * along_edge;
        sum += weight * (1.0 + at * at) * rest * rest * (nearest - excess(p * p + square)) / max(square, 1e-12);
    }
    return 4.0 * p * aside * reach * half_size * sum;
}

// The share of the distribution that a face hides; negative where its front is seen from the mean.
float face_mass(Face face) {
    vec3 low = min(min(face.a, face.b), face.c);
    vec3 high = max(max(face.a, face.b), face.c);
    if (any(greaterThan(low, vec3(MASS_REACH))) || any(lessThan(high, vec3(-MASS_REACH)))) {
        return 0.0;
    }
    vec3 normal = cross(face.b - face.a, face.c - face.a);
    float size = length(normal);
    normal /= max(size, 1e-30);
    float p = dot(normal, face.a);
    if (!(size > 0.0) || abs(p) > MASS_REACH) {
        return 0.0;
    }
    vec3 sizes = vec3(length(face.a), length(face.b), length(face.c));
    float below = sizes.x * sizes.y * sizes.z + dot(face.a, face.b) * sizes.z + dot(face.b, face.c) * sizes.x + dot(face.c, face.a) * sizes.y;
    float angle = 2.0 * atan(p * size, below);
    vec3 foot = p * normal;
    face.a -= foot;
    face.b -= foot;
    face.c -= foot;
    float rest = edge_mass(face.a, face.b, normal, p) + edge_mass(face.b, face.c, normal, p) + edge_mass(face.c, face.a, normal, p);
    return (angle - rest) * 0.07957747; // 1/(4 pi)
}

// A space in which a normal distribution has deviations of 1 and mean 0: the map there from that of the faces.
struct EvenSpace {
    mat3 map;
    vec3 mean;
};

// A vertex has no solid angle as seen from itself: the mean is this much aside of where it could be one.
const vec3 NUDGE = vec3(1.1e-5, -2.3e-5, 1.7e-5);

EvenSpace even_space(Faces faces, vec3 mean, mat3 deviations) {
    // The columns of the faces' map are at right angles.
    vec3 squares = vec3(dot(faces.map[0], faces.map[0]), dot(faces.map[1], faces.map[1]), dot(faces.map[2], faces.map[2]));
    mat3 to_unit = transpose(mat3(faces.map[0] / squares.x, faces.map[1] / squares.y, faces.map[2] / squares.z));
    mat3 from_unit = inverse(deviations);
    return EvenSpace(from_unit * to_unit, from_unit * mean + NUDGE);
}

Face in_space(EvenSpace space, Face face) {
    return Face(space.map * face.a - space.mean, space.map * face.b - space.mean, space.map * face.c - space.mean);
}

// Shares that are nearer to nothing or everything are told apart by points: a sum may be off by so much, and by so much for each face.
const float MASS_DOUBT = 2e-3;
const float MASS_DOUBT_FACE = 1e-4;

// True where a mesh keeps most of what is about a point, of which it keeps nearly all or hardly anything: two of three points say so. The
// point itself may lie in a needle or a gap.
bool faces_keep_most(uint base, Faces faces, vec3 mean, mat3 deviations) {
    bool first = faces_keep(base, faces, mean + deviations * vec3(0.61, 0.23, -0.44));
    bool second = faces_keep(base, faces, mean + deviations * vec3(-0.52, 0.47, 0.31));
    return first == second ? first : faces_keep(base, faces, mean + deviations * vec3(0.08, -0.71, 0.19));
}

// The share that a mesh keeps of a normal distribution about a point of the unit space, where its faces do not cut each other.
float faces_share(uint base, Faces faces, vec3 mean, mat3 deviations) {
    EvenSpace space = even_space(faces, mean, deviations);
    mat3 sizes = mat3(abs(space.map[0]), abs(space.map[1]), abs(space.map[2]));
    float sum = 0.0;
    float doubt = MASS_DOUBT;
    for (FaceWalk walk = face_walk(faces);;) {
        while (is_at_node(walk)) {
            WalkedNode node = walked_node(faces, walk.node);
            vec3 from = abs(space.map * (0.5 * (node.low + node.high)) - space.mean);
            vec3 beyond = max(from - sizes * (0.5 * (node.high - node.low)), vec3(0.0));
            enter(walk, node, dot(beyond, beyond) <= MASS_REACH * MASS_REACH);
        }
        Face face;
        if (!takes_face(base, faces, walk, face)) {
            break;
        }
        float mass = face_mass(in_space(space, face));
        sum += mass;
        doubt += mass == 0.0 ? 0.0 : MASS_DOUBT_FACE;
    }
    float share = fract(-sum);
    if (min(share, 1.0 - share) < doubt) {
        bool is_held = faces_keep_most(base, faces, mean, deviations) != faces.keeps_outside;
        share = is_held == share > 0.5 ? share : is_held ? 1.0 : 0.0;
    }
    return faces.keeps_outside ? 1.0 - share : share;
}

#endif
