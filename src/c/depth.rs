//! The host's depth: what its buffer holds, the attachment, and the image that the host shows before the scope.

use rara::ash::vk;
use rara::gpu::DepthImage;
use rara::{DepthDesc, DepthMap, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, read, write};

/// The values in a depth buffer, for any perspective projection into depths from 0 to 1. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraDepthMap {
    /// Depth along the view axis that becomes 0, or 1 if reversed, world units above 0.
    pub z_near: f64,
    /// Depth along the view axis that becomes 1, or 0 if reversed; beyond z_near, INFINITY too.
    pub z_far: f64,
    /// True when nearer is more.
    pub reversed: vk::Bool32,
}

impl RaraDepthMap {
    pub(crate) fn map(&self) -> Result<DepthMap> {
        match self.reversed {
            vk::FALSE => DepthMap::ordinary(self.z_near, self.z_far),
            _ => DepthMap::reversed(self.z_near, self.z_far),
        }
    }
}

/// The host's depth attachment. Splats behind what it holds are hidden, and splats write nothing into it. In all of its
/// pixels a splat has one depth, that of its centre. The host draws opaque things first, then splats.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraDepthDesc {
    /// Set by rara_depth_desc_default.
    pub struct_size: usize,
    /// Its format, with or without stencil.
    pub format: vk::Format,
    /// True when a dynamic rendering scope has the same image as stencil attachment too. Default: false.
    pub stencil: vk::Bool32,
    /// True when the host gives each frame's depth to rara_renderer_prepare. Tiles need that; without it quads
    /// replace them. Default: false.
    pub readable: vk::Bool32,
    /// The buffer's value for a depth; rara_renderer_set_depth_map changes it from frame to frame.
    pub map: RaraDepthMap,
}

// SAFETY: repr(C), plain numbers, the size first.
unsafe impl Versioned for RaraDepthDesc {
    const NAME: &'static str = "RaraDepthDesc";
}

impl RaraDepthDesc {
    fn new(format: vk::Format, map: RaraDepthMap) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            format,
            stencil: vk::FALSE,
            readable: vk::FALSE,
            map,
        }
    }
}

/// # Safety
/// `desc` points to one.
pub(crate) unsafe fn depth_desc(desc: *const RaraDepthDesc) -> Result<DepthDesc> {
    let nowhere = RaraDepthMap {
        z_near: 0.0,
        z_far: 0.0,
        reversed: vk::FALSE,
    };
    let default = RaraDepthDesc::new(vk::Format::UNDEFINED, nowhere);
    // SAFETY: the caller's promise.
    let desc = unsafe { read(desc, default, "desc->depth") }?;
    if desc.format == vk::Format::UNDEFINED {
        return invalid("desc->depth->format is VK_FORMAT_UNDEFINED");
    }
    Ok(DepthDesc::new(desc.format, desc.map.map()?)
        .stencil(desc.stencil != 0)
        .readable(desc.readable != 0))
}

/// A depth attachment without stencil, not readable. `desc_size` is sizeof *desc.
///
/// # Safety
/// `desc` has room for `desc_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_desc_default(
    desc: *mut RaraDepthDesc,
    desc_size: usize,
    format: vk::Format,
    map: RaraDepthMap,
) -> RaraResult {
    let default = RaraDepthDesc::new(format, map);
    // SAFETY: the caller's promise.
    guard(|| unsafe { write(desc, desc_size, &default, "desc") })
}

/// A host's depth image, of one sample and created with VK_IMAGE_USAGE_TRANSFER_SRC_BIT.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraDepthImage {
    /// Set by rara_depth_image_default.
    pub struct_size: usize,
    /// The image, whose level 0 is read.
    pub image: vk::Image,
    /// Its layout when the copy runs: TRANSFER_SRC_OPTIMAL, the default, or GENERAL.
    pub layout: vk::ImageLayout,
    /// Its width, pixels.
    pub width: u32,
    /// Its height, pixels.
    pub height: u32,
    /// The array layer that is read. Default: 0.
    pub layer: u32,
    /// The viewport's left edge in the image, pixels. Default: 0.
    pub x: i32,
    /// The viewport's top edge in the image, pixels. Default: 0.
    pub y: i32,
}

// SAFETY: repr(C), a handle and numbers, the size first.
unsafe impl Versioned for RaraDepthImage {
    const NAME: &'static str = "RaraDepthImage";
}

impl RaraDepthImage {
    fn new(image: vk::Image, width: u32, height: u32) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            image,
            layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            width,
            height,
            layer: 0,
            x: 0,
            y: 0,
        }
    }
}

/// An image of `width` x `height` pixels, whose upper left corner is the viewport's. `depth_size` is sizeof *depth.
///
/// # Safety
/// `depth` has room for `depth_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_image_default(
    depth: *mut RaraDepthImage,
    depth_size: usize,
    image: vk::Image,
    width: u32,
    height: u32,
) -> RaraResult {
    let default = RaraDepthImage::new(image, width, height);
    // SAFETY: the caller's promise.
    guard(|| unsafe { write(depth, depth_size, &default, "depth") })
}

/// # Safety
/// `image` is null or points to one.
pub(crate) unsafe fn depth_image(image: *const RaraDepthImage) -> Result<DepthImage> {
    let default = RaraDepthImage::new(vk::Image::null(), 0, 0);
    // SAFETY: the caller's promise.
    let image = unsafe { read(image, default, "depth") }?;
    if image.image == vk::Image::null() {
        return invalid("depth->image is null");
    }
    let readable = [
        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        vk::ImageLayout::GENERAL,
    ];
    if !readable.contains(&image.layout) {
        return invalid(format!(
            "depth->layout is {:?}: it must be TRANSFER_SRC_OPTIMAL or GENERAL",
            image.layout
        ));
    }
    Ok(DepthImage {
        image: image.image,
        layout: image.layout,
        extent: vk::Extent2D {
            width: image.width,
            height: image.height,
        },
        layer: image.layer,
        origin: vk::Offset2D {
            x: image.x,
            y: image.y,
        },
    })
}
