//! A layer of a scene on the device: what a frame asks of it, and what goes into the scene's buffers.

use std::borrow::Cow;
use std::collections::HashMap;

use ash::vk;
use bytemuck::cast_slice;
use glam::{DVec3, Vec3};

use crate::passes::{block_order, sh_storage};
use crate::types::{Block, Gaussian};
use rara_base::error::{Error, Result, shortened};
use rara_base::limits;
use rara_base::parallel::in_parallel;
use rara_gpu::WriteOnly;
use rara_scene::clip::Clip;
use rara_scene::placement::Placement;
use rara_scene::precision::ShFormat;
use rara_scene::{
    Bounds, GaussianArrays, Gaussians, Layer, LayerState, Numbers, Scene, Training, sh_coefficients,
};

/// A layer of a scene that is on the device.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SceneLayer {
    name: String,
    gaussians: u32,
    /// How many there is room for.
    room: u32,
    /// The number of its first Gaussian in the scene; `None` where they are a part of others, and have any numbers.
    first_number: Option<u32>,
    /// The layer's first block; it fills whole blocks.
    pub(super) first_block: u32,
    /// The corners of the box around its centres, in its own units.
    box_around: [Vec3; 2],
    /// The same of the set that the layer is a part of, or its own: what depends on it is alike in all parts of a set.
    pub(super) corners: [Vec3; 2],
    /// What their positions are relative to, in the layer's units.
    pub(super) origin: DVec3,
    /// How its Gaussians were trained.
    pub(super) training: Training,
    pub(super) state: LayerState,
    pub(super) clip: Option<Clip>,
    /// The number of the last edit that had moved Gaussians of the scene when others took the place of the layer's.
    pub(super) replaced_after: u32,
}

impl SceneLayer {
    /// That of a layer whose Gaussians begin with a block, and have these numbers.
    pub(crate) fn new(layer: &Layer<'_>, first_block: u32, numbers: Numbers<'_>) -> Self {
        let corners = corners(layer.gaussians());
        Self {
            name: layer.name().into(),
            gaussians: layer.gaussians().len() as u32,
            room: layer.room(),
            first_number: numbers.set().is_none().then(|| numbers.of(0)),
            first_block,
            box_around: corners,
            corners,
            origin: layer.gaussians().origin(),
            training: layer.gaussians().training(),
            state: layer.state(),
            clip: layer.clip().cloned(),
            replaced_after: 0,
        }
    }

    /// The same with other Gaussians.
    pub(super) fn with(&self, gaussians: &Gaussians) -> Self {
        let corners = corners(gaussians);
        Self {
            gaussians: gaussians.len() as u32,
            box_around: corners,
            corners,
            origin: gaussians.origin(),
            training: gaussians.training(),
            ..self.clone()
        }
    }

    /// The same with its centres within a box.
    pub(super) fn within(&self, bounds: Bounds) -> Self {
        let corners = outward(bounds);
        Self {
            box_around: corners,
            corners,
            ..self.clone()
        }
    }

