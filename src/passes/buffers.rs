//! The frame's working memory: one buffer per array that a stage writes. Each has room for the worst that the scene can
//! need, except the tiles' lists, whose worst nobody could afford.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{Buffer, BufferDesc, Device, DeviceShape, Location};
use crate::limits;
use crate::passes::plan::Plan;
use crate::passes::spare::Spare;
use crate::passes::{bin, sort};
use crate::types::{self, FrameCounts, FrameData, LayerData, Quad, Splat, SplatDepth, SurfaceData};

/// Everything the stages hand to each other. No stage reads a count on the CPU, so each array but the
/// tiles' lists has room for every Gaussian of the scene; drivers back untouched memory lazily.
#[derive(Debug)]
pub(crate) struct Buffers {
    pub(crate) frame: Buffer,
    /// The surfaces of the layers' regions; empty without a clip.
    pub(crate) surfaces: Buffer,
    pub(crate) masks: Buffer,
    /// The clip's sides and masks of the blocks; empty without a clip.
    pub(crate) clip_sides: Buffer,
    pub(crate) clip_masks: Buffer,
    /// The blocks' shortlists of surfaces; empty where no region has many.
    pub(crate) shortlists: Buffer,
    pub(crate) block_sides: Buffer,
    pub(crate) block_list: Buffer,
    pub(crate) block_counts: Buffer,
    pub(crate) block_offsets: Buffer,
    pub(crate) counts: Buffer,
    pub(crate) survivors: Buffer,
    pub(crate) cutoffs: Buffer,
    pub(crate) cut_records: Buffer,
    pub(crate) splats: Buffer,
    /// What the splats are drawn with; empty where no quads are.
    pub(crate) quads: Buffer,
    /// The keys of the survivors' depths; with kernels for GPUs twice as much, since their sort has a use for it later.
    pub(crate) depth_keys: Buffer,
    pub(crate) keys: [Buffer; 2],
    pub(crate) order: [Buffer; 2],
    pub(crate) histogram: Buffer,
    /// What the sort for GPUs knows of many splats of one depth; empty for CPU drivers.
    pub(crate) crowds: Buffer,
    /// Which tiles each splat touches; empty where tiles are not wanted. Kernels for GPUs have words of the splats' rectangles
    /// behind the masks (glsl/rects.glsl).
    pub(crate) tile_masks: Buffer,
    /// Only for tiles.
    pub(crate) tiles: Option<TileBuffers>,
    /// Only where a host asks for expected depths.
    pub(crate) depth: Option<DepthBuffers>,
    /// Only where the camera has stood still.
    pub(crate) reclip: Option<ReclipBuffers>,
    sized_for: Sizes,
}

/// The tile rasteriser's buffers.
#[derive(Debug)]
pub(crate) struct TileBuffers {
    pub(super) scratch: bin::Scratch,
    /// The tiles' lists, one after the other.
    pub(crate) splats: Buffer,
    /// The picture that the tiles make. Where it is the frame's, somebody may want it longer than the rest.
    pub(crate) picture: Arc<TilePicture>,
    /// The host's depth; empty where it hides nothing.
    pub(crate) occluders: Buffer,
}

/// The picture that tiles make. A tile that begins where the next one does holds nothing, and its pixels are not written.
#[derive(Debug)]
pub(crate) struct TilePicture {
    pub(crate) begins: Buffer,
    pub(crate) pixels: Buffer,
}

/// The further buffers of expected depths.
#[derive(Debug)]
pub(crate) struct DepthBuffers {
    pub(crate) depths: Buffer,
    /// The indirect draw of a quad a survivor.
    pub(crate) draw: Buffer,
}

/// The further buffers of a reclipped frame.
#[derive(Debug, Clone)]
pub(crate) struct ReclipBuffers {
    pub(crate) revisits: Buffer,
    pub(crate) reclips: Buffer,
    pub(crate) recuts: Buffer,
    pub(crate) dirty: Buffer,
}

