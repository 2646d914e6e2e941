// Every struct that host and shaders share. build.rs turns each into a Rust struct of the same name (`rara::types`)
// and asserts its std430 offsets, so each stands here and nowhere else.
#ifndef RARA_TYPES
#define RARA_TYPES
#include "limits.glsl"

// The constants of a cut and of a frame: a struct for each reason to change. Whether a frame may take over what the one before has
// computed is decided by comparing whole structs (src/passes/work.rs), so that a constant belongs where its change has the
// same consequences as that of its neighbours.

// Sizes of the scene.
struct SceneData {
    uint gaussian_count; // Gaussians in the scene
    uint block_count; // blocks of Gaussians
    uint sh_coefficients; // coefficients a colour channel in the scene
    uint layer_count; // layers of the scene, at least one
};

// The values that all layers' regions share.
struct RegionData {
    uint mode; // MODE_*
    uint trace_all; // 1: every Gaussian in view is cutoff
    float sigma; // rara: the traced ellipsoid, standard deviations; else 0
    uint pad; // unused
};

// The values that are constant in a cut: what a clip keeps of a scene, whatever eye sees it.
struct CutData {
    SceneData scene; // the scene's sizes
    RegionData region; // what the layers' regions have in common
};

// The picture of an eye. Where the eye stands is in each layer's view, in the layer's own space.
struct ViewData {
    vec4 focal; // fx, fy, px, or px a unit of the scene in an orthographic view; cx, cy, px
    vec4 slope_bounds; // lowest and highest x/z, lowest and highest y/z at which the Jacobian is evaluated
    vec4 size; // width, height, px; reciprocals
    uint precise_view; // 1: positions in the camera's frame are computed in two floats
    uint sh_degree; // highest degree to evaluate
    uint projection; // PROJECTION_*
    float near_cut; // the depth from which centres are drawn, the scene's units
};

// The order of the splats.
struct OrderData {
    uint key_near; // bits of the least depth a centre can have
    uint key_span; // by how much the greatest depth's bits exceed them
    uint key_shift; // low bits of the difference that the sort does without
    uint sort_runs; // invocations of the sort by runs; 0 for the sort by partitions
    uint by_distance; // 1: keys are of the distances' squares, in place of depths
    uint pad[3]; // unused
};

// The tiles of the picture.
struct TilesData {
    uint tile_columns; // tiles across the picture
    uint tile_count; // tiles in the picture
    uint span_runs; // invocations that find the splats' spans of tiles; 0 for the bin by macro-tiles
    uint row_parts; // parts of the spans of a row of tiles
    float transmittance_min; // below it a tile's pixel is saturated: what lies behind changes it by less
    float alpha_max; // the most that a splat covers of a pixel
    float written_transmittance; // the splat with which a pixel's falls to this has the depth that is written; below 0: none is
    uint pad; // unused
};

// How much there is room for. No pixel depends on it.
struct RoomData {
    uint pair_capacity; // pairs of tile and splat that there is room for
    uint cell_side; // tiles along a side of the cells of coarse lists, which take the place of the tiles' lists without room
    uint pad[2]; // unused
};

// How what is cut is weighted.
struct WeightData {
    uint form; // FORM_*
    float beam_switch; // sigma_max / Z above which the perspective-exact form is used
    uint cut_stride; // vec4s of a cutoff record
    uint long_strides; // room for long records behind those of all Gaussians, each a cut_stride
    uint meshes; // where those of the region lie behind all records, in vec4s
    uint pad[3]; // unused
};

// The values that are constant for an eye in a frame.
struct EyeData {
    ViewData view; // the picture
    OrderData order; // the sort
    TilesData tiles; // the tiles
    RoomData room; // the room that there is
    WeightData weight; // the weights of what is cut
};

// The values that are constant in a frame.
struct FrameData {
    CutData cut; // the scene and what is kept of it
    EyeData eye; // the eye that sees it
};

