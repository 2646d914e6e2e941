// The inside of a mesh of triangles, from a hierarchy of boxes over its faces (src/scene/mesh/packed.rs). Its own space is
// from -1 to 1; a surface takes points of the layer there. Twin: src/reference/region/inside.rs.
#ifndef RARA_REGION_MESH
#define RARA_REGION_MESH
#include "region/face_crossing.glsl"
#include "region/unit_surface.glsl"

BUFFER(readonly, MESHES_BINDING, uvec4, meshes)

// A mesh in its own space.
struct MeshTree {
    uint root; // its first quad
    uint nodes;
    uint faces; // the first quad of its faces
    bool overlaps; // they may cut each other
};

MeshTree mesh_tree(uint surface) {
    uint root = surfaces.at[surface].mesh;
    uvec4 head = meshes.at[root];
    return MeshTree(root + 1u, head.x, root + head.z, head.w != 0u);
}

bool mesh_keeps_outside(uint surface) {
    return surfaces.at[surface].keeps_outside != 0u;
}

// A vector of the layer in the mesh's space.
vec3 mesh_vector(uint surface, vec3 v) {
    return vec3(dot(surfaces.at[surface].anchor.xyz, v), dot(surfaces.at[surface].anchor_low.xyz, v), dot(surfaces.at[surface].diagonal.xyz, v));
}

vec3 mesh_point(uint surface, vec3 position) {
    return mesh_vector(surface, (position - surfaces.at[surface].high.xyz) - surfaces.at[surface].low.xyz);
}

mat3 mesh_axes(uint surface, mat3 axes) {
    return mat3(mesh_vector(surface, axes[0]), mesh_vector(surface, axes[1]), mesh_vector(surface, axes[2]));
}

// A node of the hierarchy. Where it is entered, its faces follow, and then the next node, else `skip`.
struct MeshNode {
    vec3 low, high;
    uint skip;
    uint first, count; // faces
};

MeshNode mesh_node(MeshTree tree, uint at) {
    uvec4 low = meshes.at[tree.root + 2u * at];
    uvec4 high = meshes.at[tree.root + 2u * at + 1u];
    return MeshNode(uintBitsToFloat(low.xyz), uintBitsToFloat(high.xyz), low.w, high.w >> 3, high.w & 7u);
}

Face mesh_face(MeshTree tree, uint face) {
    uint first = 9u * face;
    uint at = tree.faces + (first >> 2);
    return packed_face(first & 3u, uintBitsToFloat(meshes.at[at]), uintBitsToFloat(meshes.at[at + 1u]), uintBitsToFloat(meshes.at[at + 2u]));
}

// How often the mesh winds around a point of its space.
float mesh_winding(MeshTree tree, vec3 point) {
    FaceLine line = face_line(point, vec3(0.0, 0.0, 1.0));
    float winding = 0.0;
    for (uint at = 0u; at < tree.nodes;) {
        MeshNode node = mesh_node(tree, at);
        if (any(greaterThan(node.low.xy, point.xy)) || any(lessThan(node.high.xy, point.xy)) || node.high.z < point.z) {
            at = node.skip;
            continue;
        }
        for (uint i = 0u; i < node.count; i++) {
            float t;
            float grows = face_crossing(line, mesh_face(tree, node.first + i), t);
            winding -= t > 0.0 ? grows : 0.0;
        }
        at++;
    }
    return winding;
}