/// The numbers that the sizes depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Sizes {
    gaussians: u64,
    blocks: u64,
    layers: u64,
    surfaces: u64,
    clip_blocks: u64,
    shortlists: u64,
    cut_bytes: u64,
    /// Words.
    histogram: u64,
    crowds: u64,
    /// Bytes.
    splats: u64,
    depth_keys: u64,
    quads: u64,
    masks: u64,
    pairs: u64,
    tiles: u64,
    /// Words of the bin's scratch.
    bin: bin::ScratchWords,
    picture_bytes: u64,
    occluders: u64,
    depths: u64,
}

impl Sizes {
    /// The larger of each.
    fn or(self, other: Self) -> Self {
        let mut bin = self.bin;
        for (own, other) in bin.iter_mut().zip(other.bin) {
            *own = other.max(*own);
        }
        Self {
            gaussians: self.gaussians.max(other.gaussians),
            blocks: self.blocks.max(other.blocks),
            layers: self.layers.max(other.layers),
            surfaces: self.surfaces.max(other.surfaces),
            clip_blocks: self.clip_blocks.max(other.clip_blocks),
            shortlists: self.shortlists.max(other.shortlists),
            cut_bytes: self.cut_bytes.max(other.cut_bytes),
            histogram: self.histogram.max(other.histogram),
            crowds: self.crowds.max(other.crowds),
            splats: self.splats.max(other.splats),
            depth_keys: self.depth_keys.max(other.depth_keys),
            quads: self.quads.max(other.quads),
            masks: self.masks.max(other.masks),
            pairs: self.pairs.max(other.pairs),
            tiles: self.tiles.max(other.tiles),
            bin,
            picture_bytes: self.picture_bytes.max(other.picture_bytes),
            occluders: self.occluders.max(other.occluders),
            depths: self.depths.max(other.depths),
        }
    }

    /// True when one is at least as large as the other in each, and of the same scene's size: one that goes from scene to
    /// scene keeps no more than it needs.
    fn hold(self, need: Self) -> bool {
        self.is_of(need) && self.or(need) == self
    }

    fn is_of(self, other: Self) -> bool {
        self.gaussians == other.gaussians && self.blocks == other.blocks
    }

    fn of(plan: &Plan) -> Self {
        let gaussians = u64::from(plan.gaussians());
        let cut_bytes = if plan.cuts() {
            gaussians * u64::from(plan.data.weight.cut_stride) * 16
        } else {
            0
        };
        let when_tiled = |size: u64| {
            if plan.is_tiled() { size } else { 0 }
        };
        let pixels = plan.data.view.size[0] as u64 * plan.data.view.size[1] as u64;
        let blocks = u64::from(plan.data.scene.block_count);
        Self {
            gaussians,
            blocks,
            layers: plan.layers.layers().len() as u64,
            // For all layers wherever they are placed: one that moves needs no other buffers.
            surfaces: plan.layers.layers().len() as u64 * u64::from(plan.layers.most_surfaces()),
            clip_blocks: if plan.mode() == types::MODE_NONE {
                0
            } else {
                blocks
            },
            shortlists: if plan.is_shortlisted() { blocks } else { 0 },
            cut_bytes,
            histogram: sort::histogram_words(plan),
            crowds: sort::crowd_words(plan),
            splats: splat_bytes(plan),
            depth_keys: match plan.way.shape {
                DeviceShape::Cpu => gaussians * 4,
                DeviceShape::Gpu { .. } => gaussians * 8,
            },
            quads: if plan.needs_quads() { gaussians } else { 0 },
            masks: when_tiled(gaussians + u64::from(plan.keeps_rects()) * gaussians.div_ceil(4)),
            pairs: when_tiled(plan.data.room.pair_capacity.into()),
            tiles: when_tiled(plan.data.tiles.tile_count.into()),
            bin: bin::Scratch::words(plan).map(when_tiled),
            picture_bytes: when_tiled(pixels * plan.way.tile_pixels.bytes()),
            depths: if plan.way.expects_depth { gaussians } else { 0 },
            occluders: plan.occluders.map_or(0, |_| when_tiled(pixels)),
        }
    }
}

