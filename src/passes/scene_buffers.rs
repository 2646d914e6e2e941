//! The scene on the device: geometry and spherical harmonics, uploaded once.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;
use bytemuck::cast_slice;

use crate::passes::cut_plan::SceneFacts;
use crate::passes::earlier_shapes::EarlierShapes;
use crate::passes::pair_estimate::PairSample;
use crate::passes::scene_layer::{
    PackedLayer, SceneLayer, join_sets, layer_index, sizes, write_in_order, written_bytes,
};
use crate::passes::sh_storage;
use crate::types::Gaussian;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{Buffer, BufferDesc, Device, DeviceShape, Location, Recorder, WriteOnly};
use rara_scene::camera::Camera;
use rara_scene::clip::Clip;
use rara_scene::precision::ShFormat;
use rara_scene::{Gaussians, LayerState, Scene, check_clip, sh_coefficients};

/// A scene's Gaussians in device memory. A clone shares that memory, and has states and clips of its layers of its own. Once the
/// Gaussians of a layer were replaced or [edited](crate::LayerEditor), only the scene in which they were can be drawn, and its
/// later clones.
#[derive(Debug, Clone)]
pub struct SceneBuffers {
    /// No other contents of a scene of this process have it.
    pub(crate) id: u64,
    /// The number of what the memory holds, which clones share.
    pub(super) held: Arc<AtomicU64>,
    pub(crate) gaussians: Buffer,
    pub(crate) sh: Buffer,
    pub(crate) blocks: Buffer,
    /// What edits have moved; `None` before the first one that does.
    pub(crate) earlier: Option<EarlierShapes>,
    /// True when the Gaussians lie in another order than that of their numbers.
    pub(crate) reordered: bool,
    /// The Gaussians that the layers have room for: their numbers are below it.
    pub(crate) count: u32,
    pub(crate) sh_degree: u32,
    pub(crate) sh_format: ShFormat,
    layers: Vec<SceneLayer>,
    /// What the pairs of tile and splat are estimated from.
    sample: Arc<PairSample>,
    /// No other change of layers in this process has it; 0 before any.
    pub(crate) changes: u64,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);
static CHANGES: AtomicU64 = AtomicU64::new(0);

/// Gaussians converted at a time while uploading, so that the scene is never in memory a third time.
const UPLOAD_CHUNK: usize = 1 << 16;