    /// The numbers of its Gaussians, if they follow each other.
    pub(super) fn numbers(&self) -> Result<Numbers<'static>> {
        let Some(first) = self.first_number else {
            return Err(Error::Invalid(format!(
                "the Gaussians of layer '{}' are a part of others, whose numbers they have: upload the scene",
                self.name
            )));
        };
        Ok(Numbers::of_whole(first))
    }

    /// The most Gaussians that can take the place of its own
    /// ([`SceneBuffers::replace_layer`](super::SceneBuffers::replace_layer)): as many as it was uploaded with, or the
    /// [room](Layer::with_room) that it was given then.
    pub fn room(&self) -> u32 {
        self.room
    }

    /// The name that it was uploaded with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gaussians in it.
    pub fn gaussians(&self) -> u32 {
        self.gaussians
    }

    /// How they were trained, which is how they are drawn.
    pub fn training(&self) -> Training {
        self.training
    }

    /// The placement of its positions in that frame.
    pub(super) fn placement(&self) -> Placement {
        self.state.placement.of_origin(self.origin)
    }

    /// How the next frame that is configured shows it.
    pub fn state(&self) -> LayerState {
        self.state
    }

    /// Its own clip in the next frame that is configured; `None` where the frame's holds.
    pub fn clip(&self) -> Option<&Clip> {
        self.clip.as_ref()
    }

    /// True when the frame's clip or the own ones keep the same of both, in the same place of each.
    pub(super) fn is_clipped_like(&self, other: &Self) -> bool {
        self.is_visible() && self.placement() == other.placement() && self.clip == other.clip
    }

    /// True when anything of it shows; a layer that is faint enough shows in no pixel.
    pub(super) fn is_visible(&self) -> bool {
        self.state.visible && self.state.opacity >= limits::ALPHA_MIN
    }

    /// The box around all of its centres, in its own units, or that of the last edit
    /// ([`LayerEdit::bounds`](crate::LayerEdit::bounds)); `None` without Gaussians.
    pub fn bounds(&self) -> Option<Bounds> {
        let [min, max] = self.box_around.map(|corner| corner.as_dvec3());
        (self.gaussians > 0).then_some(Bounds { min, max })
    }

    /// Its blocks' Gaussians end before this place.
    pub(crate) fn gaussian_end(&self) -> u32 {
        self.first_block * limits::BLOCK_SIZE + self.gaussians
    }

    /// The blocks that it has room for.
    pub(super) fn block_count(&self) -> u32 {
        self.room.div_ceil(limits::BLOCK_SIZE)
    }

    /// The blocks that hold its Gaussians.
    pub(super) fn filled_blocks(&self) -> u32 {
        self.gaussians.div_ceil(limits::BLOCK_SIZE)
    }

    /// The first block behind it.
    pub(super) fn block_end(&self) -> u32 {
        self.first_block + self.block_count()
    }
}

/// The corners of a box in single precision, no nearer to its middle than in double.
fn outward(bounds: Bounds) -> [Vec3; 2] {
    let (min, max) = (bounds.min.as_vec3(), bounds.max.as_vec3());
    let low = [0, 1, 2].map(|axis| match f64::from(min[axis]) > bounds.min[axis] {
        true => min[axis].next_down(),
        false => min[axis],
    });
    let high = [0, 1, 2].map(|axis| match f64::from(max[axis]) < bounds.max[axis] {
        true => max[axis].next_up(),
        false => max[axis],
    });
    [low.into(), high.into()]
}

/// The number of the first layer of a name.
pub(super) fn layer_index(layers: &[SceneLayer], name: &str) -> Result<usize> {
    /// Names in a message, at most.
    const NAMED: usize = 20;
    let found = layers.iter().position(|layer| layer.name == name);
    found.ok_or_else(|| {
        let names: Vec<_> = layers
            .iter()
            .take(NAMED)
            .map(|l| format!("'{}'", l.name))
            .collect();
        let (are, more) = (
            if layers.len() == 1 { "is" } else { "are" },
            if layers.len() > NAMED {
                " and more"
            } else {
                ""
            },
        );
        Error::Invalid(format!(
            "no layer is called '{}'; there {are} {}{more}",
            shortened(name),
            names.join(", ")
        ))
    })
}

