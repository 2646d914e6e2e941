//! Every number that host and shaders share, each here and nowhere else. `glsl/limits.glsl` is made of this file by
//! tools/shaders, and a build in the repository checks that it is the same.

/// Least square of the factor by which the opacity of antialiased Gaussians makes up for the low-pass. Scenes are trained with it.
pub const COMPENSATION_SQUARE_MIN: f32 = 0.000025;
/// Centres nearer than this along the view axis are culled where a camera has no near cut of its own, the scene's units.
pub const NEAR_Z: f32 = 0.2;
/// The least ratio of a Gaussian's smallest deviation to its largest: thinner ones are taken to be as thick. That is more than the
/// rounding of a rotation turns a disc out of its plane, and no pixel shows it.
pub const THINNEST: f32 = 1e-6;
/// The projection's Jacobian is evaluated with x/z and y/z clamped this share of the picture beyond each edge.
pub const CLAMP_MARGIN: f32 = 0.15;
/// An opaque splat counts as one that lets this much through where the logarithm of that is needed.
pub const TRANSMITTANCE_OPAQUE: f32 = 1e-30;
/// 1 / ALPHA_MIN: a splat contributes nothing to a pixel in which its unclipped alpha is below 1/255.
pub const ALPHA_MIN_INVERSE: f32 = 255.0;
/// A cut splat is weighted by the perspective-exact form where sigma_max / Z exceeds this, by the affine form below.
pub const BEAM_SWITCH: f32 = 0.005;
/// A splat's band follows from where the eye is in it when perspective leaves less than this share of the splat's depth.
pub const WIDENING_REST: f32 = 0.05;
/// A plane this many deviations beyond the eye cuts off no more than 2e-9 of what is in front of the eye.
pub const BEYOND_EYE: f32 = 6.0;
/// The most coefficients that a colour channel has: those of degree 3.
pub const MAX_SH_COEFFICIENTS: u32 = 16;
/// Opacity below which a splat is invisible everywhere, and alpha below which a cut splat's weight is not computed: 1/255.
pub const ALPHA_MIN: f32 = 1.0 / ALPHA_MIN_INVERSE;
/// Gaussians of a block, one workgroup of clip, classify and compact; eight words of its bit masks.
pub const BLOCK_SIZE: u32 = 256;
/// How much farther than where single precision finds a splat's contour of 1/255 its block takes that to reach, a factor.
pub const REACH_MARGIN: f32 = 1.0001;
/// Blocks that a workgroup decides about at a time.
pub const BLOCK_GROUP_SIZE: u32 = 64;
/// Invocations that add up the counts of a row of runs of blocks. A list of blocks takes a single row on CPU drivers.
pub const RUN_ROW: u32 = 16;
/// Words that a reclipped frame keeps of a block: see reclip.glsl.
pub const RECLIP_WORDS: u32 = 32;
/// Standard deviation on the screen up to which single precision surely finds a splat's conic, px.
pub const DRAWABLE_DEVIATION: f32 = 1e6;
/// Splats a workgroup of project and cutoff handles.
pub const SPLAT_GROUP_SIZE: u32 = 64;
/// Splats a mesh workgroup emits: 4 vertices and 2 triangles each, half of the least that Vulkan guarantees.
pub const MESH_GROUP_SIZE: u32 = 32;
/// Columns of pixels of a tile.
pub const TILE_WIDTH: u32 = 8;
/// Rows of pixels of a tile.
pub const TILE_HEIGHT: u32 = 8;
/// Rows of tiles that are drawn together, column by column.
pub const STRIP_ROWS: u32 = 8;
/// Tiles along each side of what the composite draws as one quad. Each has a bit in two words, so there are 8.
pub const QUAD_TILES: u32 = 8;
/// Bits a pass of the radix sort looks at.
pub const SORT_BITS: u32 = 8;
/// Workgroup size of the sort by runs; one invocation owns a run of consecutive keys, which makes the sort stable.
pub const SORT_GROUP_SIZE: u32 = 64;
/// Most splats of one depth that one invocation orders alone.
pub const TIES_ALONE: u32 = 24;
/// Surfaces for which a cutoff record has room in a region that has parts or bends. A splat that more cut has a long record.
pub const RECORD_SURFACES: u32 = 8;
/// The same in a region that is a list of planes.
pub const RECORD_PLANES: u32 = 32;
/// Cutoff records that splats can name: as many bit patterns of floats are below -2.5e30.
pub const MAX_RECORDS: u32 = 54 << 22;
/// Surfaces of a region from which its blocks have shortlists on GPUs: the surfaces that may cut a Gaussian of the block.
pub const SHORTLIST_FROM: u32 = 9;
/// The same on CPU drivers, on which a shortlist takes no registers from other work.
pub const SHORTLIST_FROM_ON_CPU: u32 = 3;
/// The most surfaces of a shortlist. The Gaussians of a block that more may cut ask all surfaces of the region.
pub const SHORTLIST_SURFACES: u32 = 31;
/// Words of a shortlist: see region/shortlist.glsl.
pub const SHORTLIST_WORDS: u32 = 64;
/// Workgroup size of the sort for GPUs.
pub const RADIX_GROUP_SIZE: u32 = 256;
/// Consecutive keys of such a workgroup: its partition.
pub const RADIX_PARTITION: u32 = 4096;
/// The most groups of splats of one depth that are more than such a workgroup sorts.
pub const MOST_LARGE_TIES: u32 = 1020;
/// The most parts into which the scene's numbers are divided to sort such a group.
pub const MOST_STRETCHES: u32 = 256;
/// The fewest partitions of such a part.
pub const LEAST_STRETCH: u32 = 4;
/// Counts of an invocation in a turn of that sort's scans.
pub const RADIX_SCAN_COUNTS: u32 = 8;
/// Tiles across a macro-tile, in which pipelines for GPUs collect splats before they list those of each tile. A picture
/// of 1920x1080 then has 255 macro-tiles, one fewer than a digit of the sort has values.
pub const MACRO_COLUMNS: u32 = 16;
/// Tiles down a macro-tile.
pub const MACRO_ROWS: u32 = 8;
/// Bits of a macro-tile's number in the key of a pair of macro-tile and splat, enough for pictures of 32768x32768.
pub const PAIR_BITS: u32 = 17;
/// Tiles of a macro-tile.
pub const MACRO_TILES: u32 = MACRO_COLUMNS * MACRO_ROWS;
/// Workgroup size of the search for a macro-tile's first pair: what it divides the pairs into in a step.
pub const MACRO_RANGE_GROUP_SIZE: u32 = 64;
/// Most splats of a macro-tile that a workgroup lists the tiles of: a batch.
pub const BATCH_SPLATS: u32 = 512;
/// Consecutive splats of a workgroup that writes coarse lists, 32 for each word of their bits.
pub const COARSE_GROUP_SIZE: u32 = RADIX_GROUP_SIZE;
/// Words of a host's depth that a workgroup reads.
pub const HOST_DEPTH_GROUP_SIZE: u32 = 64;
/// The most rows and columns of cells of coarse lists together: a workgroup holds the bits of its splats in 8 KiB.
pub const MOST_CELLS: u32 = 256;
/// Workgroup size of the spans of tiles, of which one invocation owns a run of consecutive splats.
pub const SPAN_GROUP_SIZE: u32 = 64;
/// Workgroup size where an invocation owns a row of tiles or a part of its spans: small, since rows hold unequal numbers.
pub const ROW_GROUP_SIZE: u32 = 8;
/// Columns of a grid of workgroups that does not fit in a row. More than 65535 would exceed the least limit of devices.
pub const GROUP_COLUMNS: u32 = 32768;
/// Focal length beyond which positions in the camera's frame are computed in two floats, px. Single precision is off by
/// about 2e-7 of the distance, which is this times the focal length in pixels: 4e-4 px at this one.
pub const PRECISE_FOCAL: f32 = 2048.0;
/// Half side of the largest quad drawn along a splat's own axes, px. Beyond it the corners' f32 error reaches pixels,
/// and the quad becomes the splat's bounding box inside the picture.
pub const QUAD_MAX_EXTENT: f32 = 4096.0;
/// Buffers that a shader can declare, whose addresses fit in the 128 bytes of push constants that every device has beside
/// `MAX_PARAMS` words of parameters.
pub const MAX_BUFFERS: u32 = 10;
/// Words of parameters that a shader can declare.
pub const MAX_PARAMS: u32 = 12;