// An eye as a layer sees it that is placed in the scene. The rows are the layer's rotation times its unit, so that what
// is computed in the camera's frame is in the scene's units, and what is computed before that is in the layer's own.
struct LayerView {
    vec4 rotation_x; // layer to camera, first row; w unused
    vec4 rotation_y; // second row
    vec4 rotation_z; // third row: the view direction
    vec4 rotation_low[3]; // what rounding the rows lost, for views of long focal length
    vec4 eye_high; // the eye, rounded to single precision; w unused
    vec4 eye_low; // what the rounding lost
    float unit; // units of the scene in one of the layer's
    uint pad[3]; // unused
};

// The region of a layer that is kept.
struct LayerRegion {
    uint op; // OP_*: how its surfaces combine
    uint first_surface; // its first one
    uint surface_count; // how many it has
    uint combined; // 1: splats are weighed as combinations of surfaces that may bend
};

// How a layer has moved since the frame before, as pixels see it. A point that is seen in pixel x, y at depth z was seen where the
// rows of a map have taken (x z, y z, z, 1), px times depth and depth; of an orthographic camera (x, y, z, 1), px and 1. These are the
// rows less those that change nothing, so that small ways keep their digits.
struct LayerMotion {
    vec4 right; // of x
    vec4 down; // of y
    vec4 depth; // of z; of an orthographic camera zero
    // A way in the layer's axes and units adds to the same by these rows; w unused.
    vec4 way_right; // to x
    vec4 way_down; // to y
    vec4 way_depth; // to z; of an orthographic camera zero
    LayerRegion region; // what was kept of it
    uint clip_has_moved; // 1: that is not what is kept now
    uint first_surface; // what is to be added to the numbers of the surfaces of the region that is kept now
    uint was_shown; // 0: there was no frame before, or nothing of the layer in it
    uint since; // only edits of a higher number have moved its Gaussians; NO_EDITS: none have
};

// The Gaussians of a layer, and how visible they are.
struct LayerContent {
    uint first_block; // its first block; the next layer's first one is behind its last
    uint gaussian_end; // its Gaussians fill its blocks up to this number
    float opacity; // what its Gaussians' opacities are multiplied by, 0 to 1
    uint visible; // 0: nothing of it is drawn
    uint antialiased; // 1: its splats' opacities make up for the low-pass
    float low_pass; // what is added to its footprints' covariances, px^2
    uint pad[2]; // unused
};

// A layer of the scene in a cut.
struct CutLayer {
    LayerContent content; // its Gaussians
    LayerRegion region; // what is kept of them
};

// A layer of the scene in a frame.
struct LayerData {
    CutLayer cut; // what is kept of it
    LayerView view; // where the eye is
};

// A surface of a region, in the units of the layer that it cuts.
struct SurfaceData {
    vec4 high; // SURFACE_PLANE: unit normal and distance; SURFACE_QUADRIC: gradient and value at the anchor; SURFACE_MESH: its middle
    vec4 low; // what rounding them to single precision lost
    vec4 anchor; // SURFACE_QUADRIC: the point that its numbers are relative to; SURFACE_MESH: how its first coordinate grows; w unused
    vec4 anchor_low; // SURFACE_QUADRIC: what the rounding lost; SURFACE_MESH: how its second coordinate grows
    vec4 diagonal; // SURFACE_QUADRIC: the factors of the coordinates' squares; SURFACE_MESH: how its third coordinate grows; w unused
    vec4 across; // SURFACE_QUADRIC: half the factors of x y, x z and y z; SURFACE_MESH: bits of its hash, which no shader reads
    uint kind; // SURFACE_*
    uint operators; // how many answers on a stack it joins with those below, and from OPERATOR_SHIFT on a bit each: 1 for or
    uint mesh; // SURFACE_MESH: its first quad
    uint keeps_outside; // SURFACE_MESH: 1 where its outside is kept
};

