//! What the host draws into: a picture and reversed, infinite depths, and memory to read the picture back from.

use rara::ash::vk;
use rara::gpu::DepthImage;
use wgpu::hal::api::Vulkan;

use crate::Failure;
use crate::host::Host;

pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Bytes that rows of what is read back begin at multiples of.
const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

pub(crate) struct Target {
    pub(crate) color: wgpu::Texture,
    pub(crate) depth: wgpu::Texture,
    pub(crate) color_view: wgpu::TextureView,
    pub(crate) depth_view: wgpu::TextureView,
    readback: wgpu::Buffer,
}

impl Target {
    pub(crate) fn new(host: &Host, format: wgpu::TextureFormat, size: (u32, u32)) -> Self {
        let texture = |label, format| {
            host.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size.0,
                    height: size.1,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                // Tiles need a copy of the depth that the host has drawn.
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let color = texture("picture", format);
        let depth = texture("depth", DEPTH);
        let rows = u64::from(row(&color)) * u64::from(size.1);
        Self {
            color_view: color.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_view: depth.create_view(&wgpu::TextureViewDescriptor::default()),
            color,
            depth,
            readback: host.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size: rows,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
        }
    }

    /// The depths, as rara copies them.
    pub(crate) fn depth_image(&self) -> DepthImage {
        // SAFETY: nothing of what is shown is destroyed.
        let texture = unsafe { self.depth.as_hal::<Vulkan>() }.expect("a texture of Vulkan's");
        DepthImage {
            // SAFETY: as above.
            image: unsafe { texture.raw_handle() },
            view: vk::ImageView::null(),
            layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL, // that is what `TextureUses::COPY_SRC` means
            extent: self.area().extent,
            layer: 0,
            origin: vk::Offset2D::default(),
        }
    }

    /// Begins a scope of Vulkan's over picture and depths as they are, in the layouts of `TextureUses::COLOR_TARGET` and
    /// `DEPTH_STENCIL_WRITE`.
    ///
    /// # Safety
    /// `cmd` is recording on the host's device, and the target lives until that has executed.
    pub(crate) unsafe fn begin(&self, host: &Host, cmd: vk::CommandBuffer) {
        let attachment = |view: &wgpu::TextureView, layout| {
            // SAFETY: nothing of what is shown is destroyed.
            let view = unsafe {
                let view = view.as_hal::<Vulkan>().expect("a view of Vulkan's");
                view.raw_handle()
            };
            vk::RenderingAttachmentInfo::default()
                .image_view(view)
                .image_layout(layout)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)
        };
        let color = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let depth = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        let colors = [attachment(&self.color_view, color)];
        let depth = attachment(&self.depth_view, depth);
        let info = vk::RenderingInfo::default()
            .render_area(self.area())
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let device = host.rara.raw();
        // SAFETY: the caller's promise; the views are the target's.
        unsafe {
            device.cmd_begin_rendering(cmd, &info);
            device.cmd_set_scissor(cmd, 0, &[self.area()]);
        }
    }

    fn area(&self) -> vk::Rect2D {
        vk::Extent2D {
            width: self.color.width(),
            height: self.color.height(),
        }
        .into()
    }

    /// Records the copy that [`bytes`](Self::bytes) reads.
    pub(crate) fn read_back(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.readback,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row(&self.color)),
                    rows_per_image: None,
                },
            },
            self.color.size(),
        );
    }

    /// The picture's bytes, row by row, after everything submitted.
    pub(crate) fn bytes(&self, host: &Host) -> Result<Vec<u8>, Failure> {
        self.readback
            .map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("memory"));
        host.wait(None)?;
        let mapped = self.readback.get_mapped_range(..)?;
        let row = row(&self.color) as usize;
        let used = used(&self.color) as usize;
        let bytes = mapped.chunks_exact(row).flat_map(|row| &row[..used]);
        let bytes = bytes.copied().collect();
        drop(mapped);
        self.readback.unmap();
        Ok(bytes)
    }
}

/// Bytes of a row of a picture.
fn used(picture: &wgpu::Texture) -> u32 {
    let bytes = picture.format().block_copy_size(None);
    bytes.expect("a format of colours") * picture.width()
}

/// The same as it is read back.
fn row(picture: &wgpu::Texture) -> u32 {
    used(picture).next_multiple_of(ROW)
}
