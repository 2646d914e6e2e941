//! The frame's working memory: one buffer per array that a stage writes. Each has room for the worst that the scene can
//! need, except the tiles' lists, whose worst nobody could afford.

use std::sync::{Arc, OnceLock};

use crate::error::Result;
use crate::gpu::{Buffer, BufferDesc, Device, DeviceShape, Location};
use crate::passes::bin;
use crate::passes::plan::Plan;
use crate::passes::sizes::{Sized, Sizes};
use crate::passes::spare::Spare;
use crate::passes::tile_picture::TilePicture;

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
    pub(crate) reclip: OnceLock<ReclipBuffers>,
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

impl Plan {
    /// Who reaches the tiles' picture. On a processor the host may as well read it in place; what a GPU writes stays there
    /// until it is wanted.
    pub(super) fn picture_location(&self) -> Location {
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
    /// What of the buffers may be used again for these sizes, where they do not all suffice: nothing where the scene has
    /// another size.
    pub(crate) fn spare_for(&self, need: Sizes) -> (Spare, Sizes) {
        match self.sized_for.serve(need) {
            true => (self.spare(), self.sized_for),
            false => Default::default(),
        }
    }

    /// The bytes of the buffers that have to be made where these are spare, without what alignment adds.
    pub(crate) fn missing(spare: &Spare, sizes: Sizes, plan: &Plan, reclips: bool) -> u64 {
        let rounded = |bytes: u64| bytes.max(1).next_multiple_of(16);
        let mut missing = 0;
        for (name, bytes) in sizes.buffers(plan.way.shape) {
            missing += if spare.has(name) { 0 } else { rounded(bytes) };
        }
        let mut add = |sized: &[Sized]| {
            missing += sized.iter().map(|(_, bytes)| rounded(*bytes)).sum::<u64>();
        };
        if spare.picture.is_none() && (sizes.tiles > 0 || plan.is_tiled()) {
            add(&sizes.picture());
        }
        if spare.reclip.is_none() && reclips {
            add(&sizes.reclip());
        }
        missing
    }

    /// The bytes of the buffers that are not spare.
    pub(crate) fn outgrown(&self, spare: &Spare) -> u64 {
        let kept = spare.all();
        let is_kept = |buffer: &&Buffer| !kept.iter().any(|k| k.handle() == buffer.handle());
        let gone = self.all().into_iter().filter(is_kept);
        gone.map(Buffer::size).sum()
    }

    /// Allocates for a plan, in these sizes, what the spare buffers do not have; all of those are large enough.
    pub(crate) fn new(
        device: &Device,
        plan: &Plan,
        sizes: Sizes,
        mut spare: Spare,
    ) -> Result<Self> {
        let spare = &mut spare;
        let location = plan.picture_location();
        let (picture, reclip) = (spare.picture.take(), spare.reclip.take());
        let shape = plan.way.shape;
        let listed = sizes.buffers(shape);
        let bytes_of = |name| {
            let found = listed.iter().find(|(listed, _)| *listed == name);
            found.expect("every buffer is listed").1
        };
        let mut gpu = |name| spare.gpu_only(device, name, bytes_of(name));
        let tiles = match sizes.tiles {
            0 if !plan.is_tiled() => None,
            _ => Some(TileBuffers {
                splats: gpu("tile_splats")?,
                occluders: gpu("occluders")?,
                scratch: bin::Scratch::new(shape, &mut gpu)?,
                picture: match picture {
                    Some(picture) => picture,
                    None => {
                        let make = |(name, size)| {
                            device.create_buffer(&BufferDesc {
                                name,
                                size,
                                location,
                            })
                        };
                        let [begins, pixels] = sizes.picture().map(make);
                        Arc::new(TilePicture {
                            begins: begins?,
                            pixels: pixels?,
                        })
                    }
                },
            }),
        };
        Ok(Self {
            frame: gpu("frame")?,
            surfaces: gpu("surfaces")?,
            masks: gpu("masks")?,
            clip_sides: gpu("clip_sides")?,
            clip_masks: gpu("clip_masks")?,
            shortlists: gpu("shortlists")?,
            block_sides: gpu("block_sides")?,
            block_list: gpu("block_list")?,
            block_counts: gpu("block_counts")?,
            block_offsets: gpu("block_offsets")?,
            counts: gpu("counts")?,
            survivors: gpu("survivors")?,
            cutoffs: gpu("cutoffs")?,
            cut_records: gpu("cut_records")?,
            splats: gpu("splats")?,
            quads: gpu("quads")?,
            depth_keys: gpu("depth_keys")?,
            keys: [gpu("keys")?, gpu("sorted_keys")?],
            order: [gpu("order")?, gpu("sorted_order")?],
            histogram: gpu("histogram")?,
            crowds: gpu("crowds")?,
            tile_masks: gpu("tile_masks")?,
            depth: if sizes.depths > 0 || plan.way.expects_depth {
                Some(DepthBuffers {
                    depths: gpu("depths")?,
                    draw: gpu("depth_draw")?,
                })
            } else {
                None
            },
            tiles,
            reclip: reclip.map(OnceLock::from).unwrap_or_default(),
            sized_for: sizes,
        })
    }

    /// Allocates the further buffers of a reclipped frame.
    pub(crate) fn ensure_reclip(&self, device: &Device) -> Result<()> {
        if self.reclip.get().is_some() {
            return Ok(());
        }
        let sized = self.sized_for.reclip();
        let bytes = sized.iter().map(|(_, bytes)| bytes).sum();
        device.check_budget("a frame that takes over from the one before", bytes, 0)?;
        let [revisits, reclips, recuts, dirty] =
            sized.map(|(name, size)| gpu_only(device, name, size));
        let made = ReclipBuffers {
            revisits: revisits?,
            reclips: reclips?,
            recuts: recuts?,
            dirty: dirty?,
        };
        self.reclip.get_or_init(|| made);
        Ok(())
    }

    /// True when a plan fits into what is allocated.
    pub(crate) fn fit(&self, plan: &Plan) -> bool {
        self.sized_for.hold(Sizes::of(plan))
    }

    /// The sizes that they were allocated for.
    pub(crate) fn sizes(&self) -> Sizes {
        self.sized_for
    }
}

impl ReclipBuffers {
    pub(super) fn all(&self) -> [&Buffer; 4] {
        [&self.revisits, &self.reclips, &self.recuts, &self.dirty]
    }
}