// A Gaussian without its colour.
struct Gaussian {
    vec4 position_opacity; // centre, the layer's units; opacity 0 to 1
    vec4 scale; // standard deviations, the layer's units; w the bits of its number in the scene
    vec4 rotation; // unit quaternion x y z w
};

// A Gaussian as a host writes it to be edited: plain floats, of which an edit reads the members that it names.
struct PlainGaussian {
    vec4 position_opacity; // centre, the layer's units; opacity 0 to 1
    vec4 scale; // standard deviations, the layer's units; w unused
    vec4 rotation; // unit quaternion x y z w
    vec4 colour; // constant coefficients of the spherical harmonics, red, green and blue; w unused
};

// The bounds of the Gaussians of a block; a block is BLOCK_SIZE neighbours on a space-filling curve. The reach is the
// farthest that one's contour of 1/255 can lie from its centre, negative where none has such a contour.
struct Block {
    vec4 low_reach; // least coordinates of the centres; reach: the layer's units
    vec4 high_sigma; // greatest ones; largest standard deviation, negative where some may miss all pixels though in view
    float spanning_scale; // pixels a unit of the layer from which all that are antialiased are opaque enough to span a pixel
    uint pad[3]; // unused
};

// A splat on the screen: what each pixel that it covers needs of it, 64 bytes. splats.glsl says how they lie in memory.
struct Splat {
    vec4 centre_conic; // centre, px; k0 k1 of the inverse 2D covariance's Cholesky factor, 1/px
    vec4 conic_cut; // k2; opacity; the weight's z at the centre and dz/dx, as cut.glsl says
    vec4 colour_cut; // colour; dz/dy
    vec4 curvature_depth; // of the weight's z: the factors of dx^2, dx dy and dy^2, or an OpenStrip's (cut.glsl); the centre's depth
};

// The parallelogram that a splat is drawn with, where quads are drawn, relative to its centre, px: the points middle + s
// first + t second with s and t in [-1, 1].
struct Quad {
    vec2 middle; // its middle
    vec2 first; // half an axis
    vec2 second; // half the other
};

// How deep a splat is in a pixel: the mean of what the clip leaves of it. Only the strictest plane of each kind counts.
struct SplatDepth {
    vec4 mean; // of the whole splat at its centre, by how much it changes a px across and down; its deviation, negative of a union
    vec4 far; // the plane that keeps the far side: z at the centre, dz/dx, dz/dy; the shift of the mean by a density of one
    vec4 near; // the plane that keeps the near side, likewise; its shift is towards the eye
};

// How many Gaussians ended where, and the indirect commands that follow from it.
struct FrameCounts {
    uint visible; // in view, untouched
    uint cutoff; // in view, cut
    uint invisible; // in view, wholly clipped away
    uint culled; // outside the view or too faint
    uvec4 project_groups; // indirect dispatch over the splats
    uvec4 cutoff_groups; // indirect dispatch over the cutoff Gaussians
    uvec4 recut_groups; // indirect dispatch over the splats that a moved clip changes; w: how many
    uvec4 sort_groups; // indirect dispatch of the sort's runs or partitions
    uvec4 sort_pass_groups[4]; // the same for each of its passes; none where the keys agree
    uvec4 draw; // indirect draw: vertices, instances, first vertex, first instance
    uvec4 mesh_groups; // indirect mesh tasks; w: splats
    uvec4 span_count_groups; // indirect dispatch of the runs over the splats, which count their spans of tiles
    uvec4 span_groups; // indirect dispatch of the runs over the splats, which list their spans of tiles
    uvec4 part_groups; // indirect dispatch of the parts of the rows of tiles
    uvec4 row_groups; // indirect dispatch of the rows of tiles
    uvec4 pair_groups; // indirect dispatch of the partitions of the pairs of macro-tile and splat
    uvec4 batch_groups; // indirect dispatch of the batches of splats of a macro-tile
    uvec4 tile_groups; // indirect dispatch of the tiles; with the pipelines for GPUs but for those of several_tile_groups
    uvec4 several_tile_groups; // indirect dispatch of the tiles in which several surfaces cut a splat
    uvec4 coarse_groups; // indirect dispatch over the splats of coarse lists, with the pipelines for CPU drivers
    uvec4 composite; // indirect draw of the tiles' picture
    uint pairs; // pairs of tile and splat; those of macro-tile and splat where already these have no room
    uint has_room; // 1: the pairs have room; 0: the lists are coarse
    uint sort_base; // what the sort counts the splats' keys from
    uint sort_skipped; // passes of the sort, from the first, that their keys do without
    uint macro_pairs; // pairs of macro-tile and splat that have room; some of them may hold no tile
    uint long_records; // cut splats that more surfaces cut than a record has room for
    uint long_strides; // what their long records take; where there is less, they are weighed by what their records have room for
    uint excess_pairs; // pairs of macro-tile and splat where they have no room, or 0
};