/// Bytes of the splats, which lie as glsl/splats.glsl says.
fn splat_bytes(plan: &Plan) -> u64 {
    let vector = size_of::<[f32; 4]>() as u64;
    let gaussians = u64::from(plan.gaussians());
    let whole = gaussians * size_of::<Splat>() as u64;
    match plan.way.shape {
        DeviceShape::Cpu => whole,
        DeviceShape::Gpu { .. } => whole + gaussians.div_ceil(4) * vector,
    }
}

impl Plan {
    /// Who reaches the tiles' picture. On a processor the host may as well read it in place; what a GPU writes stays there
    /// until it is wanted.
    fn picture_location(&self) -> Location {
        match self.way.shape {
            DeviceShape::Cpu if !self.is_drawn => Location::Readback,
            DeviceShape::Cpu | DeviceShape::Gpu { .. } => Location::GpuOnly,
        }
    }
}

/// The indirect command in a field of a struct that a buffer holds.
macro_rules! indirect {
    ($buffer:expr, $Struct:ty, $field:ident) => {
        $crate::gpu::Groups::Indirect(&$buffer, std::mem::offset_of!($Struct, $field) as u64)
    };
}
pub(super) use indirect;

/// The buffers of a program: `from => [name]` binds the field `name` of `from` to the binding of that name; after a
/// semicolon come those whose binding has another name, or that are no field.
macro_rules! buffers {
    ($program:ident {
        $($from:expr => [$($name:ident),+ $(,)?]),+ $(,)?
        $(; $($other:ident $(: $buffer:expr)?),+ $(,)?)?
    }) => {
        $program::Buffers {
            $($($name: &$from.$name,)+)+
            $($($other $(: $buffer)?,)+)?
        }
    };
}
pub(super) use buffers;

/// A buffer that only the device sees.
pub(super) fn gpu_only(device: &Device, name: &'static str, size: u64) -> Result<Buffer> {
    device.create_buffer(&BufferDesc {
        name,
        size,
        location: Location::GpuOnly,
    })
}

impl Buffers {
    /// What of the buffers a plan may use again, where they do not all suffice: nothing where the scene has another size.
    pub(crate) fn spare_for(&self, plan: &Plan) -> (Spare, Sizes) {
        let need = Sizes::of(plan);
        match self.sized_for.is_of(need) {
            true => (self.spare(), self.sized_for),
            false => Default::default(),
        }
    }

