// The numbers of src/base/limits.rs, written by tools/shaders.
#ifndef RARA_LIMITS
#define RARA_LIMITS

// Least square of the factor by which the opacity of antialiased Gaussians makes up for the low-pass. Scenes are trained with it.
const float COMPENSATION_SQUARE_MIN = 0.000025;
// Centres nearer than this along the view axis are culled where a camera has no near cut of its own, the scene's units.
const float NEAR_Z = 0.2;
// The least ratio of a Gaussian's smallest deviation to its largest: thinner ones are taken to be as thick. That is more than the
// rounding of a rotation turns a disc out of its plane, and no pixel shows it.
const float THINNEST = 1e-6;
// The projection's Jacobian is evaluated with x/z and y/z clamped this share of the picture beyond each edge.
const float CLAMP_MARGIN = 0.15;
// An opaque splat counts as one that lets this much through where the logarithm of that is needed.
const float TRANSMITTANCE_OPAQUE = 1e-30;
// 1 / ALPHA_MIN: a splat contributes nothing to a pixel in which its unclipped alpha is below 1/255.
const float ALPHA_MIN_INVERSE = 255.0;
// A cut splat is weighted by the perspective-exact form where sigma_max / Z exceeds this, by the affine form below.
const float BEAM_SWITCH = 0.005;
// A splat's band follows from where the eye is in it when perspective leaves less than this share of the splat's depth.
const float WIDENING_REST = 0.05;
// A plane this many deviations beyond the eye cuts off no more than 2e-9 of what is in front of the eye.
const float BEYOND_EYE = 6.0;
// The most coefficients that a colour channel has: those of degree 3.
const uint MAX_SH_COEFFICIENTS = 16u;
// Opacity below which a splat is invisible everywhere, and alpha below which a cut splat's weight is not computed: 1/255.
const float ALPHA_MIN = 1.0 / ALPHA_MIN_INVERSE;
// Gaussians of a block, one workgroup of clip, classify and compact; eight words of its bit masks.
const uint BLOCK_SIZE = 256u;
// How much farther than where single precision finds a splat's contour of 1/255 its block takes that to reach, a factor.
const float REACH_MARGIN = 1.0001;
// Blocks that a workgroup decides about at a time.
const uint BLOCK_GROUP_SIZE = 64u;
// Invocations that add up the counts of a row of runs of blocks. A list of blocks takes a single row on CPU drivers.
const uint RUN_ROW = 16u;
// Words that a reclipped frame keeps of a block: see reclip.glsl.
const uint RECLIP_WORDS = 32u;
// Standard deviation on the screen up to which single precision surely finds a splat's conic, px.
const float DRAWABLE_DEVIATION = 1e6;
// Splats a workgroup of project and cutoff handles.
const uint SPLAT_GROUP_SIZE = 64u;
// Splats a mesh workgroup emits: 4 vertices and 2 triangles each, half of the least that Vulkan guarantees.
const uint MESH_GROUP_SIZE = 32u;
// Columns of pixels of a tile.
const uint TILE_WIDTH = 8u;
// Rows of pixels of a tile.
const uint TILE_HEIGHT = 8u;
// Rows of tiles that are drawn together, column by column.
const uint STRIP_ROWS = 8u;
// Tiles along each side of what the composite draws as one quad. Each has a bit in two words, so there are 8.
const uint QUAD_TILES = 8u;
// Bits a pass of the radix sort looks at.
const uint SORT_BITS = 8u;
// Workgroup size of the sort by runs; one invocation owns a run of consecutive keys, which makes the sort stable.
const uint SORT_GROUP_SIZE = 64u;
// Most splats of one depth that one invocation orders alone.
const uint TIES_ALONE = 24u;
// Surfaces for which a cutoff record has room in a region that has parts or bends. A splat that more cut has a long record.
const uint RECORD_SURFACES = 8u;
// The same in a region that is a list of planes.
const uint RECORD_PLANES = 32u;
// Cutoff records that splats can name: as many bit patterns of floats are below -2.5e30.
const uint MAX_RECORDS = 54 << 22;
// Surfaces of a region from which its blocks have shortlists on GPUs: the surfaces that may cut a Gaussian of the block.
const uint SHORTLIST_FROM = 9u;
// The same on CPU drivers, on which a shortlist takes no registers from other work.
const uint SHORTLIST_FROM_ON_CPU = 3u;
// The most surfaces of a shortlist. The Gaussians of a block that more may cut ask all surfaces of the region.
const uint SHORTLIST_SURFACES = 31u;
// Words of a shortlist: see region/shortlist.glsl.
const uint SHORTLIST_WORDS = 64u;
// Workgroup size of the sort for GPUs.
const uint RADIX_GROUP_SIZE = 256u;
// Consecutive keys of such a workgroup: its partition.
const uint RADIX_PARTITION = 4096u;
// The most groups of splats of one depth that are more than such a workgroup sorts.
const uint MOST_LARGE_TIES = 1020u;
// The most parts into which the scene's numbers are divided to sort such a group.
const uint MOST_STRETCHES = 256u;
// The fewest partitions of such a part.
const uint LEAST_STRETCH = 4u;
// Counts of an invocation in a turn of that sort's scans.
const uint RADIX_SCAN_COUNTS = 8u;
// Tiles across a macro-tile, in which pipelines for GPUs collect splats before they list those of each tile. A picture
// of 1920x1080 then has 255 macro-tiles, one fewer than a digit of the sort has values.
const uint MACRO_COLUMNS = 16u;
// Tiles down a macro-tile.
const uint MACRO_ROWS = 8u;
// Bits of a macro-tile's number in the key of a pair of macro-tile and splat, enough for pictures of 32768x32768.
const uint PAIR_BITS = 17u;
// Tiles of a macro-tile.
const uint MACRO_TILES = MACRO_COLUMNS * MACRO_ROWS;
// Workgroup size of the search for a macro-tile's first pair: what it divides the pairs into in a step.
const uint MACRO_RANGE_GROUP_SIZE = 64u;
// Most splats of a macro-tile that a workgroup lists the tiles of: a batch.
const uint BATCH_SPLATS = 512u;
// Consecutive splats of a workgroup that writes coarse lists, 32 for each word of their bits.
const uint COARSE_GROUP_SIZE = RADIX_GROUP_SIZE;
// Words of a host's depth that a workgroup reads.
const uint HOST_DEPTH_GROUP_SIZE = 64u;
// The most rows and columns of cells of coarse lists together: a workgroup holds the bits of its splats in 8 KiB.
const uint MOST_CELLS = 256u;
// Workgroup size of the spans of tiles, of which one invocation owns a run of consecutive splats.
const uint SPAN_GROUP_SIZE = 64u;
// Workgroup size where an invocation owns a row of tiles or a part of its spans: small, since rows hold unequal numbers.
const uint ROW_GROUP_SIZE = 8u;
// Columns of a grid of workgroups that does not fit in a row. More than 65535 would exceed the least limit of devices.
const uint GROUP_COLUMNS = 32768u;
// Focal length beyond which positions in the camera's frame are computed in two floats, px. Single precision is off by
// about 2e-7 of the distance, which is this times the focal length in pixels: 4e-4 px at this one.
const float PRECISE_FOCAL = 2048.0;
// Half side of the largest quad drawn along a splat's own axes, px. Beyond it the corners' f32 error reaches pixels,
// and the quad becomes the splat's bounding box inside the picture.
const float QUAD_MAX_EXTENT = 4096.0;
// Buffers that a shader can declare, whose addresses fit in the 128 bytes of push constants that every device has beside
// `MAX_PARAMS` words of parameters.
const uint MAX_BUFFERS = 10u;
// Words of parameters that a shader can declare.
const uint MAX_PARAMS = 12u;

#endif