const uint PROJECTION_PERSPECTIVE = 0u;
const uint PROJECTION_ORTHOGRAPHIC = 1u;
const uint MODE_NONE = 0u;
const uint MODE_HARD = 1u;
const uint MODE_RARA = 2u;
const uint MODE_EXACT = 3u;
const uint SURFACE_PLANE = 0u;
const uint SURFACE_QUADRIC = 1u;
const uint SURFACE_MESH = 2u;
const uint OP_AND = 0u;
const uint OP_OR = 1u;
// The surfaces combine by their operators.
const uint OP_PARTS = 2u;
const uint OPERATOR_SHIFT = 5u;
// What a pixel shows of its splats.
const uint SHOW_COLOUR = 0u;
const uint SHOW_WEIGHT = 1u;
const uint SHOW_COUNT = 2u;
const uint SHOW_MEAN = 3u;
const uint SHOW_STRONGEST = 4u;
// The colours that splats get.
const uint COLOURS_SCENE = 0u;
const uint COLOURS_NUMBERS = 1u;
const uint COLOURS_NORMALS = 2u;
const uint COLOURS_LAYERS = 3u;
const uint DECAY_LINEAR = 0u;
const uint DECAY_DEPTH = 1u;
const uint MISS_KEEP = 0u;
const uint MISS_DROP = 1u;
const uint MISS_PEAK = 2u;
const uint FORM_AUTO = 0u;
const uint FORM_BEAM = 1u;
const uint FORM_AFFINE = 2u;
const uint SH_FLOAT = 0u;
const uint SH_HALF = 1u;
const uint SH_BYTE = 2u;
const uint SH_PACKED = 3u;
// A packed scale's exponent 0 in a float's: scales are from 2^-15 to 2^16.
const uint SH_EXPONENT_BIAS = 112u;
// An edit reads these parts of plain Gaussians, a bit each; EDIT_FLAT makes all but the constant coefficients zero.
const uint EDIT_POSITIONS = 1u;
const uint EDIT_SCALES = 2u;
const uint EDIT_ROTATIONS = 4u;
const uint EDIT_OPACITIES = 8u;
const uint EDIT_COLOURS = 16u;
const uint EDIT_FLAT = 32u;
// In place of the number of an edit.
const uint NO_EDITS = 0xffffffffu;
const uint PHI_QUINTIC = 0u;
const uint PHI_CUBIC = 1u;
const uint PHI_LOGISTIC = 2u;
// How a copied depth is stored.
const uint DEPTH_NONE = 0u;
const uint DEPTH_FLOAT = 1u;
const uint DEPTH_24 = 2u;
const uint DEPTH_16 = 3u;
// How the tiles' pixels are stored.
const uint PIXELS_FLOAT = 0u;
const uint PIXELS_BYTE = 1u;
// vec4s of a surface in a combined cutoff record.
const uint ENTRY_VECTORS = 3u;
// vec4s of a cutoff record that holds a surface's terms.
const uint TERMS_VECTORS = 8u;
const uint NOT_CUT = 0xffffffffu;
const uint CUT_AWAY = 0xfffffffeu;

#endif