/// Gives the parts of each set the box around all of the set's centres.
pub(super) fn join_sets(layers: &mut [SceneLayer], numbers: &[Numbers<'_>]) {
    let mut boxes = HashMap::new();
    let of_set = |numbers: &Numbers<'_>| numbers.set();
    for (layer, set) in layers.iter().zip(numbers.iter().map(of_set)) {
        let [low, high] = layer.corners;
        let joined = boxes.entry(set).or_insert(layer.corners);
        *joined = [joined[0].min(low), joined[1].max(high)];
    }
    for (layer, set) in layers.iter_mut().zip(numbers.iter().map(of_set)) {
        if set.is_some() {
            layer.corners = boxes[&set];
        }
    }
}

/// Bytes of a Gaussian, and of its spherical harmonics, of which so many numbers are stored.
pub(super) fn bytes_each((format, numbers): (ShFormat, usize)) -> [usize; 2] {
    let words = sh_storage::words(format, numbers);
    [size_of::<Gaussian>(), words * size_of::<u32>()]
}

/// Bytes of the scene's buffers: the Gaussians, their spherical harmonics, and the bounds of their blocks.
pub(super) fn sizes(scene: &Scene<'_>, format: ShFormat) -> [u64; 3] {
    let [gaussian, sh] = bytes_each((format, 3 * sh_coefficients(scene.sh_degree())));
    let block = u64::from(limits::BLOCK_SIZE);
    let (mut blocks, mut end) = (0, 0);
    for layer in scene.layers() {
        end = blocks * block + u64::from(layer.room());
        blocks = end.div_ceil(block);
    }
    [
        end * gaussian as u64,
        end * sh as u64,
        blocks * size_of::<Block>() as u64,
    ]
}

/// Bytes that are written of a layer with so many Gaussians and room for so many; `sh` as for [`bytes_each`].
pub(super) fn written_bytes(gaussians: u32, room: u32, sh: (ShFormat, usize)) -> u64 {
    let each = bytes_each(sh).iter().sum::<usize>() as u64;
    let blocks = u64::from(room.div_ceil(limits::BLOCK_SIZE));
    u64::from(gaussians) * each + blocks * size_of::<Block>() as u64
}

/// The corners of the box around all centres.
fn corners(gaussians: &Gaussians) -> [Vec3; 2] {
    let centres = gaussians.positions().iter();
    centres.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], &x| {
        [low.min(x), high.max(x)]
    })
}

/// A layer as the device gets it.
pub(super) struct PackedLayer<'a> {
    arrays: Cow<'a, GaussianArrays>,
    /// True when the spherical harmonics among the arrays are packed.
    has_packed: bool,
    /// The numbers of its Gaussians in the order of the device.
    pub(super) order: Vec<u32>,
    pub(super) blocks: Vec<Block>,
    first_block: u32,
    numbers: Numbers<'a>,
    /// How spherical harmonics are stored, and how many numbers there are of each Gaussian.
    sh: (ShFormat, usize),
}

impl<'a> PackedLayer<'a> {
    /// Orders the Gaussians of a layer, which have numbers in the scene; `sh` as the field says. Blocks that there is room for
    /// hold nothing.
    pub(super) fn new(
        gaussians: Cow<'a, Gaussians>,
        layer: &SceneLayer,
        numbers: Numbers<'a>,
        sh: (ShFormat, usize),
    ) -> Self {
        let order = block_order::order(&gaussians);
        let mut blocks = block_order::blocks(&gaussians, &order);
        blocks.resize(layer.block_count() as usize, block_order::EMPTY);
        Self {
            blocks,
            arrays: match gaussians {
                Cow::Borrowed(gaussians) => Cow::Borrowed(gaussians.arrays()),
                Cow::Owned(gaussians) => Cow::Owned(gaussians.into_arrays()),
            },
            has_packed: false,
            order,
            first_block: layer.first_block,
            numbers,
            sh,
        }
    }

    /// Bytes of its Gaussians, their spherical harmonics and its blocks.
    pub(super) fn sizes(&self) -> [u64; 3] {
        let [gaussians, sh] = self.bytes_each().map(|each| each * self.order.len());
        [gaussians, sh, size_of_val(&self.blocks[..])].map(|bytes| bytes as u64)
    }

    /// Writes them one after the other.
    pub(super) fn write(&self, mut to: WriteOnly<'_>) {
        let [gaussians, sh, _] = self.sizes().map(|size| size as usize);
        let target = to.part(0..gaussians);
        write_in_order(target, &self.order, |i, out| out.push(self.gaussian(i)));
        let target = to.part(gaussians..gaussians + sh);
        write_in_order(target, &self.order, |i, out| self.append_sh(i, out));
        to.write(gaussians + sh, cast_slice(&self.blocks));
    }

