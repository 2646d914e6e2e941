//! The host's depth: what its buffer holds, the attachment, and the image that the host shows before the scope.

use rara::ash::vk;
use rara::gpu::DepthImage;
use rara::{DepthDesc, DepthMap, Projection, Result};

use crate::boundary::{RaraResult, Versioned, exclusive, guard, invalid, read, versioned, write};
use crate::camera::{RaraProjection, projection, projection_in_c};

/// The values in a depth buffer: at a depth z along the view axis, world units, it holds offset + scale / z in perspective,
/// offset - scale z without. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraDepthMap {
    /// See RaraDepthMap.
    pub offset: f64,
    /// See RaraDepthMap. Nearer is more where it is above zero.
    pub scale: f64,
    /// The projection of the cameras that it is for.
    pub projection: RaraProjection,
}

impl RaraDepthMap {
    pub(crate) fn map(&self) -> Result<DepthMap> {
        DepthMap::new(projection(self.projection)?, self.offset, self.scale)
    }

    pub(crate) fn new(map: DepthMap, projection: Projection) -> Self {
        Self {
            offset: map.offset(),
            scale: map.scale(),
            projection: projection_in_c(projection),
        }
    }
}

/// The map of a perspective projection into depths from 0 to 1: `z_near`, world units above 0, becomes 0, or 1 if `reversed`,
/// and `z_far`, beyond it and INFINITY too, the other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_map_perspective(
    z_near: f64,
    z_far: f64,
    reversed: vk::Bool32,
    map: *mut RaraDepthMap,
) -> RaraResult {
    guard(|| {
        let map = exclusive(map, "map")?;
        let made = match reversed {
            vk::FALSE => DepthMap::ordinary(z_near, z_far),
            _ => DepthMap::reversed(z_near, z_far),
        };
        *map = RaraDepthMap::new(made?, Projection::Perspective);
        Ok(())
    })
}

/// The map of an orthographic projection: 0 at `z_zero` along the view axis, 1 at `z_one`, world units, and linear between
/// them. Nearer is more where `z_one` is the nearer one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_map_orthographic(
    z_zero: f64,
    z_one: f64,
    map: *mut RaraDepthMap,
) -> RaraResult {
    guard(|| {
        let map = exclusive(map, "map")?;
        let made = DepthMap::orthographic(z_zero, z_one)?;
        *map = RaraDepthMap::new(made, Projection::Orthographic);
        Ok(())
    })
}

/// The host's depth attachment. Splats behind what it holds are hidden. A splat is hidden in all of its pixels by one depth, that
/// of its centre. The host draws opaque things first, then splats.
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
    /// The alpha, above 0 and at most 1, from which rara_renderer_draw writes a pixel's depth, so that what the host draws later
    /// meets the splats: the depth of the splat with which the pixel reaches it. It needs readable, tiles and an attachment that
    /// can be written. Default: 0, which writes none.
    pub write_alpha: f32,
    /// True to hide of each splat what lies behind the host's depth, on each pixel's line of sight, not whole splats by the depth
    /// of their centres. It needs readable and tiles. Default: false.
    pub soft: vk::Bool32,
    /// True when rara_renderer_prepare is given a view of the depth to sample (`view` of RaraDepthImage) in place of an image to
    /// copy, for hosts whose depth is no source of transfers. It needs readable and VK_KHR_push_descriptor. Default: false.
    pub sampled: vk::Bool32,
}

versioned!(RaraDepthDesc);

impl RaraDepthDesc {
    fn new(format: vk::Format, map: RaraDepthMap) -> Self {
        Self {
            format,
            map,
            ..Versioned::BLANK
        }
    }
}

pub(crate) unsafe fn depth_desc(desc: *const RaraDepthDesc) -> Result<DepthDesc> {
    let desc = read(desc, Versioned::BLANK, "desc->depth")?;
    if desc.format == vk::Format::UNDEFINED {
        return invalid("desc->depth->format is VK_FORMAT_UNDEFINED");
    }
    Ok(DepthDesc::new(desc.format, desc.map.map()?)
        .stencil(desc.stencil != 0)
        .readable(desc.readable != 0)
        .write_alpha((desc.write_alpha != 0.0).then_some(desc.write_alpha))
        .soft(desc.soft != 0)
        .sampled(desc.sampled != 0))
}

/// A depth attachment without stencil, not readable. `desc_size` is sizeof *desc.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_desc_default(
    desc: *mut RaraDepthDesc,
    desc_size: usize,
    format: vk::Format,
    map: RaraDepthMap,
) -> RaraResult {
    let default = RaraDepthDesc::new(format, map);
    guard(|| write(desc, desc_size, &default, "desc"))
}

/// A host's depth image, of one sample. It is created with VK_IMAGE_USAGE_TRANSFER_SRC_BIT to be copied, or with
/// VK_IMAGE_USAGE_SAMPLED_BIT where a view of it is given.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraDepthImage {
    /// Set by rara_depth_image_default.
    pub struct_size: usize,
    /// The image, whose level 0 is copied; null where a view is given.
    pub image: vk::Image,
    /// Its layout when it is read: TRANSFER_SRC_OPTIMAL, the default, or GENERAL; with a view one in which it can be sampled.
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
    /// A view of the depths alone, 2D, of one level and one layer, that is sampled where `sampled` of RaraDepthDesc promises it.
    /// Default: null.
    pub view: vk::ImageView,
}

versioned!(RaraDepthImage);

impl RaraDepthImage {
    fn new(image: vk::Image, width: u32, height: u32) -> Self {
        Self {
            image,
            layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            width,
            height,
            ..Versioned::BLANK
        }
    }
}

/// An image of `width` x `height` pixels, whose upper left corner is the viewport's. `depth_size` is sizeof *depth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_depth_image_default(
    depth: *mut RaraDepthImage,
    depth_size: usize,
    image: vk::Image,
    width: u32,
    height: u32,
) -> RaraResult {
    let default = RaraDepthImage::new(image, width, height);
    guard(|| write(depth, depth_size, &default, "depth"))
}

pub(crate) unsafe fn depth_image(image: *const RaraDepthImage) -> Result<DepthImage> {
    let default = RaraDepthImage::new(vk::Image::null(), 0, 0);
    let image = read(image, default, "depth")?;
    let copies = image.view == vk::ImageView::null();
    if copies && image.image == vk::Image::null() {
        return invalid("depth->image is null");
    }
    let readable = [
        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        vk::ImageLayout::GENERAL,
    ];
    if copies && !readable.contains(&image.layout) {
        return invalid(format!(
            "depth->layout is {:?}: it must be TRANSFER_SRC_OPTIMAL or GENERAL",
            image.layout
        ));
    }
    Ok(DepthImage {
        image: image.image,
        view: image.view,
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