uint mesh_side(uint surface, bool is_inside) {
    return is_inside != mesh_keeps_outside(surface) ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

// 1 where the surface keeps a point, else -1.
float mesh_distance(uint surface, vec3 position) {
    bool is_inside = mesh_winding(mesh_tree(surface), mesh_point(surface, position)) != 0.0;
    return is_inside != mesh_keeps_outside(surface) ? 1.0 : -1.0;
}

// Rounding moves a place of the mesh's space by no more than this.
const float MESH_ROUNDING = 1e-6;

// All faces that come into a box.
bool mesh_touches_box(MeshTree tree, vec3 middle, vec3 reach) {
    vec3 low = middle - reach;
    vec3 high = middle + reach;
    for (uint at = 0u; at < tree.nodes;) {
        MeshNode node = mesh_node(tree, at);
        if (any(greaterThan(node.low, high)) || any(lessThan(node.high, low))) {
            at = node.skip;
            continue;
        }
        for (uint i = 0u; i < node.count; i++) {
            Face face = mesh_face(tree, node.first + i);
            vec3 face_low = min(min(face.a, face.b), face.c);
            vec3 face_high = max(max(face.a, face.b), face.c);
            if (any(greaterThan(face_low, high)) || any(lessThan(face_high, low))) {
                continue;
            }
            // The face's plane has to pass the box, too.
            vec3 normal = cross(face.b - face.a, face.c - face.a);
            if (abs(dot(normal, face.a - middle)) <= dot(abs(normal), reach)) {
                return true;
            }
        }
        at++;
    }
    return false;
}

uint mesh_box_side(uint surface, vec3 middle, vec3 half_size, float support) {
    vec3 reach = half_size + 1.0001 * support;
    vec3 x = abs(surfaces.at[surface].anchor.xyz);
    vec3 y = abs(surfaces.at[surface].anchor_low.xyz);
    vec3 z = abs(surfaces.at[surface].diagonal.xyz);
    MeshTree tree = mesh_tree(surface);
    vec3 point = mesh_point(surface, middle);
    vec3 there = 1.0001 * vec3(dot(x, reach), dot(y, reach), dot(z, reach)) + MESH_ROUNDING;
    if (mesh_touches_box(tree, point, there)) {
        return SIDE_CUTOFF;
    }
    return mesh_side(surface, mesh_winding(tree, point) != 0.0);
}

// A Gaussian in the mesh's space, which no axis leaves without thickness.
struct MeshBall {
    vec3 centre;
    mat3 axes;
    mat3 inverse; // rows: to the Gaussian's unit space
    float size; // its largest deviation
};

// The share of its largest deviation that a Gaussian is thick at least.
const float LEAST_THICKNESS = 1e-5;

MeshBall mesh_ball(uint surface, mat3 axes, vec3 position) {
    MeshBall ball;
    ball.centre = mesh_point(surface, position);
    ball.axes = mesh_axes(surface, axes);
    vec3 squares = vec3(dot(ball.axes[0], ball.axes[0]), dot(ball.axes[1], ball.axes[1]), dot(ball.axes[2], ball.axes[2]));
    ball.size = sqrt(max(max(squares.x, squares.y), squares.z));
    float least = LEAST_THICKNESS * ball.size;
    for (uint i = 0u; i < 3u; i++) {
        if (squares[i] < least * least) {
            // Axes are at right angles.
            vec3 direction = cross(ball.axes[(i + 1u) % 3u], ball.axes[(i + 2u) % 3u]);
            float n = dot(direction, direction);
            direction = n > 0.0 ? direction * inversesqrt(n) : vec3(i == 0u, i == 1u, i == 2u);
            ball.axes[i] = least * direction;
            squares[i] = max(least * least, 1e-30);
        }
    }
    ball.inverse = transpose(mat3(ball.axes[0] / squares.x, ball.axes[1] / squares.y, ball.axes[2] / squares.z));
    return ball;
}

// The square of how far a segment that begins at `from` is from the origin.
float edge_square(vec3 from, vec3 along) {
    float size = max(dot(along, along), 1e-30);
    float share = clamp(-dot(from, along) / size, 0.0, 1.0);
    vec3 end = share > 0.0 ? from + along : from;
    // Where a segment goes far, its nearest place has no digits, but the distance of that has.
    vec3 aside = cross(from, along);
    return share > 0.0 && share < 1.0 ? dot(aside, aside) / size : dot(end, end);
}

// The square of how far a face is from the origin.
float face_square(vec3 a, vec3 b, vec3 c) {
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    vec3 normal = cross(ab, bc);
    float least = min(min(edge_square(a, ab), edge_square(b, bc)), edge_square(c, ca));
    // The origin is over the face if it is on the inner side of each edge.
    bool is_over = dot(cross(normal, ab), a) <= 0.0 && dot(cross(normal, bc), b) <= 0.0 && dot(cross(normal, ca), c) <= 0.0;
    float height = dot(normal, a);
    float square = dot(normal, normal);
    return is_over && square > 0.0 ? min(least, height * height / square) : least;
}

// True where the ball of so many deviations may reach into a node.
bool ball_enters(MeshBall ball, MeshNode node, vec3 reach, float deviations) {
    vec3 half_size = 0.5 * (node.high - node.low);
    vec3 from = 0.5 * (node.high + node.low) - ball.centre;
    if (any(greaterThan(abs(from), half_size + reach))) {
        return false;
    }
    // The same as seen from the ball's axes.
    mat3 sizes = mat3(abs(ball.inverse[0]), abs(ball.inverse[1]), abs(ball.inverse[2]));
    vec3 beyond = max(abs(ball.inverse * from) - 1.0001 * (sizes * half_size), vec3(0.0));
    return dot(beyond, beyond) <= 1.0001 * deviations * deviations;
}

vec3 ball_reach(MeshBall ball, float deviations) {
    vec3 squares = ball.axes[0] * ball.axes[0] + ball.axes[1] * ball.axes[1] + ball.axes[2] * ball.axes[2];
    return 1.0001 * deviations * sqrt(squares) + MESH_ROUNDING;
}

// A face in the Gaussian's unit space.
Face unit_face(MeshBall ball, Face face) {
    return Face(ball.inverse * (face.a - ball.centre), ball.inverse * (face.b - ball.centre), ball.inverse * (face.c - ball.centre));
}

// The next face that comes into a ball, from a place on: a node, and how many of its faces were seen. Returns false behind the last one.
struct FaceSearch {
    uint node;
    uint seen;
};

bool next_face(MeshTree tree, MeshBall ball, float deviations, inout FaceSearch search, out uint face) {
    vec3 reach = ball_reach(ball, deviations);
    while (search.node < tree.nodes) {
        MeshNode node = mesh_node(tree, search.node);
        if (search.seen == 0u && !ball_enters(ball, node, reach, deviations)) {
            search.node = node.skip;
            continue;
        }
        while (search.seen < node.count) {
            face = node.first + search.seen++;
            Face unit = unit_face(ball, mesh_face(tree, face));
            if (face_square(unit.a, unit.b, unit.c) <= 1.0001 * deviations * deviations) {
                return true;
            }
        }
        search = FaceSearch(search.node + 1u, 0u);
    }
    return false;
}

uint mesh_gaussian_side(uint surface, mat3 axes, vec3 position, float deviations) {
    MeshTree tree = mesh_tree(surface);
    MeshBall ball = mesh_ball(surface, axes, position);
    FaceSearch search = FaceSearch(0u, 0u);
    uint face;
    if (next_face(tree, ball, deviations, search, face)) {
        return SIDE_CUTOFF;
    }
    return mesh_side(surface, mesh_winding(tree, ball.centre) != 0.0);
}

// The half-space of a face's plane in the Gaussian's unit space, which keeps what the surface keeps there. Its normal's length is
// 1, so that its distance is in deviations.
vec4 face_half_space(MeshBall ball, Face face, bool keeps_outside) {
    vec3 normal = cross(face.b - face.a, face.c - face.a);
    // The place is found before it is scaled: thin Gaussians would leave it no digits.
    vec3 seen = normal * ball.axes;
    float inverse = 1.0 / max(length(seen), 1e-30);
    float distance = dot(normal, ball.centre - face.a);
    return (keeps_outside ? inverse : -inverse) * vec4(seen, distance);
}

// The plane of the face that is nearest to a Gaussian's centre, among those of its ball.
UnitSurface mesh_unit_surface(uint surface, mat3 axes, vec3 position) {
    MeshTree tree = mesh_tree(surface);
    MeshBall ball = mesh_ball(surface, axes, position);
    float deviations = 8.0;
    FaceSearch search = FaceSearch(0u, 0u);
    uint face;
    float least = 1e30;
    vec4 half_space = vec4(0.0, 0.0, 0.0, mesh_distance(surface, position));
    while (next_face(tree, ball, deviations, search, face)) {
        Face here = mesh_face(tree, face);
        Face unit = unit_face(ball, here);
        float square = face_square(unit.a, unit.b, unit.c);
        if (square < least) {
            least = square;
            half_space = face_half_space(ball, here, mesh_keeps_outside(surface));
        }
    }
    return UnitSurface(half_space, vec3(0.0), vec3(0.0));
}

vec4 mesh_half_space(uint surface, mat3 axes, vec3 position) {
    return mesh_unit_surface(surface, axes, position).half_space;
}

#endif
