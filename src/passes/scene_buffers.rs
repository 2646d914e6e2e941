//! The scene on the device: geometry and spherical harmonics, uploaded once.

use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::cast_slice;
use glam::Vec3;

use crate::error::{Error, Result};
use crate::gpu::{Buffer, Device};
use crate::passes::buffers::gpu_only;
use crate::passes::{block_order, sh_storage};
use crate::precision::ShFormat;
use crate::scene::Gaussians;
use crate::types::Gaussian;

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

impl SceneBuffers {
    /// Uploads a scene, its spherical harmonics stored as `format` says, in chunks, and waits for it. Beside the scene it
    /// takes 32 MiB at most.
    pub fn upload(device: &Device, scene: &Gaussians, format: ShFormat) -> Result<Self> {
        let too_many = |_| {
            Error::Invalid(format!(
                "a scene of {} Gaussians is beyond the 2^32 of an index",
                scene.len()
            ))
        };
        let count = u32::try_from(scene.len()).map_err(too_many)?;
        let words = sh_storage::words(format, 3 * scene.sh_coefficients());
        if scene.len() * words > u32::MAX as usize {
            return Err(Error::Invalid(format!(
                "{} Gaussians of spherical-harmonics degree {} need more than 2^32 numbers; lower the degree or store them in fewer bits",
                scene.len(),
                scene.sh_degree
            )));
        }
        let gpu = |name, size| gpu_only(device, name, size);
        let order = block_order::order(scene);
        let gaussians = gpu("gaussians", u64::from(count) * size_of::<Gaussian>() as u64)?;
        upload_in_chunks(device, &gaussians, &order, |index, out| {
            out.push(pack(scene, index));
        })?;
        let sh = gpu("sh", (scene.len() * words * size_of::<u32>()) as u64)?;
        upload_in_chunks(device, &sh, &order, |index, out| {
            sh_storage::pack(format, scene.sh_of(index as usize), out);
        })?;
        let bounds_of_blocks = block_order::blocks(scene, &order);
        let blocks = gpu("blocks", size_of_val(bounds_of_blocks.as_slice()) as u64)?;
        device.upload(&blocks, 0, cast_slice(&bounds_of_blocks))?;
        let centres = scene.positions.iter();
        let bounds = centres.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], &x| {
            [low.min(x), high.max(x)]
        });
        Ok(Self {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            gaussians,
            sh,
            blocks,
            reordered: !order.is_sorted(),
            count,
            sh_degree: scene.sh_degree,
            sh_format: format,
            bounds,
        })
    }

    /// Bytes of device memory that the scene takes.
    pub fn bytes(&self) -> u64 {
        self.gaussians.size() + self.sh.size() + self.blocks.size()
    }

    /// Bounds that settle nothing: each Gaussian is looked at for itself.
    #[cfg(test)]
    pub(crate) fn undecide(&self, device: &Device) -> Result<()> {
        const FAR: f32 = 1e30;
        let anywhere = crate::types::Block {
            low_reach: [-FAR, -FAR, -FAR, FAR],
            high_sigma: [FAR, FAR, FAR, -FAR],
        };
        let count = self.count.div_ceil(crate::limits::BLOCK_SIZE) as usize;
        device.upload(&self.blocks, 0, cast_slice(&vec![anywhere; count]))
    }

    /// The largest buffer, bytes; the blocks' is never that.
    pub(crate) fn largest(&self) -> u64 {
        self.gaussians.size().max(self.sh.size())
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
    let position = scene.positions[index];
    Gaussian {
        position_opacity: position.extend(scene.opacities[index]).into(),
        scale: scene.scales[index].extend(f32::from_bits(number)).into(),
        rotation: scene.rotations[index].into(),
    }
}
