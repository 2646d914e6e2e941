//! The sizes of the frame's working memory, as they follow from plans.

use crate::gpu::DeviceShape;
use crate::limits;
use crate::passes::plan::Plan;
use crate::passes::{bin, sort};
use crate::types::{self, FrameCounts, FrameData, LayerData, Quad, Splat, SplatDepth, SurfaceData};

/// The numbers that the sizes depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Sizes {
    /// True when they are the most of many frames, whose scenes may be smaller.
    reserved: bool,
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
    pub(super) tiles: u64,
    /// Words of the bin's scratch.
    bin: bin::ScratchWords,
    picture_bytes: u64,
    occluders: u64,
    pub(super) depths: u64,
}

impl Sizes {
    /// The larger of each.
    pub(crate) fn or(self, other: Self) -> Self {
        let mut bin = self.bin;
        for (own, other) in bin.iter_mut().zip(other.bin) {
            *own = other.max(*own);
        }
        Self {
            reserved: self.reserved || other.reserved,
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

    /// True when one is at least as large as the other in each, and serves its scene.
    pub(super) fn hold(self, need: Self) -> bool {
        self.serve(need) && self.or(need) == self
    }

    /// True when they are reserved or of the same scene's size: one that goes from scene to scene keeps no more than it needs.
    pub(super) fn serve(self, other: Self) -> bool {
        self.reserved || self.gaussians == other.gaussians && self.blocks == other.blocks
    }

    /// True when a picture's lists and pixels have so much room too.
    pub(crate) fn hold_tiles_of(self, need: Self) -> bool {
        self.tiles >= need.tiles && self.picture_bytes >= need.picture_bytes
    }

    /// The same for any scene of at most so many layers, of which each begins with a block of its own.
    pub(crate) fn reserved(self, layers: u32) -> Self {
        let (had, layers) = (self.layers.max(1), u64::from(layers));
        Self {
            reserved: true,
            layers,
            blocks: self.blocks + layers,
            clip_blocks: grown(self.clip_blocks, layers),
            shortlists: grown(self.shortlists, layers),
            // Each layer may have as many as one has.
            surfaces: self.surfaces / had * layers,
            ..self
        }
    }

    pub(crate) fn of(plan: &Plan) -> Self {
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
            reserved: false,
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

/// A number that is not 0, and more.
fn grown(number: u64, more: u64) -> u64 {
    match number {
        0 => 0,
        number => number + more,
    }
}

/// A buffer's name and bytes.
pub(super) type Sized = (&'static str, u64);

impl Sizes {
    /// The buffers that only the device sees, but for those of a reclipped frame.
    pub(super) fn buffers(&self, shape: DeviceShape) -> Vec<Sized> {
        let (n, blocks) = (self.gaussians, self.blocks);
        let mask_bytes = u64::from(limits::BLOCK_SIZE) / 4; // two bits a Gaussian
        let layers = self.layers * size_of::<LayerData>() as u64;
        let mut all: Vec<Sized> = vec![
            ("frame", size_of::<FrameData>() as u64 + layers),
            ("surfaces", self.surfaces * size_of::<SurfaceData>() as u64),
            ("masks", blocks * mask_bytes),
            ("clip_sides", self.clip_blocks * 4),
            ("clip_masks", self.clip_blocks * mask_bytes),
            (
                "shortlists",
                self.shortlists * 4 * u64::from(limits::SHORTLIST_WORDS),
            ),
            ("block_sides", blocks * 4),
            ("block_list", blocks * 4),
            ("block_counts", blocks * 16),
            ("block_offsets", blocks * 8),
            ("counts", size_of::<FrameCounts>() as u64),
            ("survivors", n * 8),
            ("cutoffs", n * 4),
            ("cut_records", self.cut_bytes),
            ("splats", self.splats),
            ("quads", self.quads * size_of::<Quad>() as u64),
            ("depth_keys", self.depth_keys),
            ("keys", n * 4),
            ("sorted_keys", n * 4),
            ("order", n * 4),
            ("sorted_order", n * 4),
            ("histogram", self.histogram * 4),
            ("crowds", self.crowds * 4),
            ("tile_masks", self.masks * 16),
            ("tile_splats", self.pairs * 4),
            ("occluders", self.occluders * 4),
            ("depths", self.depths * size_of::<SplatDepth>() as u64),
            ("depth_draw", 16),
        ];
        let scratch = bin::Scratch::names(shape).iter().zip(self.bin);
        all.extend(scratch.map(|(name, words)| (*name, words * 4)));
        all
    }

    /// Those of the tiles' picture.
    pub(super) fn picture(&self) -> [Sized; 2] {
        [
            ("tile_begins", (self.tiles + 1) * 4),
            ("tile_picture", self.picture_bytes),
        ]
    }

    /// Those of a reclipped frame.
    pub(super) fn reclip(&self) -> [Sized; 4] {
        [
            ("revisits", self.blocks * 4),
            ("reclips", self.blocks * 4 * u64::from(limits::RECLIP_WORDS)),
            ("recuts", self.gaussians * 8),
            ("dirty", self.tiles * 4),
        ]
    }

    /// The largest buffer that a shader binds, bytes.
    pub(crate) fn largest(&self) -> u64 {
        self.cut_bytes
            .max(self.splats)
            .max(self.pairs * 4)
            .max(self.bin.into_iter().max().unwrap_or(0) * 4)
            .max(self.picture_bytes)
    }
}
