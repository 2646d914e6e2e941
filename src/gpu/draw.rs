//! Draws inside a rendering scope that somebody else began. They need no barriers: [`Recorder::ready_to_draw`] set them.
//!
//! [`Recorder::ready_to_draw`]: super::Recorder::ready_to_draw

use ash::vk;

use super::device::Device;
use super::label::{begin_pass, end_pass, under};
use super::memory::Buffer;
use super::pipeline::GraphicsPipeline;
use super::timer::Timer;

/// Records draws whose number stands in buffers.
#[derive(Debug)]
pub struct Drawer<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
    timer: Option<&'a mut Timer>,
}

impl<'a> Drawer<'a> {
    /// Takes up a command buffer inside a rendering scope. The timer is one that a recorder reset in the same frame.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on `device` inside a rendering scope with the pipelines' attachments, and stay so as long as
    /// the drawer lives. All buffers and pipelines given to the drawer must be this device's and outlive the execution,
    /// and the buffers must have been made ready to draw after their last write.
    pub unsafe fn new(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        timer: Option<&'a mut Timer>,
    ) -> Self {
        Self { device, cmd, timer }
    }

    /// Records `record` as a pass: its name is the debug label and the timer's entry.
    pub fn pass<R>(&mut self, name: &'static str, record: impl FnOnce(&mut Self) -> R) -> R {
        // SAFETY: `new`'s contract covers `cmd`, and that the timer was reset before.
        let timed = unsafe { begin_pass(self.device, self.cmd, self.timer.as_deref_mut(), name) };
        let result = record(self);
        // SAFETY: as above.
        unsafe { end_pass(self.device, self.cmd, self.timer.as_deref_mut(), timed) };
        result
    }

    /// Records `record` under a debug label of a name, if there is one.
    pub fn under<R>(&mut self, name: Option<&str>, record: impl FnOnce(&mut Self) -> R) -> R {
        under(self, (self.device, self.cmd), name, record)
    }

    /// Sets viewport and scissor to a rectangle of the attachment.
    pub fn viewport(&mut self, area: vk::Rect2D) {
        let vk::Extent2D { width, height } = area.extent;
        let origin = [area.offset.x as f32, area.offset.y as f32];
        self.picture(origin, [width as f32, height as f32]);
        // SAFETY: `new`'s contract covers `cmd`.
        unsafe { self.device.raw().cmd_set_scissor(self.cmd, 0, &[area]) };
    }

    /// Sets the viewport alone, to a picture whose upper left corner is at `origin` in the attachment, px. Whatever viewport
    /// was set before, one of negative height too, has no say in the draws after it.
    pub fn picture(&mut self, [x, y]: [f32; 2], [width, height]: [f32; 2]) {
        let viewport = vk::Viewport {
            x,
            y,
            width,
            height,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: `new`'s contract covers `cmd`.
        unsafe { self.device.raw().cmd_set_viewport(self.cmd, 0, &[viewport]) };
    }

    /// Draws with the `VkDrawIndirectCommand` at `offset` in `args`. `buffers[i]` is the buffer of binding `i`.
    pub fn draw_indirect(
        &mut self,
        pipeline: &GraphicsPipeline,
        buffers: &[&Buffer],
        params: &[u32],
        args: &Buffer,
        offset: u64,
    ) {
        self.bind(pipeline, false, buffers, params);
        check_args::<vk::DrawIndirectCommand>(args, offset);
        // SAFETY: `new`'s contract covers `cmd` and `args`, which hold a whole command at an aligned offset.
        unsafe {
            self.device
                .raw()
                .cmd_draw_indirect(self.cmd, args.handle(), offset, 1, 0)
        };
    }

    /// Draws with the `VkDrawMeshTasksIndirectCommandEXT` at `offset` in `args`.
    pub fn draw_mesh_tasks_indirect(
        &mut self,
        pipeline: &GraphicsPipeline,
        buffers: &[&Buffer],
        params: &[u32],
        args: &Buffer,
        offset: u64,
    ) {
        self.bind(pipeline, true, buffers, params);
        check_args::<vk::DrawMeshTasksIndirectCommandEXT>(args, offset);
        let mesh = self
            .device
            .mesh_shader()
            .expect("a mesh pipeline exists only where the extension does");
        // SAFETY: as for `draw_indirect`.
        unsafe { mesh.cmd_draw_mesh_tasks_indirect(self.cmd, args.handle(), offset, 1, 0) };
    }

    fn bind(&self, pipeline: &GraphicsPipeline, mesh: bool, buffers: &[&Buffer], params: &[u32]) {
        let name = pipeline.name();
        let kind = |mesh| if mesh { "mesh" } else { "vertex" };
        assert!(
            pipeline.is_mesh() == mesh,
            "pipeline \"{name}\" has a {} shader and this draw wants a {} shader",
            kind(pipeline.is_mesh()),
            kind(mesh)
        );
        let inner = pipeline.inner();
        inner.layout.check(name, buffers, params);
        // SAFETY: `new`'s contract covers `cmd`, pipeline and buffers; the layout is the pipeline's.
        unsafe {
            self.device.raw().cmd_bind_pipeline(
                self.cmd,
                vk::PipelineBindPoint::GRAPHICS,
                inner.raw,
            );
            inner.layout.push(
                self.cmd,
                vk::PipelineBindPoint::GRAPHICS,
                buffers,
                params,
                None,
            );
        }
    }
}

/// Panics with a sentence unless a whole command lies at the offset.
fn check_args<Command>(args: &Buffer, offset: u64) {
    assert!(
        offset.is_multiple_of(4),
        "draw arguments at {offset} in \"{}\": no multiple of 4",
        args.name()
    );
    args.check_range(offset, size_of::<Command>() as u64);
}