impl SceneBuffers {
    /// Uploads a scene, Gaussians or [layers](Scene) of them, its spherical harmonics stored as `format` says, in chunks,
    /// and waits for it. Beside the scene it takes 32 MiB at most. Layers that [own their Gaussians](rara_scene::Layer::owned)
    /// are freed on the way.
    pub fn upload<'a>(
        device: &Device,
        scene: impl Into<Scene<'a>>,
        format: ShFormat,
    ) -> Result<Self> {
        let scene = scene.into();
        let (mut buffers, packed) = Self::allocate(device, scene, format)?;
        for mut layer in packed {
            layer.pack_in_place();
            buffers.write_layer(device, &layer)?;
        }
        Ok(buffers)
    }

    /// Writes a layer to its place, and waits for it.
    fn write_layer(&mut self, device: &Device, layer: &PackedLayer<'_>) -> Result<()> {
        let [gaussians, sh, blocks] = layer.offsets();
        let [gaussian_bytes, sh_bytes] = layer.bytes_each();
        let (order, target) = (&layer.order[..], (&mut self.gaussians, gaussians));
        upload_in_order(device, target, (order, gaussian_bytes), |i, out| {
            out.push(layer.gaussian(i));
        })?;
        let target = (&mut self.sh, sh);
        upload_in_order(device, target, (order, sh_bytes), |i, out| {
            layer.append_sh(i, out);
        })?;
        device.upload(&self.blocks, blocks, cast_slice(&layer.blocks))
    }

    /// Replaces the Gaussians of a layer, of the number that it has in [`layers`](Self::layers), by as many or fewer than it
    /// has room for ([`SceneLayer::room`]), and waits for it. That adds a layer which was uploaded empty with room
    /// ([`Layer::with_room`](crate::Layer::with_room)), and removes one whose Gaussians are replaced by none. Nothing of the
    /// other layers is touched, and the layer keeps its name, state and clip. A frame draws the same as with a scene that was
    /// uploaded with these Gaussians; their numbers ([`Pick`](crate::Pick)) are the first ones of the layer.
    ///
    /// The host has waited for all frames that show the scene. A frame that was configured before, and a [`Cut`](crate::Cut), are
    /// configured anew.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a number that no layer has, for more Gaussians than the layer has room for or of a higher degree than
    /// the scene's, for Gaussians in linear light beside others that are not, and for a layer that is a part of Gaussians that
    /// a selection has divided.
    pub fn replace_layer(&mut self, index: usize, gaussians: &Gaussians) -> Result<()> {
        let device = self.gaussians.device().clone();
        let replaced = self.replaced(index, gaussians)?;
        let packed = self.packed(index, gaussians)?;
        self.hold_replaced(index, replaced, &packed);
        self.write_layer(&device, &packed)
    }

    /// Does what [`replace_layer`](Self::replace_layer) does by the host's own means, as [`upload_with`](Self::upload_with)
    /// does: writes the layer alone into the host's staging memory and records the copies. Nothing waits: frames that were
    /// submitted before show the layer as it was, those that are configured afterwards as it is.
    ///
    /// **Synchronisation**, **lifetimes**: as for [`upload_with`](Self::upload_with), but that the copies are ordered behind
    /// everything earlier in the queue. In another queue than that of the frames, they wait for the semaphores of all frames
    /// that show the scene.
    ///
    /// # Safety
    /// As for [`upload_with`](Self::upload_with).
    ///
    /// # Errors
    /// Those of [`replace_layer`](Self::replace_layer), and [`Error::Invalid`] where the staging memory is shorter than
    /// [`layer_staging_bytes`](Self::layer_staging_bytes); nothing has been recorded then, and the scene is as it was.
    pub unsafe fn replace_layer_with(
        &mut self,
        cmd: vk::CommandBuffer,
        staging: Staging<'_>,
        index: usize,
        gaussians: &Gaussians,
    ) -> Result<()> {
        let replaced = self.replaced(index, gaussians)?;
        staging.check(
            self.layer_staging_bytes(index, gaussians.len() as u32),
            "layer_staging_bytes",
        )?;
        let packed = self.packed(index, gaussians)?;
        packed.write(staging.bytes);
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        unsafe { self.copy(cmd, staging.buffer, &[packed.copies(staging.offset)], false) };
        self.hold_replaced(index, replaced, &packed);
        Ok(())
    }

    /// Bytes of staging memory that [`replace_layer_with`](Self::replace_layer_with) needs for so many Gaussians in place of
    /// those of a layer; 0 for a number that no layer has.
    pub fn layer_staging_bytes(&self, index: usize, gaussians: u32) -> u64 {
        let layer = self.layers.get(index);
        layer.map_or(0, |layer| written_bytes(gaussians, layer.room(), self.sh()))
    }

    /// A layer with other Gaussians, and the sample of the scene with it.
    fn replaced(&self, index: usize, gaussians: &Gaussians) -> Result<(SceneLayer, PairSample)> {
        let layer = self.layer(index)?;
        let (name, room, count) = (layer.name(), layer.room(), gaussians.len());
        let refuse = |what: String| Err(Error::Invalid(format!("layer '{name}' {what}")));
        if count > room as usize {
            return refuse(format!(
                "was uploaded with room for {}, so that it has no room for {count}: upload the scene",
                counted(room, "Gaussian")
            ));
        }
        if gaussians.sh_degree() > self.sh_degree {
            return refuse(format!(
                "cannot have spherical harmonics of degree {}, as its scene was uploaded with degree {}: lower the degree or \
                 upload the scene",
                gaussians.sh_degree(),
                self.sh_degree
            ));
        }
        let others = self.layers.iter().enumerate();
        let mut others = others.filter(|(at, other)| *at != index && other.gaussians() > 0);
        let linear = gaussians.training().linear;
        if count > 0 && others.any(|(_, other)| other.training().linear != linear) {
            return refuse(
                "cannot have colours of another light than the other layers: linear light is blended in linear light".into(),
            );
        }
        let sample = self.sample.with(index, gaussians, self.count as usize);
        Ok((layer.with(gaussians), sample))
    }

    /// The Gaussians of a layer as the device gets them in its place.
    fn packed<'a>(&self, index: usize, gaussians: &'a Gaussians) -> Result<PackedLayer<'a>> {
        let layer = self.layer(index)?;
        let gaussians = Cow::Borrowed(gaussians);
        Ok(PackedLayer::new(
            gaussians,
            layer,
            layer.numbers()?,
            self.sh(),
        ))
    }

    /// How spherical harmonics are stored, and how many numbers there are of each Gaussian.
    pub(super) fn sh(&self) -> (ShFormat, usize) {
        (self.sh_format, 3 * sh_coefficients(self.sh_degree))
    }

    /// Notes that the memory will hold a layer with other Gaussians.
    fn hold_replaced(
        &mut self,
        index: usize,
        (mut layer, sample): (SceneLayer, PairSample),
        packed: &PackedLayer<'_>,
    ) {
        layer.replaced_after = self.last_edit();
        self.reordered |= !packed.numbers().is_sorted();
        self.sample = Arc::new(sample);
        self.hold(index, layer);
    }

    /// The number of the last edit that has moved any; 0 before.
    pub(super) fn last_edit(&self) -> u32 {
        self.earlier
            .as_ref()
            .map_or(0, |earlier| earlier.numbers()[0])
    }

    /// What it keeps of Gaussians that edits move, with one more edit.
    pub(super) fn moved_again(&self) -> Result<EarlierShapes> {
        match &self.earlier {
            Some(earlier) => Ok(earlier.edited()),
            None => EarlierShapes::new(self.gaussians.device(), self.gaussians.size()),
        }
    }

    /// Notes that the memory will hold other contents of a layer.
    pub(super) fn hold(&mut self, index: usize, layer: SceneLayer) {
        self.layers[index] = layer;
        self.id = NEXT_ID.fetch_add(1, Ordering::Relaxed);
        self.held.store(self.id, Ordering::Relaxed);
    }

    /// True where its colours are linear light.
    pub(crate) fn is_linear(&self) -> bool {
        self.layers
            .iter()
            .any(|layer| layer.gaussians() > 0 && layer.training().linear)
    }

    /// Its layers, at least one, in the order in which they were given.
    pub fn layers(&self) -> &[SceneLayer] {
        &self.layers
    }

    /// The number of the first layer of a name, in [`layers`](Self::layers).
    ///
    /// # Errors
    /// [`Error::Invalid`], which lists the names that there are, where no layer is called so.
    pub fn layer_index(&self, name: &str) -> Result<usize> {
        layer_index(&self.layers, name)
    }

    /// Sets how a layer is shown, of the number that it has in [`layers`](Self::layers), from the next
    /// [`Renderer::configure`](crate::Renderer::configure) on. Nothing is uploaded again, and nothing has to be waited for.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a number that no layer has, and the errors of [`LayerState::check`]; the state is then as it was.
    pub fn set_layer_state(&mut self, index: usize, state: LayerState) -> Result<()> {
        let layer = self.layer_mut(index)?;
        state.check(layer.name())?;
        layer.state = state;
        Ok(())
    }

    /// Sets the clip of a layer, in place of the frame's as [`Layer::clipped`](crate::Layer::clipped) says, or with `None`
    /// the frame's, from the next [`Renderer::configure`](crate::Renderer::configure) on.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a number that no layer has, and for a clip of more than 65536 surfaces; the clip is then as it
    /// was.
    pub fn set_layer_clip(&mut self, index: usize, clip: Option<Clip>) -> Result<()> {
        let layer = self.layer_mut(index)?;
        check_clip(layer.name(), clip.as_ref())?;
        layer.clip = clip;
        Ok(())
    }

    pub(super) fn layer(&self, index: usize) -> Result<&SceneLayer> {
        self.layers.get(index).ok_or_else(|| {
            let count = self.layers.len();
            Error::Invalid(format!(
                "there is no layer {index}: the scene has {count}, numbered from 0"
            ))
        })
    }

    fn layer_mut(&mut self, index: usize) -> Result<&mut SceneLayer> {
        self.layer(index)?;
        self.changes = 1 + CHANGES.fetch_add(1, Ordering::Relaxed);
        Ok(&mut self.layers[index])
    }

    /// Checks that it can be drawn on a device.
    pub(crate) fn check(&self, device: &Device) -> Result<()> {
        let refuse = |why: &str| Err(Error::Invalid(why.into()));
        if !self.gaussians.device().is(device) {
            return refuse("the scene was uploaded to another device than the renderer's");
        }
        if self.held.load(Ordering::Relaxed) != self.id {
            return refuse(
                "Gaussians of the scene were replaced or edited in a clone, which shares its memory: clone that one anew",
            );
        }
        Ok(())
    }

    /// Bytes of staging memory that [`upload_with`](Self::upload_with) needs for a scene.
    pub fn staging_bytes<'a>(scene: impl Into<Scene<'a>>, format: ShFormat) -> u64 {
        let scene = scene.into();
        let sh = (format, 3 * sh_coefficients(scene.sh_degree()));
        let layers = scene.layers().iter();
        let bytes =
            layers.map(|layer| written_bytes(layer.gaussians().len() as u32, layer.room(), sh));
        bytes.sum()
    }

    /// Uploads a scene by the host's own means: allocates the buffers, writes the scene into the host's staging memory
    /// and records the copies. Nothing is submitted and nothing waited for, so that a scene can come or be replaced while
    /// frames are in flight; the processor's part may run on another thread than the one that draws.
    ///
    /// **Synchronisation.** The copies wait for nothing, as their memory is new, and nothing is needed after them:
    /// [`Renderer::prepare`](crate::Renderer::prepare) begins with a barrier that waits for transfers. It may be recorded later
    /// into the same command buffer, or into one that is submitted later to the same queue. Where `cmd` goes to another queue,
    /// as one for transfers alone, whose family is one of
    /// [`AdoptDesc::shared_families`](crate::gpu::AdoptDesc::shared_families), the submission of `prepare` waits for a
    /// semaphore. The staging memory's writes reach the device with the submission where the memory is host-coherent; else
    /// the host flushes the range before it submits.
    ///
    /// **Lifetimes.** The host leaves the staging range alone, and the buffers that are returned alive, until `cmd` has
    /// executed. The scene that is replaced lives until the last frame that was prepared with it has executed. If `cmd`
    /// is never submitted, what is returned must not be drawn. After an error nothing has been recorded.
    ///
    /// # Safety
    ///
    /// `cmd` is recording on `device`, outside a rendering scope, and will be submitted to the device's queue or to one of a
    /// shared family, or never; `staging` is as [`Staging`] says, and nothing on the device uses its range.
    pub unsafe fn upload_with<'a>(
        device: &Device,
        cmd: vk::CommandBuffer,
        staging: Staging<'_>,
        scene: impl Into<Scene<'a>>,
        format: ShFormat,
    ) -> Result<Self> {
        let scene = scene.into();
        staging.check(Self::staging_bytes(&scene, format), "staging_bytes")?;
        let (buffers, packed) = Self::allocate(device, scene, format)?;
        let mut bytes = staging.bytes;
        let (mut begin, mut copies) = (0, Vec::new());
        for mut layer in packed {
            layer.pack_in_place();
            let end = begin + layer.size();
            layer.write(bytes.part(begin as usize..end as usize));
            copies.push(layer.copies(staging.offset + begin));
            begin = end;
        }
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        unsafe { buffers.copy(cmd, staging.buffer, &copies, true) };
        Ok(buffers)
    }

    /// Records copies of layers to their places in the three buffers, which may be new, from a host's buffer.
    ///
    /// # Safety
    /// As for [`upload_with`](Self::upload_with); the host's buffer holds the bytes.
    unsafe fn copy(
        &self,
        cmd: vk::CommandBuffer,
        source: vk::Buffer,
        copies: &[[vk::BufferCopy; 3]],
        into_new: bool,
    ) {
        let targets = [&self.gaussians, &self.sh, &self.blocks];
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        let mut recorder =
            unsafe { Recorder::begin_copies(self.gaussians.device(), cmd, into_new) };
        recorder.label("upload", |recorder| {
            for (index, target) in targets.into_iter().enumerate() {
                let regions: Vec<_> = copies.iter().map(|layer| layer[index]).collect();
                // SAFETY: the caller vouches for the buffer, which holds the bytes of the regions.
                unsafe { recorder.copy_from(source, target, &regions) };
            }
        });
    }

    /// Allocates the buffers, and packs what goes into them from each layer.
    fn allocate<'a>(
        device: &Device,
        scene: Scene<'a>,
        format: ShFormat,
    ) -> Result<(Self, Vec<PackedLayer<'a>>)> {
        // A layer's last block may have places that hold nothing.
        let places = scene.layers().len() as u64 * u64::from(limits::BLOCK_SIZE) + scene.room();
        let room = counted(scene.room(), "Gaussian");
        if u32::try_from(places).is_err() {
            return Err(Error::Invalid(format!(
                "a scene of {room} is beyond the 2^32 of an index"
            )));
        }
        scene.check()?;
        let sizes = sizes(&scene, format);
        if sizes[1] > u64::from(u32::MAX) * 4 {
            return Err(Error::Invalid(format!(
                "{room} of spherical-harmonics degree {} need more than 2^32 numbers; lower the degree or store them in fewer bits",
                scene.sh_degree()
            )));
        }
        let bytes = sizes.iter().sum();
        device.check_budget(&format!("a scene of {room}"), bytes, 0)?;
        let sh = (format, 3 * sh_coefficients(scene.sh_degree()));
        let (mut layers, mut packed) = (Vec::<SceneLayer>::new(), Vec::new());
        let numbers: Vec<_> = scene.numbers().collect();
        let (count, sh_degree) = (scene.room() as u32, scene.sh_degree());
        let sample = PairSample::new(&scene);
        for (layer, &numbers) in scene.into_layers().into_iter().zip(&numbers) {
            let first_block = layers.last().map_or(0, SceneLayer::block_end);
            let held = SceneLayer::new(&layer, first_block, numbers);
            let gaussians = layer.into_gaussians();
            packed.push(PackedLayer::new(gaussians, &held, numbers, sh));
            layers.push(held);
        }
        join_sets(&mut layers, &numbers);
        let id = NEXT_ID.fetch_add(1, Ordering::Relaxed);
        let buffers = Self {
            id,
            held: Arc::new(id.into()),
            gaussians: gpu_only(device, "gaussians", sizes[0])?,
            sh: gpu_only(device, "sh", sizes[1])?,
            blocks: gpu_only(device, "blocks", sizes[2])?,
            earlier: None,
            reordered: !packed.iter().flat_map(PackedLayer::numbers).is_sorted(),
            count,
            sh_degree,
            sh_format: format,
            layers,
            sample: Arc::new(sample),
            changes: 0,
        };
        log::info!(
            "a scene of {} in {} takes {} on the device",
            counted(buffers.count, "Gaussian"),
            counted(buffers.layers.len(), "layer"),
            counted(buffers.bytes(), "byte")
        );
        Ok((buffers, packed))
    }

    /// An estimate of the pairs of tile and splat in the picture of a camera in the scene's space
    /// ([`Camera::in_scene`]), without what a clip leaves out. Tiles need room for them:
    /// [`FrameLimits::pairs`](crate::FrameLimits::pairs).
    pub fn estimated_pairs(&self, camera: &Camera) -> u32 {
        self.estimated_pairs_of_part(camera, camera)
    }

    /// The same of a picture that is a part of that of `whole`.
    pub(crate) fn estimated_pairs_of_part(&self, camera: &Camera, whole: &Camera) -> u32 {
        self.sample.pairs(&self.layers, camera, whole)
    }

    /// The facts that plans for a kind of device follow from.
    pub(crate) fn facts(&self, shape: DeviceShape) -> SceneFacts<'_> {
        SceneFacts {
            layers: &self.layers,
            gaussians: self.count,
            blocks: self.block_count(),
            reordered: self.reordered,
            sh_degree: self.sh_degree,
            sh_format: self.sh_format,
            shape,
        }
    }

    /// Blocks of all layers.
    pub(crate) fn block_count(&self) -> u32 {
        self.layers.last().map_or(0, SceneLayer::block_end)
    }

    /// Bytes of device memory that the scene takes.
    pub fn bytes(&self) -> u64 {
        let earlier = self
            .earlier
            .as_ref()
            .map_or(0, |earlier| earlier.buffer().size());
        self.gaussians.size() + self.sh.size() + self.blocks.size() + earlier
    }

    /// Replaces the bounds by ones that settle nothing, so that each Gaussian is looked at for itself.
    #[cfg(test)]
    pub(crate) fn undecide(&self, device: &Device) -> Result<()> {
        use crate::types::Block;
        const FAR: f32 = 1e30;
        let anywhere = Block {
            low_reach: [-FAR, -FAR, -FAR, FAR],
            high_sigma: [FAR, FAR, FAR, -FAR],
            spanning_scale: FAR,
            pad: [0; 3],
        };
        let count = self.block_count() as usize;
        device.upload(&self.blocks, 0, cast_slice(&vec![anywhere; count]))
    }

    /// The largest buffer that a scene of so many Gaussians can have, bytes.
    pub(crate) fn largest_of(gaussians: u32, format: ShFormat) -> u64 {
        let words = sh_storage::words(format, 3 * sh_coefficients(3)) as u64;
        let bytes = (4 * words).max(size_of::<Gaussian>() as u64);
        u64::from(gaussians) * bytes
    }

    /// The largest buffer, bytes; the blocks' is never that.
    pub(crate) fn largest(&self) -> u64 {
        self.gaussians.size().max(self.sh.size())
    }
}

