//! The scene on the device: geometry and spherical harmonics, uploaded once.

use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;
use bytemuck::cast_slice;
use glam::Vec3;

use crate::clip::Clip;
use crate::error::{Error, Result};
use crate::gpu::{Buffer, Device, Recorder};
use crate::limits;
use crate::passes::buffers::gpu_only;
use crate::passes::{block_order, sh_storage};
use crate::precision::ShFormat;
use crate::scene::{Gaussians, LayerState, Scene, sh_coefficients};
use crate::types::{Block, Gaussian};

/// A scene's Gaussians in device memory.
#[derive(Debug)]
pub struct SceneBuffers {
    /// No other scene of this process has it.
    pub(crate) id: u64,
    pub(crate) gaussians: Buffer,
    pub(crate) sh: Buffer,
    pub(crate) blocks: Buffer,
    /// Whether the Gaussians lie in another order than the file's.
    pub(crate) reordered: bool,
    pub(crate) count: u32,
    pub(crate) sh_degree: u32,
    pub(crate) sh_format: ShFormat,
    layers: Vec<SceneLayer>,
}

/// A layer of a scene that is on the device.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SceneLayer {
    /// How the next frame that is configured shows it.
    pub state: LayerState,
    /// The clip of the next frame that is configured, for this layer alone and in place of the frame's; it stands in the
    /// scene.
    pub clip: Option<Clip>,
    name: String,
    gaussians: u32,
    /// The layer's first block; it fills whole blocks.
    pub(crate) first_block: u32,
    /// The corners of the box around its centres, in its own units.
    pub(crate) bounds: [Vec3; 2],
}

impl SceneLayer {
    pub(crate) fn new(name: String, first_block: u32, gaussians: u32, bounds: [Vec3; 2]) -> Self {
        Self {
            state: LayerState::default(),
            clip: None,
            name,
            gaussians,
            first_block,
            bounds,
        }
    }

    /// The name that it was uploaded with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gaussians in it.
    pub fn gaussians(&self) -> u32 {
        self.gaussians
    }

    /// Its blocks' Gaussians end before this place.
    pub(crate) fn gaussian_end(&self) -> u32 {
        self.first_block * limits::BLOCK_SIZE + self.gaussians
    }

    /// The first block behind it.
    fn block_end(&self) -> u32 {
        self.first_block + self.gaussians.div_ceil(limits::BLOCK_SIZE)
    }
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

/// Gaussians converted at a time while uploading, so that the scene is never in memory a third time.
const UPLOAD_CHUNK: usize = 1 << 16;
/// The same while writing into a host's memory, where a chunk is no submission: few enough to stay in the processor's cache.
const WRITE_CHUNK: usize = 1 << 10;

impl SceneBuffers {
    /// Uploads a scene, Gaussians or [layers](Scene) of them, its spherical harmonics stored as `format` says, in chunks,
    /// and waits for it. Beside the scene it takes 32 MiB at most.
    pub fn upload<'a>(
        device: &Device,
        scene: impl Into<Scene<'a>>,
        format: ShFormat,
    ) -> Result<Self> {
        let scene = scene.into();
        let (buffers, packed) = Self::allocate(device, &scene, format)?;
        for layer in &packed {
            let [gaussians, sh, blocks] = layer.offsets();
            upload_in_chunks(
                device,
                &buffers.gaussians,
                gaussians,
                &layer.order,
                |i, out| {
                    out.push(layer.gaussian(i));
                },
            )?;
            upload_in_chunks(device, &buffers.sh, sh, &layer.order, |i, out| {
                layer.append_sh(i, out);
            })?;
            device.upload(&buffers.blocks, blocks, cast_slice(&layer.blocks))?;
        }
        Ok(buffers)
    }

    /// Its layers, at least one, in the order in which they were given.
    pub fn layers(&self) -> &[SceneLayer] {
        &self.layers
    }

    /// Its layers, whose states the next [`Renderer::configure`](crate::Renderer::configure) takes as they are then.
    pub fn layers_mut(&mut self) -> &mut [SceneLayer] {
        &mut self.layers
    }

    /// Whether it was uploaded to this device.
    pub(crate) fn is_on(&self, device: &Device) -> bool {
        self.gaussians.device().is(device)
    }

