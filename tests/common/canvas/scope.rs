//! The scopes of a canvas: its depths before, and the two ways to begin one.

use rara::ash::vk;

use super::image::Image;
use super::{COLOR, Canvas, DEPTH};

impl Canvas {
    /// # Safety
    /// `cmd` is recording outside a scope.
    pub(super) unsafe fn paint_depth(&self, cmd: vk::CommandBuffer, depth: &Image) {
        let value = |depth| vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 },
        };
        let attachment = vk::RenderingAttachmentInfo::default()
            .image_view(depth.view)
            .image_layout(DEPTH)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(value(self.desc.far));
        let info = vk::RenderingInfo::default()
            .render_area(self.desc.extent.into())
            .layer_count(self.desc.layers)
            .depth_attachment(&attachment);
        // SAFETY: the caller vouches for `cmd`.
        unsafe {
            self.raw.cmd_begin_rendering(cmd, &info);
            for (rect, depth) in &self.desc.meshes {
                let clear = vk::ClearAttachment {
                    aspect_mask: vk::ImageAspectFlags::DEPTH,
                    color_attachment: 0,
                    clear_value: value(*depth),
                };
                let area = vk::ClearRect {
                    rect: *rect,
                    base_array_layer: 0,
                    layer_count: self.desc.layers,
                };
                self.raw.cmd_clear_attachments(cmd, &[clear], &[area]);
            }
            self.raw.cmd_end_rendering(cmd);
        }
    }

    /// # Safety
    /// `cmd` is recording outside a scope.
    pub(super) unsafe fn begin(&self, cmd: vk::CommandBuffer, clears: bool) {
        let colour = |float32| vk::ClearValue {
            color: vk::ClearColorValue { float32 },
        };
        let (first, second) = (colour(self.desc.clear), colour([0.0; 4]));
        if self.desc.render_pass {
            let mut clears = vec![first];
            clears.extend(self.second.as_ref().map(|_| second));
            let info = vk::RenderPassBeginInfo::default()
                .render_pass(self.render_pass)
                .framebuffer(self.framebuffer)
                .render_area(self.desc.extent.into())
                .clear_values(&clears);
            let contents = vk::SubpassContents::INLINE;
            // SAFETY: the caller vouches for `cmd`.
            unsafe { self.raw.cmd_begin_render_pass(cmd, &info, contents) };
            return;
        }
        let load = if clears {
            vk::AttachmentLoadOp::CLEAR
        } else {
            vk::AttachmentLoadOp::LOAD
        };
        let attach = |image: &Image, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(COLOR)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let mut colors = vec![attach(&self.color, first)];
        if let Some(resolved) = &self.resolved {
            colors[0] = colors[0]
                .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                .resolve_image_view(resolved.view)
                .resolve_image_layout(COLOR);
        }
        colors.extend(self.second.as_ref().map(|image| attach(image, second)));
        let mut info = vk::RenderingInfo::default()
            .render_area(self.desc.extent.into())
            .layer_count(1) // no matter where there is a mask
            .view_mask(self.view_mask())
            .color_attachments(&colors);
        let depth = self.depth.as_ref().map(|depth| {
            vk::RenderingAttachmentInfo::default()
                .image_view(depth.view)
                .image_layout(DEPTH)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)
        });
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: the caller vouches for `cmd`.
        unsafe { self.raw.cmd_begin_rendering(cmd, &info) };
    }

    pub(super) fn make_render_pass(&mut self) {
        let one = self.desc.samples == vk::SampleCountFlags::TYPE_1;
        assert!(
            one && self.second.is_none(),
            "only simple render passes here"
        );
        let attachment = |image: &Image, load, layout| {
            vk::AttachmentDescription::default()
                .format(image.format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
                .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                .initial_layout(layout)
                .final_layout(layout)
        };
        let mut descriptions = vec![attachment(&self.color, vk::AttachmentLoadOp::CLEAR, COLOR)];
        let mut views = vec![self.color.view];
        if let Some(depth) = &self.depth {
            descriptions.push(attachment(depth, vk::AttachmentLoadOp::LOAD, DEPTH));
            views.push(depth.view);
        }
        let reference = |attachment, layout| vk::AttachmentReference { attachment, layout };
        let colors = [reference(0, COLOR)];
        let depth = reference(1, DEPTH);
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colors);
        if self.depth.is_some() {
            subpass = subpass.depth_stencil_attachment(&depth);
        }
        let subpasses = [subpass];
        let masks = [self.view_mask()];
        let mut views_of_pass = vk::RenderPassMultiviewCreateInfo::default().view_masks(&masks);
        let mut info = vk::RenderPassCreateInfo::default()
            .attachments(&descriptions)
            .subpasses(&subpasses);
        if masks[0] != 0 {
            info = info.push_next(&mut views_of_pass);
        }
        // SAFETY: the device is alive, and everything pointed to outlives the calls.
        unsafe {
            self.render_pass = self.raw.create_render_pass(&info, None).expect("a pass");
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(self.render_pass)
                .attachments(&views)
                .width(self.desc.extent.width)
                .height(self.desc.extent.height)
                .layers(1);
            self.framebuffer = self.raw.create_framebuffer(&info, None).expect("memory");
        }
    }
}