    /// Allocates for a plan what the spare buffers, which had these sizes, do not have. Nothing becomes smaller, so that going
    /// back to a frame before allocates nothing.
    pub(crate) fn new(
        device: &Device,
        plan: &Plan,
        (mut spare, had): (Spare, Sizes),
    ) -> Result<Self> {
        let sizes = Sizes::of(plan).or(had);
        let spare = &mut spare;
        let picture = spare.picture.take();
        let reclip = spare.reclip.take();
        let location = plan.picture_location();
        let (n, blocks) = (sizes.gaussians, sizes.blocks);
        let mask_bytes = u64::from(limits::BLOCK_SIZE) / 4; // two bits a Gaussian
        let frame_bytes =
            size_of::<FrameData>() as u64 + sizes.layers * size_of::<LayerData>() as u64;
        let tiles = match sizes.tiles {
            0 if !plan.is_tiled() => None,
            tiles => {
                let begins = (tiles + 1) * 4;
                let fits = |old: &Arc<TilePicture>| {
                    old.begins.size() >= begins
                        && old.pixels.size() >= sizes.picture_bytes
                        && old.pixels.location() == location
                };
                let picture = match picture.filter(fits) {
                    Some(picture) => picture,
                    None => Arc::new(TilePicture {
                        begins: spare.take(device, "tile_begins", begins, location)?,
                        pixels: {
                            let bytes = sizes.picture_bytes;
                            spare.take(device, "tile_picture", bytes, location)?
                        },
                    }),
                };
                Some(TileBuffers {
                    scratch: bin::Scratch::new(device, plan.way.shape, sizes.bin, spare)?,
                    splats: spare.gpu_only(device, "tile_splats", sizes.pairs * 4)?,
                    picture,
                    occluders: spare.gpu_only(device, "occluders", sizes.occluders * 4)?,
                })
            }
        };
        let mut gpu = |name, size| spare.gpu_only(device, name, size);
        Ok(Self {
            frame: gpu("frame", frame_bytes)?,
            surfaces: gpu("surfaces", sizes.surfaces * size_of::<SurfaceData>() as u64)?,
            masks: gpu("masks", blocks * mask_bytes)?,
            clip_sides: gpu("clip_sides", sizes.clip_blocks * 4)?,
            clip_masks: gpu("clip_masks", sizes.clip_blocks * mask_bytes)?,
            shortlists: gpu(
                "shortlists",
                sizes.shortlists * 4 * u64::from(limits::SHORTLIST_WORDS),
            )?,
            block_sides: gpu("block_sides", blocks * 4)?,
            block_list: gpu("block_list", blocks * 4)?,
            block_counts: gpu("block_counts", blocks * 16)?,
            block_offsets: gpu("block_offsets", blocks * 8)?,
            counts: gpu("counts", size_of::<FrameCounts>() as u64)?,
            survivors: gpu("survivors", n * 8)?,
            cutoffs: gpu("cutoffs", n * 4)?,
            cut_records: gpu("cut_records", sizes.cut_bytes)?,
            splats: gpu("splats", sizes.splats)?,
            quads: gpu("quads", sizes.quads * size_of::<Quad>() as u64)?,
            depth_keys: gpu("depth_keys", sizes.depth_keys)?,
            keys: [gpu("keys", n * 4)?, gpu("sorted_keys", n * 4)?],
            order: [gpu("order", n * 4)?, gpu("sorted_order", n * 4)?],
            histogram: gpu("histogram", sizes.histogram * 4)?,
            crowds: gpu("crowds", sizes.crowds * 4)?,
            tile_masks: gpu("tile_masks", sizes.masks * 16)?,
            tiles,
            depth: if sizes.depths > 0 || plan.way.expects_depth {
                Some(DepthBuffers {
                    depths: gpu("depths", n * size_of::<SplatDepth>() as u64)?,
                    draw: gpu("depth_draw", 16)?,
                })
            } else {
                None
            },
            reclip: reclip.filter(|reclip| reclip.dirty.size() >= sizes.tiles * 4),
            sized_for: sizes,
        })
    }

    /// Allocates the further buffers of a reclipped frame.
    pub(crate) fn ensure_reclip(&mut self, device: &Device) -> Result<()> {
        if self.reclip.is_some() {
            return Ok(());
        }
        let gpu = |name, size| gpu_only(device, name, size);
        let Sizes {
            gaussians: n,
            blocks,
            ..
        } = self.sized_for;
        self.reclip = Some(ReclipBuffers {
            revisits: gpu("revisits", blocks * 4)?,
            reclips: gpu("reclips", blocks * 4 * u64::from(limits::RECLIP_WORDS))?,
            recuts: gpu("recuts", n * 8)?,
            dirty: gpu("dirty", self.sized_for.tiles * 4)?,
        });
        Ok(())
    }

    /// True when a plan fits into what is allocated.
    pub(crate) fn fit(&self, plan: &Plan) -> bool {
        self.sized_for.hold(Sizes::of(plan))
    }

    /// The largest buffer that a shader binds, bytes.
    pub(crate) fn largest(&self) -> u64 {
        let sizes = self.sized_for;
        sizes
            .cut_bytes
            .max(sizes.splats)
            .max(sizes.pairs * 4)
            .max(sizes.bin.into_iter().max().unwrap_or(0) * 4)
            .max(sizes.picture_bytes)
    }
}