    /// Bytes of staging memory that [`upload_with`](Self::upload_with) needs for a scene.
    pub fn staging_bytes<'a>(scene: impl Into<Scene<'a>>, format: ShFormat) -> u64 {
        let [gaussians, sh, blocks] = sizes(&scene.into(), format);
        gaussians + sh + blocks
    }

    /// Uploads a scene by the host's own means: allocates the buffers, writes the scene into the host's staging memory
    /// and records the copies. Nothing is submitted and nothing waited for, so that a scene can come or be replaced while
    /// frames are in flight; the processor's part may run on another thread than the one that draws.
    ///
    /// **Synchronisation.** The copies are ordered behind everything earlier in the queue, and nothing is needed after
    /// them: [`Renderer::prepare`](crate::Renderer::prepare) begins with a barrier that waits for transfers. It may be
    /// recorded later into the same command buffer, or into one that is submitted later to the same queue. The staging
    /// memory's writes reach the device with the submission where the memory is host-coherent; else the host flushes the
    /// range before it submits.
    ///
    /// **Lifetimes.** The host leaves the staging range alone, and the buffers that are returned alive, until `cmd` has
    /// executed. The scene that is replaced lives until the last frame that was prepared with it has executed. If `cmd`
    /// is never submitted, what is returned must not be drawn. After an error nothing has been recorded.
    ///
    /// # Safety
    ///
    /// `cmd` is recording on `device`, outside a rendering scope, and will be submitted to the device's queue, or never;
    /// `staging` is as [`Staging`] says, and nothing on the device uses its range.
    pub unsafe fn upload_with<'a>(
        device: &Device,
        cmd: vk::CommandBuffer,
        staging: Staging<'_>,
        scene: impl Into<Scene<'a>>,
        format: ShFormat,
    ) -> Result<Self> {
        let scene = scene.into();
        let sizes = sizes(&scene, format);
        let needed = sizes.iter().sum::<u64>();
        if (staging.bytes.len() as u64) < needed {
            return Err(Error::Invalid(format!(
                "this scene needs {needed} bytes of staging memory and {} were lent; SceneBuffers::staging_bytes says",
                staging.bytes.len()
            )));
        }
        let (buffers, packed) = Self::allocate(device, &scene, format)?;
        let [gaussians, sh, blocks] = sizes.map(|size| size as usize);
        let (first, rest) = staging.bytes.split_at_mut(gaussians);
        let (second, rest) = rest.split_at_mut(sh);
        let third = &mut rest[..blocks];
        for layer in &packed {
            let [gaussians, sh, blocks] = layer.offsets().map(|offset| offset as usize);
            // The places between the layers hold no Gaussian, and nothing reads them.
            write_in_chunks(&mut first[gaussians..], &layer.order, |i, out| {
                out.push(layer.gaussian(i));
            });
            write_in_chunks(&mut second[sh..], &layer.order, |i, out| {
                layer.append_sh(i, out);
            });
            let own: &[u8] = cast_slice(&layer.blocks);
            third[blocks..][..own.len()].copy_from_slice(own);
        }
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        let mut recorder = unsafe { Recorder::begin(device, cmd, None) };
        recorder.label("upload", |recorder| {
            let mut from = staging.offset;
            for (target, length) in [
                (&buffers.gaussians, gaussians),
                (&buffers.sh, sh),
                (&buffers.blocks, blocks),
            ] {
                // SAFETY: the caller vouches for the staging buffer, whose range holds so many bytes here.
                unsafe { recorder.copy_from(staging.buffer, from, target, length as u64) };
                from += length as u64;
            }
        });
        Ok(buffers)
    }

    /// Allocates the buffers, and packs what goes into them from each layer.
    fn allocate<'a>(
        device: &Device,
        scene: &Scene<'a>,
        format: ShFormat,
    ) -> Result<(Self, Vec<PackedLayer<'a>>)> {
        // A layer's last block may have places that hold nothing.
        let places = scene.layers().len() * limits::BLOCK_SIZE as usize + scene.gaussians();
        if u32::try_from(places).is_err() {
            return Err(Error::Invalid(format!(
                "a scene of {} Gaussians is beyond the 2^32 of an index",
                scene.gaussians()
            )));
        }
        if scene.layers().is_empty() {
            return Err(Error::Invalid("a scene has at least one layer".into()));
        }
        let sizes = sizes(scene, format);
        if sizes[1] > u64::from(u32::MAX) * 4 {
            return Err(Error::Invalid(format!(
                "{} Gaussians of spherical-harmonics degree {} need more than 2^32 numbers; lower the degree or store them in fewer bits",
                scene.gaussians(),
                scene.sh_degree()
            )));
        }
        let sh = (format, 3 * sh_coefficients(scene.sh_degree()));
        let (mut layers, mut packed) = (Vec::<SceneLayer>::new(), Vec::new());
        let mut count = 0;
        for layer in scene.layers() {
            let gaussians = layer.gaussians();
            let own = SceneLayer {
                state: layer.state(),
                clip: layer.clip().cloned(),
                ..SceneLayer::new(
                    layer.name().into(),
                    layers.last().map_or(0, SceneLayer::block_end),
                    gaussians.len() as u32,
                    bounds(gaussians),
                )
            };
            own.state.check(own.name())?;
            let order = block_order::order(gaussians);
            packed.push(PackedLayer {
                gaussians,
                blocks: block_order::blocks(gaussians, &order),
                order,
                first_block: own.first_block,
                first_number: count,
                sh,
            });
            count += own.gaussians;
            layers.push(own);
        }
        let buffers = Self {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            gaussians: gpu_only(device, "gaussians", sizes[0])?,
            sh: gpu_only(device, "sh", sizes[1])?,
            blocks: gpu_only(device, "blocks", sizes[2])?,
            reordered: !packed.iter().all(|layer| layer.order.is_sorted()),
            count,
            sh_degree: scene.sh_degree(),
            sh_format: format,
            layers,
        };
        Ok((buffers, packed))
    }

    /// Blocks of all layers.
    pub(crate) fn block_count(&self) -> u32 {
        self.layers.last().map_or(0, SceneLayer::block_end)
    }

    /// Bytes of device memory that the scene takes.
    pub fn bytes(&self) -> u64 {
        self.gaussians.size() + self.sh.size() + self.blocks.size()
    }

    /// Replaces the bounds by ones that settle nothing, so that each Gaussian is looked at for itself.
    #[cfg(test)]
    pub(crate) fn undecide(&self, device: &Device) -> Result<()> {
        const FAR: f32 = 1e30;
        let anywhere = Block {
            low_reach: [-FAR, -FAR, -FAR, FAR],
            high_sigma: [FAR, FAR, FAR, -FAR],
        };
        let count = self.block_count() as usize;
        device.upload(&self.blocks, 0, cast_slice(&vec![anywhere; count]))
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
    /// Where the part begins in it.
    pub offset: u64,
    /// The part, mapped for writing; it may be longer than what is needed.
    pub bytes: &'a mut [u8],
}

