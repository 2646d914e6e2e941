//! The depth that a host has drawn already, as it is given to be read.

use ash::vk;

/// A host's depth image, of one sample. It is created with `TRANSFER_SRC` to be copied, or with `SAMPLED` where a view of it is
/// given.
#[derive(Debug, Clone, Copy)]
pub struct DepthImage {
    /// The image, whose level 0 is copied.
    pub image: vk::Image,
    /// A view of the depths alone, 2D, of one level and one layer, that is sampled in place of a copy, where that was promised;
    /// else null. `image` and `layer` are then unused.
    pub view: vk::ImageView,
    /// The layout of the image when it is read: `TRANSFER_SRC_OPTIMAL` or `GENERAL`, or with a view one in which it can be sampled.
    pub layout: vk::ImageLayout,
    /// The size of the image, in px.
    pub extent: vk::Extent2D,
    /// The layer to copy.
    pub layer: u32,
    /// The position of the viewport's upper left corner in the image, in px.
    pub origin: vk::Offset2D,
}

impl DepthImage {
    /// The part of the image that lies under a viewport of some size.
    #[doc(hidden)]
    pub fn under(&self, size: vk::Extent2D) -> DepthUnder {
        let along = |origin: i32, size: u32, whole: u32| {
            let first = i64::from(origin).max(0);
            let last = (i64::from(origin) + i64::from(size)).min(whole.into());
            let begin = (first - i64::from(origin)) as i32;
            (first as i32, begin, (last - first).max(0) as u32)
        };
        let (x, left, width) = along(self.origin.x, size.width, self.extent.width);
        let (y, top, height) = along(self.origin.y, size.height, self.extent.height);
        DepthUnder {
            first: [x, y],
            part: vk::Rect2D {
                offset: vk::Offset2D { x: left, y: top },
                extent: vk::Extent2D { width, height },
            },
        }
    }
}

/// The part of a depth image that lies under a viewport.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct DepthUnder {
    /// The pixel of the image at which it begins.
    pub first: [i32; 2],
    /// Its place in the viewport, empty where the image is beside it.
    pub part: vk::Rect2D,
}