/// A part of the host's memory that the device can copy from.
#[derive(Debug)]
pub struct Staging<'a> {
    /// A buffer that was created with `TRANSFER_SRC`.
    pub buffer: vk::Buffer,
    /// The offset of the part in it, bytes.
    pub offset: u64,
    /// The part, mapped for writing; it may be longer than what is needed. A slice becomes it by `into()`.
    pub bytes: WriteOnly<'a>,
}

impl Staging<'_> {
    /// Checks that it is as long as a function says.
    fn check(&self, needed: u64, said_by: &str) -> Result<()> {
        let lent = self.bytes.size() as u64;
        match lent >= needed {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "this needs {} of staging memory and {lent} were lent; SceneBuffers::{said_by} says",
                counted(needed, "byte")
            ))),
        }
    }
}

/// A buffer that only the device sees.
fn gpu_only(device: &Device, name: &str, size: u64) -> Result<Buffer> {
    device.create_buffer(&BufferDesc {
        name,
        size,
        location: Location::GpuOnly,
    })
}

/// Uploads what `append` makes of each Gaussian, so many bytes of each, in an order, to a buffer from an offset on.
fn upload_in_order<T: bytemuck::NoUninit>(
    device: &Device,
    (buffer, mut offset): (&mut Buffer, u64),
    (order, each): (&[u32], usize),
    append: impl Fn(u32, &mut Vec<T>) + Sync,
) -> Result<()> {
    if let Some(mut shared) = buffer.shared_mut() {
        let begin = offset as usize;
        let target = shared.part(begin..begin + order.len() * each);
        write_in_order(target, order, append);
        return Ok(());
    }
    let mut packed = Vec::new();
    for chunk in order.chunks(UPLOAD_CHUNK) {
        packed.resize(chunk.len() * each, 0);
        write_in_order(packed.as_mut_slice().into(), chunk, &append);
        device.upload(buffer, offset, &packed)?;
        offset += packed.len() as u64;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