/// Bytes of the Gaussians, their spherical harmonics, and the bounds of their blocks.
fn sizes(scene: &Scene<'_>, format: ShFormat) -> [u64; 3] {
    let words = sh_storage::words(format, 3 * sh_coefficients(scene.sh_degree()));
    let block = limits::BLOCK_SIZE as usize;
    let (mut blocks, mut end) = (0, 0);
    for layer in scene.layers() {
        end = blocks * block + layer.gaussians().len();
        blocks = end.div_ceil(block);
    }
    [
        end * size_of::<Gaussian>(),
        end * words * size_of::<u32>(),
        blocks * size_of::<Block>(),
    ]
    .map(|bytes| bytes as u64)
}

/// The corners of the box around all centres.
fn bounds(gaussians: &Gaussians) -> [Vec3; 2] {
    let centres = gaussians.positions().iter();
    centres.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], &x| {
        [low.min(x), high.max(x)]
    })
}

/// A layer as the device gets it.
struct PackedLayer<'a> {
    gaussians: &'a Gaussians,
    /// The numbers of its Gaussians in the order of the device.
    order: Vec<u32>,
    blocks: Vec<Block>,
    first_block: u32,
    /// Its first Gaussian's number in the scene.
    first_number: u32,
    /// How spherical harmonics are stored, and how many numbers there are of each Gaussian.
    sh: (ShFormat, usize),
}

impl PackedLayer<'_> {
    /// Where its Gaussians, their spherical harmonics and its blocks begin, bytes.
    fn offsets(&self) -> [u64; 3] {
        let first = u64::from(self.first_block) * u64::from(limits::BLOCK_SIZE);
        let words = sh_storage::words(self.sh.0, self.sh.1);
        [
            first * size_of::<Gaussian>() as u64,
            first * (words * size_of::<u32>()) as u64,
            u64::from(self.first_block) * size_of::<Block>() as u64,
        ]
    }

    fn gaussian(&self, number: u32) -> Gaussian {
        let (scene, index) = (self.gaussians, number as usize);
        let in_scene = f32::from_bits(self.first_number + number);
        Gaussian {
            position_opacity: scene.positions()[index]
                .extend(scene.opacities()[index])
                .into(),
            scale: scene.scales()[index].extend(in_scene).into(),
            rotation: scene.rotations()[index].into(),
        }
    }

    /// Degrees that only other layers have are zero.
    fn append_sh(&self, number: u32, out: &mut Vec<u32>) {
        let own = self.gaussians.sh_of(number as usize);
        let (format, numbers) = self.sh;
        if own.len() == numbers {
            sh_storage::pack(format, own, out);
        } else {
            let mut all = [0.0; 3 * limits::MAX_SH_COEFFICIENTS as usize];
            all[..own.len()].copy_from_slice(own);
            sh_storage::pack(format, &all[..numbers], out);
        }
    }
}

