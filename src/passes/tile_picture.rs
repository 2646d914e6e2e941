//! The picture that tiles make, and how it is read back.

use ash::vk;

use crate::types;
use rara_base::limits;
use rara_gpu::Buffer;
use rara_scene::precision::TargetFormat;

/// How the pixels of the tiles' picture are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TilePixels {
    /// As floats, which a draw can blend.
    #[default]
    Float,
    /// As those of a target of 8 bits a channel.
    Byte,
}

impl TilePixels {
    /// The pixels with which the tiles' picture is a target's, to the byte. `None` for 16-bit floats, to which one driver
    /// rounds in shaders and cuts off in blending.
    pub(crate) fn from_target(target: TargetFormat) -> Option<Self> {
        match target {
            TargetFormat::Float => Some(Self::Float),
            TargetFormat::Unorm8 => Some(Self::Byte),
            TargetFormat::Half => None,
        }
    }

    pub(crate) const fn bytes(self) -> u64 {
        match self {
            Self::Float => TargetFormat::Float.pixel_bytes(),
            Self::Byte => TargetFormat::Unorm8.pixel_bytes(),
        }
    }

    /// The shaders' name of them, `PIXELS_*`.
    pub(super) const fn code(self) -> u32 {
        match self {
            Self::Float => types::PIXELS_FLOAT,
            Self::Byte => types::PIXELS_BYTE,
        }
    }
}

/// The picture that tiles make. A tile that begins where the next one does holds nothing, and its pixels are not written.
#[derive(Debug, Clone)]
pub(crate) struct TilePicture {
    pub(crate) begins: Buffer,
    pub(crate) pixels: Buffer,
}

/// Bytes of a tile's begin.
const BEGIN: usize = size_of::<u32>();

impl TilePicture {
    /// True when it is the same memory.
    pub(crate) fn is(&self, other: &Self) -> bool {
        let handles = |picture: &Self| [&picture.begins, &picture.pixels].map(Buffer::handle);
        handles(self) == handles(other)
    }

    /// Bytes of the tiles' begins and of the pixels in a picture.
    pub(crate) fn sizes(extent: vk::Extent2D, format: TargetFormat) -> [u64; 2] {
        let [width, height] = [extent.width, extent.height].map(u64::from);
        let columns = width.div_ceil(limits::TILE_WIDTH.into());
        let rows = height.div_ceil(limits::TILE_HEIGHT.into());
        let begins = (columns * rows + 1) * BEGIN as u64;
        [begins, width * height * format.pixel_bytes()]
    }

    /// The pixels of a picture of what was read back, each of the [sizes](Self::sizes): zeros where nothing was written.
    pub(crate) fn decode(
        begins: &[u8],
        bytes: &[u8],
        extent: vk::Extent2D,
        format: TargetFormat,
    ) -> Vec<[f32; 4]> {
        let [width, height] = [extent.width, extent.height].map(|side| side as usize);
        let (tile_width, tile_height) = (limits::TILE_WIDTH as usize, limits::TILE_HEIGHT as usize);
        let columns = width.div_ceil(tile_width);
        let begins: Vec<&[u8]> = begins.chunks_exact(BEGIN).collect();
        let is_empty: Vec<bool> = begins.windows(2).map(|pair| pair[0] == pair[1]).collect();
        let pixel_bytes = format.pixel_bytes() as usize;
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let row = &is_empty[y / tile_height * columns..][..columns];
            let mut x = 0;
            for alike in row.chunk_by(|a, b| a == b) {
                let end = width.min(x + alike.len() * tile_width);
                if alike[0] {
                    pixels.resize(y * width + end, [0.0; 4]);
                } else {
                    let [first, last] = [x, end].map(|x| (y * width + x) * pixel_bytes);
                    pixels.extend(format.decode(&bytes[first..last]));
                }
                x = end;
            }
        }
        pixels
    }
}