    /// Bytes of a Gaussian, and of its spherical harmonics.
    pub(super) fn bytes_each(&self) -> [usize; 2] {
        bytes_each(self.sh)
    }

    /// The offsets of its Gaussians, their spherical harmonics and its blocks, bytes.
    pub(super) fn offsets(&self) -> [u64; 3] {
        let first = u64::from(self.first_block) * u64::from(limits::BLOCK_SIZE);
        let [gaussian, sh] = self.bytes_each().map(|bytes| first * bytes as u64);
        let blocks = u64::from(self.first_block) * size_of::<Block>() as u64;
        [gaussian, sh, blocks]
    }

    /// Bytes of all that is written of it.
    pub(super) fn size(&self) -> u64 {
        self.sizes().iter().sum()
    }

    /// The copies to its three places of what [`write`](Self::write) has written to an offset.
    pub(super) fn copies(&self, mut from: u64) -> [vk::BufferCopy; 3] {
        let (offsets, sizes) = (self.offsets(), self.sizes());
        [0, 1, 2].map(|index| {
            let copy = vk::BufferCopy::default().src_offset(from);
            from += sizes[index];
            copy.dst_offset(offsets[index]).size(sizes[index])
        })
    }

    /// The Gaussians' numbers in the scene, in the order of the device.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.order.iter().map(|&number| self.numbers.of(number))
    }

    pub(super) fn gaussian(&self, number: u32) -> Gaussian {
        let (arrays, index) = (&*self.arrays, number as usize);
        let in_scene = f32::from_bits(self.numbers.of(number));
        Gaussian {
            position_opacity: arrays.positions[index]
                .extend(arrays.opacities[index])
                .into(),
            scale: arrays.scales[index].extend(in_scene).into(),
            rotation: arrays.rotations[index].into(),
        }
    }

    /// Packs the spherical harmonics in the place of what they are packed from, if nobody else needs that.
    pub(super) fn pack_in_place(&mut self) {
        let (format, numbers) = self.sh;
        if let Cow::Owned(arrays) = &mut self.arrays
            && 3 * sh_coefficients(arrays.sh_degree) == numbers
        {
            sh_storage::pack_in_place(format, numbers, &mut arrays.sh);
            self.has_packed = true;
        }
    }

    /// Degrees that only other layers have are zero.
    pub(super) fn append_sh(&self, number: u32, out: &mut Vec<u32>) {
        let (format, numbers) = self.sh;
        let own = match self.has_packed {
            true => sh_storage::words(format, numbers),
            false => 3 * sh_coefficients(self.arrays.sh_degree),
        };
        let own = &self.arrays.sh[number as usize * own..][..own];
        if self.has_packed {
            out.extend_from_slice(cast_slice(own));
        } else if own.len() == numbers {
            sh_storage::pack(format, own, out);
        } else {
            let mut all = [0.0; 3 * limits::MAX_SH_COEFFICIENTS as usize];
            all[..own.len()].copy_from_slice(own);
            sh_storage::pack(format, &all[..numbers], out);
        }
    }
}

/// Gaussians that a thread writes at a time: few enough to stay in the processor's cache.
const WRITE_CHUNK: usize = 1 << 10;

/// Writes what `append` makes of each Gaussian, in an order, on all cores; of each it makes as many bytes.
pub(super) fn write_in_order<T: bytemuck::NoUninit>(
    target: WriteOnly<'_>,
    order: &[u32],
    append: impl Fn(u32, &mut Vec<T>) + Sync,
) {
    let each = target.size() / order.len().max(1);
    let targets = target.chunks((WRITE_CHUNK * each).max(1));
    in_parallel(
        order.chunks(WRITE_CHUNK).zip(targets),
        |(numbers, mut target)| {
            let mut packed = Vec::with_capacity(target.size() / size_of::<T>());
            for &index in numbers {
                append(index, &mut packed);
            }
            target.write(0, cast_slice(&packed));
        },
    );
}