/// Writes what `append` makes of each Gaussian, in an order, to memory that is slow to read.
fn write_in_chunks<T: bytemuck::NoUninit>(
    mut target: &mut [u8],
    order: &[u32],
    mut append: impl FnMut(u32, &mut Vec<T>),
) {
    let mut packed = Vec::new();
    for chunk in order.chunks(WRITE_CHUNK) {
        packed.clear();
        for &index in chunk {
            append(index, &mut packed);
        }
        let bytes: &[u8] = cast_slice(&packed);
        let (here, rest) = target.split_at_mut(bytes.len());
        here.copy_from_slice(bytes);
        target = rest;
    }
}

/// Uploads what `append` makes of each Gaussian, in an order, to a buffer from an offset on.
fn upload_in_chunks<T: bytemuck::NoUninit>(
    device: &Device,
    buffer: &Buffer,
    mut offset: u64,
    order: &[u32],
    mut append: impl FnMut(u32, &mut Vec<T>),
) -> Result<()> {
    let mut packed = Vec::new();
    for chunk in order.chunks(UPLOAD_CHUNK) {
        packed.clear();
        for &index in chunk {
            append(index, &mut packed);
        }
        device.upload(buffer, offset, cast_slice(&packed))?;
        offset += size_of_val(packed.as_slice()) as u64;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{BufferDesc, DeviceDesc, Location};
    use crate::scene::{Kind, generate};

    #[test]
    fn a_host_uploads_the_same_bytes() {
        let device = Device::headless(&DeviceDesc {
            selector: std::env::var("RARA_TEST_DEVICE").ok(),
            validation: true,
            ..DeviceDesc::default()
        })
        .expect("a device and the validation layer");
        for (count, format) in [
            (0, ShFormat::Float),
            (1, ShFormat::Packed),
            (3_000, ShFormat::Float),
            (2_999, ShFormat::Half),
            (2_049, ShFormat::Packed),
            (300, ShFormat::Byte),
        ] {
            let scene = generate(Kind::Layers, count, 1);
            let whole = SceneBuffers::upload(&device, &scene, format).expect("uploads");
            let needed = SceneBuffers::staging_bytes(&scene, format) as usize;
            let mut lent = device
                .create_buffer(&BufferDesc {
                    name: "lent",
                    size: needed as u64 + 64,
                    location: Location::Upload,
                })
                .expect("a buffer");
            let buffer = lent.handle();
            let ours = device.submit_and_wait(|cmd| {
                fn lend(buffer: vk::Buffer, bytes: &mut [u8]) -> Staging<'_> {
                    let offset = 32;
                    Staging {
                        buffer,
                        offset,
                        bytes,
                    }
                }
                let bytes = &mut lent.mapped_mut()[32..];
                // SAFETY: `cmd` is recording, and everything outlives the wait for it.
                unsafe {
                    if needed > 0 {
                        let short = lend(buffer, &mut bytes[..needed - 1]);
                        let error = SceneBuffers::upload_with(&device, cmd, short, &scene, format);
                        let text = error.expect_err("a byte is missing").to_string();
                        assert!(text.contains("staging_bytes"), "{text}");
                    }
                    let fitting = lend(buffer, &mut bytes[..needed]);
                    SceneBuffers::upload_with(&device, cmd, fitting, &scene, format)
                }
            });
            let ours = ours.expect("uploads");
            let pairs = [
                (&whole.gaussians, &ours.gaussians),
                (&whole.sh, &ours.sh),
                (&whole.blocks, &ours.blocks),
            ];
            for ((theirs, ours), size) in pairs.into_iter().zip(sizes(&(&scene).into(), format)) {
                let read = |buffer| device.download_range(buffer, 0, size).expect("reads back");
                assert!(read(theirs) == read(ours), "{count}, {format:?}");
            }
            let facts = |b: &SceneBuffers| {
                (
                    b.reordered,
                    b.count,
                    b.sh_degree,
                    b.sh_format,
                    b.layers.clone(),
                )
            };
            assert_eq!(facts(&whole), facts(&ours));
        }
        assert_eq!(device.close(), Vec::<String>::new());
    }
}
