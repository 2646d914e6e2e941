//! The scene on the device: geometry and spherical harmonics, uploaded once.

use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;
use bytemuck::cast_slice;
use glam::Vec3;

use crate::error::{Error, Result};
use crate::gpu::{Buffer, Device, Recorder};
use crate::limits;
use crate::passes::buffers::gpu_only;
use crate::passes::{block_order, sh_storage};
use crate::precision::ShFormat;
use crate::scene::Gaussians;
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
    /// The corners of the box around all centres.
    pub(crate) bounds: [Vec3; 2],
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

/// Gaussians converted at a time while uploading, so that the scene is never in memory a third time.
const UPLOAD_CHUNK: usize = 1 << 16;
/// And while writing into a host's memory, where a chunk is no submission: what stays in the processor's cache.
const WRITE_CHUNK: usize = 1 << 10;

impl SceneBuffers {
    /// Uploads a scene, its spherical harmonics stored as `format` says, in chunks, and waits for it. Beside the scene it
    /// takes 32 MiB at most.
    pub fn upload(device: &Device, scene: &Gaussians, format: ShFormat) -> Result<Self> {
        let (buffers, order, blocks) = Self::allocate(device, scene, format)?;
        upload_in_chunks(device, &buffers.gaussians, &order, |index, out| {
            out.push(pack(scene, index));
        })?;
        upload_in_chunks(device, &buffers.sh, &order, |index, out| {
            sh_storage::pack(format, scene.sh_of(index as usize), out);
        })?;
        device.upload(&buffers.blocks, 0, cast_slice(&blocks))?;
        Ok(buffers)
    }

    /// Whether it was uploaded to this device.
    pub(crate) fn is_on(&self, device: &Device) -> bool {
        self.gaussians.device().is(device)
    }

    /// Bytes of staging memory that [`upload_with`](Self::upload_with) needs for a scene.
    pub fn staging_bytes(scene: &Gaussians, format: ShFormat) -> u64 {
        let [gaussians, sh, blocks] = sizes(scene, format);
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
    pub unsafe fn upload_with(
        device: &Device,
        cmd: vk::CommandBuffer,
        staging: Staging<'_>,
        scene: &Gaussians,
        format: ShFormat,
    ) -> Result<Self> {
        let needed = Self::staging_bytes(scene, format);
        if (staging.bytes.len() as u64) < needed {
            return Err(Error::Invalid(format!(
                "this scene needs {needed} bytes of staging memory and {} were lent; SceneBuffers::staging_bytes tells",
                staging.bytes.len()
            )));
        }
        let (buffers, order, blocks) = Self::allocate(device, scene, format)?;
        let [gaussians, sh, _] = sizes(scene, format).map(|size| size as usize);
        let (first, rest) = staging.bytes.split_at_mut(gaussians);
        let (second, rest) = rest.split_at_mut(sh);
        write_in_chunks(first, &order, |index, out| out.push(pack(scene, index)));
        write_in_chunks(second, &order, |index, out| {
            sh_storage::pack(format, scene.sh_of(index as usize), out);
        });
        let third: &[u8] = cast_slice(&blocks);
        rest[..third.len()].copy_from_slice(third);
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        let mut recorder = unsafe { Recorder::begin(device, cmd, None) };
        recorder.label("upload", |recorder| {
            let mut from = staging.offset;
            for (target, length) in [
                (&buffers.gaussians, gaussians),
                (&buffers.sh, sh),
                (&buffers.blocks, third.len()),
            ] {
                // SAFETY: the caller vouches for the staging buffer, whose range holds so many bytes here.
                unsafe { recorder.copy_from(staging.buffer, from, target, length as u64) };
                from += length as u64;
            }
        });
        Ok(buffers)
    }

    /// The buffers, still empty, the order of the Gaussians in them, and the bounds of their blocks.
    fn allocate(
        device: &Device,
        scene: &Gaussians,
        format: ShFormat,
    ) -> Result<(Self, Vec<u32>, Vec<Block>)> {
        let too_many = |_| {
            Error::Invalid(format!(
                "a scene of {} Gaussians is beyond the 2^32 of an index",
                scene.len()
            ))
        };
        let count = u32::try_from(scene.len()).map_err(too_many)?;
        let sizes = sizes(scene, format);
        if sizes[1] > u64::from(u32::MAX) * 4 {
            return Err(Error::Invalid(format!(
                "{} Gaussians of spherical-harmonics degree {} need more than 2^32 numbers; lower the degree or store them in fewer bits",
                scene.len(),
                scene.sh_degree()
            )));
        }
        let order = block_order::order(scene);
        let blocks = block_order::blocks(scene, &order);
        let centres = scene.positions().iter();
        let bounds = centres.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], &x| {
            [low.min(x), high.max(x)]
        });
        let buffers = Self {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            gaussians: gpu_only(device, "gaussians", sizes[0])?,
            sh: gpu_only(device, "sh", sizes[1])?,
            blocks: gpu_only(device, "blocks", sizes[2])?,
            reordered: !order.is_sorted(),
            count,
            sh_degree: scene.sh_degree(),
            sh_format: format,
            bounds,
        };
        Ok((buffers, order, blocks))
    }

    /// Bytes of device memory that the scene takes.
    pub fn bytes(&self) -> u64 {
        self.gaussians.size() + self.sh.size() + self.blocks.size()
    }

    /// Bounds that settle nothing: each Gaussian is looked at for itself.
    #[cfg(test)]
    pub(crate) fn undecide(&self, device: &Device) -> Result<()> {
        const FAR: f32 = 1e30;
        let anywhere = Block {
            low_reach: [-FAR, -FAR, -FAR, FAR],
            high_sigma: [FAR, FAR, FAR, -FAR],
        };
        let count = self.count.div_ceil(limits::BLOCK_SIZE) as usize;
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
fn sizes(scene: &Gaussians, format: ShFormat) -> [u64; 3] {
    let words = sh_storage::words(format, 3 * scene.sh_coefficients());
    let blocks = scene.len().div_ceil(limits::BLOCK_SIZE as usize);
    [
        scene.len() * size_of::<Gaussian>(),
        scene.len() * words * size_of::<u32>(),
        blocks * size_of::<Block>(),
    ]
    .map(|bytes| bytes as u64)
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

/// Uploads what `append` makes of each Gaussian, in an order.
fn upload_in_chunks<T: bytemuck::NoUninit>(
    device: &Device,
    buffer: &Buffer,
    order: &[u32],
    mut append: impl FnMut(u32, &mut Vec<T>),
) -> Result<()> {
    let mut offset = 0;
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

fn pack(scene: &Gaussians, number: u32) -> Gaussian {
    let index = number as usize;
    let position = scene.positions()[index];
    Gaussian {
        position_opacity: position.extend(scene.opacities()[index]).into(),
        scale: scene.scales()[index].extend(f32::from_bits(number)).into(),
        rotation: scene.rotations()[index].into(),
    }
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
            for ((theirs, ours), size) in pairs.into_iter().zip(sizes(&scene, format)) {
                let read = |buffer| device.download_range(buffer, 0, size).expect("reads back");
                assert!(read(theirs) == read(ours), "{count}, {format:?}");
            }
            let facts =
                |b: &SceneBuffers| (b.reordered, b.count, b.sh_degree, b.sh_format, b.bounds);
            assert_eq!(facts(&whole), facts(&ours));
        }
        assert_eq!(device.close(), Vec::<String>::new());
    }
}
