//! Records passes into a host's command buffer: each has one name for label and timer, and its barriers follow from what the
//! shaders declare.

use ash::vk;
use smallvec::SmallVec;

use super::access::Access;
use super::depth_image::{DepthImage, DepthUnder};
use super::device::Device;
use super::label::{begin_pass, end_pass, under};
use super::memory::Buffer;
use super::pipeline::ComputePipeline;
use super::shader::MAX_BUFFERS;
use super::timer::Timer;
use super::tracker::{Draws, Tracker};
use rara_base::limits::GROUP_COLUMNS;

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy)]
pub enum Groups<'a> {
    /// A number, laid out as [`group_grid`] says; with 0 nothing is dispatched.
    Count(u32),
    /// A `VkDispatchIndirectCommand` in the buffer at this offset, a multiple of 4.
    Indirect(&'a Buffer, u64),
}

/// The grid for a linear number of workgroups: a row while `limit` allows, else rows of [`GROUP_COLUMNS`], the last of
/// which may be too long. Shaders compute `y * gl_NumWorkGroups.x + x` and return if that is past the end.
pub fn group_grid(count: u32, limit: u32) -> [u32; 3] {
    if count <= limit {
        return [count, 1, 1];
    }
    let rows = count.div_ceil(GROUP_COLUMNS);
    assert!(
        rows <= limit,
        "{count} workgroups are more than a dispatch can have on this device"
    );
    [GROUP_COLUMNS, rows, 1]
}

/// Records compute passes, fills and copies. Neither allocates device memory, nor waits, nor submits.
#[derive(Debug)]
pub struct Recorder<'a> {
    device: &'a Device,
    cmd: vk::CommandBuffer,
    tracker: Tracker,
    timer: Option<&'a mut Timer>,
}

impl<'a> Recorder<'a> {
    /// Begins with a barrier that orders the recording after everything earlier in the queue, but for draws that are elsewhere
    /// or have been waited for, and resets the timer.
    ///
    /// # Safety
    ///
    /// `cmd` must be recording on `device`, outside rendering, and stay so as long as the recorder lives; it must be
    /// submitted to the device's queue. All buffers and pipelines given to the recorder must be this device's and
    /// outlive the execution. Nobody else may record into `cmd` accesses to these buffers while the recorder lives.
    pub unsafe fn begin(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        draws: Draws,
        timer: Option<&'a mut Timer>,
    ) -> Self {
        let mut this = Self::new(device, cmd, draws, timer);
        this.barrier(&this.tracker.opening());
        if let Some(timer) = &mut this.timer {
            // SAFETY: the caller vouches for `cmd`; the timer's earlier recordings go to the same queue.
            unsafe { timer.reset(cmd) };
        }
        this
    }

    /// Begins a recording of copies alone, in any queue. Its barrier stands behind everything earlier in the queue; it has none
    /// where the memory that is written is new.
    ///
    /// # Safety
    /// As for [`begin`](Self::begin), of which the queue of `cmd` may be another than the device's.
    pub unsafe fn begin_copies(device: &'a Device, cmd: vk::CommandBuffer, into_new: bool) -> Self {
        let this = Self::new(device, cmd, Draws::Elsewhere, None);
        if !into_new {
            // Queues for transfers alone lack the stages of the vocabulary.
            this.barrier(
                &vk::MemoryBarrier2::default()
                    .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                    .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                    .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
                    .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE),
            );
        }
        this
    }

    fn new(
        device: &'a Device,
        cmd: vk::CommandBuffer,
        draws: Draws,
        timer: Option<&'a mut Timer>,
    ) -> Self {
        #[cfg(feature = "lab")]
        device.note_recording();
        Self {
            device,
            cmd,
            tracker: Tracker::new(device.support().mesh_shader, draws),
            timer,
        }
    }

    /// The command buffer.
    pub fn cmd(&self) -> vk::CommandBuffer {
        self.cmd
    }

    /// The device.
    pub fn device(&self) -> &'a Device {
        self.device
    }

    /// Records `record` as a pass: its name is the debug label and the timer's entry. Passes may nest.
    pub fn pass<R>(&mut self, name: &'static str, record: impl FnOnce(&mut Self) -> R) -> R {
        if self.times_dispatches() {
            return self.label(name, record);
        }
        self.timed(name, record)
    }

    fn times_dispatches(&self) -> bool {
        self.timer
            .as_ref()
            .is_some_and(|timer| timer.is_by_dispatch())
    }

    fn timed<R>(&mut self, name: &'static str, record: impl FnOnce(&mut Self) -> R) -> R {
        // SAFETY: `begin`'s contract covers `cmd`, and it reset the timer.
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

    /// Records `record` under a debug label, without timestamps, where it is no pass.
    pub fn label<R>(&mut self, name: &str, record: impl FnOnce(&mut Self) -> R) -> R {
        self.under(Some(name), record)
    }

    /// Dispatches a compute shader. `buffers[i]` is the buffer of binding `i`; the barrier follows from the shader's
    /// declarations.
    pub fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        buffers: &[&Buffer],
        params: &[u32],
        groups: Groups<'_>,
    ) {
        self.dispatch_on(pipeline, buffers, params, groups, None);
    }

    /// The same of a shader that reads an image.
    ///
    /// # Safety
    /// The view is this device's and outlives the execution, its image has the layout, and what was written there is visible to
    /// sampling by compute shaders.
    pub unsafe fn dispatch_on_image(
        &mut self,
        pipeline: &ComputePipeline,
        buffers: &[&Buffer],
        params: &[u32],
        groups: Groups<'_>,
        (view, layout): (vk::ImageView, vk::ImageLayout),
    ) {
        let image = vk::DescriptorImageInfo::default()
            .image_view(view)
            .image_layout(layout);
        self.dispatch_on(pipeline, buffers, params, groups, Some(image));
    }

    fn dispatch_on(
        &mut self,
        pipeline: &ComputePipeline,
        buffers: &[&Buffer],
        params: &[u32],
        groups: Groups<'_>,
        image: Option<vk::DescriptorImageInfo>,
    ) {
        let inner = pipeline.inner();
        inner.layout.check(pipeline.name(), buffers, params);
        if matches!(groups, Groups::Count(0)) {
            return;
        }
        let mut uses = [(vk::Buffer::null(), Access::ComputeRead); MAX_BUFFERS + 1];
        let mut count = 0;
        for (binding, access) in pipeline.accesses() {
            uses[count] = (buffers[binding].handle(), access);
            count += 1;
        }
        if let Groups::Indirect(args, offset) = groups {
            assert!(
                offset.is_multiple_of(4),
                "dispatch \"{}\": offset {offset} is no multiple of 4",
                pipeline.name()
            );
            args.check_range(offset, size_of::<vk::DispatchIndirectCommand>() as u64);
            uses[count] = (args.handle(), Access::IndirectRead);
            count += 1;
        }
        self.before(&uses[..count]);
        #[cfg(feature = "lab")]
        self.device.note_dispatch(pipeline.name(), groups);
        let record = |this: &mut Self| this.dispatch_now(pipeline, buffers, params, groups, image);
        if self.times_dispatches() {
            self.timed(pipeline.name(), |this| {
                this.await_timestamp();
                record(this);
            });
        } else {
            record(self);
        }
    }

    /// Lets what follows begin only when the timestamp before it is written. A timestamp waits for what comes before it, and
    /// nothing waits for the timestamp: lavapipe, where a host has drawn before, writes it no sooner than the next barrier.
    fn await_timestamp(&self) {
        self.barrier(
            &vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS),
        );
    }

    fn dispatch_now(
        &self,
        pipeline: &ComputePipeline,
        buffers: &[&Buffer],
        params: &[u32],
        groups: Groups<'_>,
        image: Option<vk::DescriptorImageInfo>,
    ) {
        let inner = pipeline.inner();
        let raw = self.device.raw();
        // SAFETY: `begin`'s contract covers `cmd`, pipeline and buffers; the layout is the pipeline's, the grid is within
        // the limits and the arguments lie inside their buffer.
        unsafe {
            raw.cmd_bind_pipeline(self.cmd, vk::PipelineBindPoint::COMPUTE, inner.raw);
            inner.layout.push(
                self.cmd,
                vk::PipelineBindPoint::COMPUTE,
                buffers,
                params,
                image,
            );
            match groups {
                Groups::Count(count) => {
                    let [x, y, z] = group_grid(count, self.device.support().max_group_count);
                    raw.cmd_dispatch(self.cmd, x, y, z);
                }
                Groups::Indirect(args, offset) => {
                    raw.cmd_dispatch_indirect(self.cmd, args.handle(), offset)
                }
            }
        }
    }

    /// Fills `size` bytes at `offset`, both multiples of 4, with a word.
    pub fn fill(&mut self, buffer: &Buffer, offset: u64, size: u64, word: u32) {
        aligned("fill", buffer, offset, size);
        if size == 0 {
            return;
        }
        self.before(&[(buffer.handle(), Access::TransferWrite)]);
        // SAFETY: `begin`'s contract covers `cmd` and buffer; the range is inside and aligned.
        unsafe {
            self.device
                .raw()
                .cmd_fill_buffer(self.cmd, buffer.handle(), offset, size, word)
        };
    }

    /// Writes bytes that travel in the command buffer, for small data: offset and length are multiples of 4.
    pub fn update(&mut self, buffer: &Buffer, offset: u64, data: &[u8]) {
        /// The most that one command can carry.
        const CHUNK: usize = 65_536;
        aligned("update", buffer, offset, data.len() as u64);
        if data.is_empty() {
            return;
        }
        self.before(&[(buffer.handle(), Access::TransferWrite)]);
        for (at, chunk) in (offset..).step_by(CHUNK).zip(data.chunks(CHUNK)) {
            // SAFETY: `begin`'s contract covers `cmd` and buffer; the range is inside, aligned and not too large.
            unsafe {
                self.device
                    .raw()
                    .cmd_update_buffer(self.cmd, buffer.handle(), at, chunk)
            };
        }
    }

    /// Copies regions, which must not overlap, from one buffer to another.
    pub fn copy(&mut self, source: &Buffer, target: &Buffer, regions: &[vk::BufferCopy]) {
        assert!(
            source.handle() != target.handle(),
            "buffer \"{}\" cannot be copied onto itself",
            source.name()
        );
        for region in regions {
            assert!(
                region.size > 0,
                "a copy from \"{}\" to \"{}\" has no bytes",
                source.name(),
                target.name()
            );
            source.check_range(region.src_offset, region.size);
            target.check_range(region.dst_offset, region.size);
        }
        if regions.is_empty() {
            return;
        }
        self.before(&[
            (source.handle(), Access::TransferRead),
            (target.handle(), Access::TransferWrite),
        ]);
        // SAFETY: `begin`'s contract covers `cmd` and buffers; the regions are inside.
        unsafe {
            self.device
                .raw()
                .cmd_copy_buffer(self.cmd, source.handle(), target.handle(), regions)
        };
    }

    /// Copies the depths of a host's image that lie under a viewport, row by row and without gaps.
    ///
    /// # Safety
    /// The image is as its description says, its depths are visible to `COPY` by `TRANSFER_READ`, and it outlives the
    /// execution.
    pub unsafe fn copy_depth(&mut self, from: &DepthImage, to: &Buffer, under: &DepthUnder) {
        let ([x, y], extent) = (under.first, under.part.extent);
        if extent.width == 0 || extent.height == 0 {
            return;
        }
        let pixels = u64::from(extent.width) * u64::from(extent.height);
        to.check_range(0, pixels * 4);
        self.before(&[(to.handle(), Access::TransferWrite)]);
        let region = vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::DEPTH)
                    .base_array_layer(from.layer)
                    .layer_count(1),
            )
            .image_offset(vk::Offset3D { x, y, z: 0 })
            .image_extent(extent.into());
        // SAFETY: `begin`'s contract covers `cmd` and the buffer, which has room for four bytes a pixel, the most that a
        // depth takes; the caller vouches for the image, and the region lies inside.
        unsafe {
            self.device.raw().cmd_copy_image_to_buffer(
                self.cmd,
                from.image,
                from.layout,
                to.handle(),
                &[region],
            )
        };
    }

    /// Copies regions, none of which meets another, from a buffer that is not ours to one that is.
    ///
    /// # Safety
    ///
    /// `source` must be this device's, hold the regions' bytes, be made to be copied from, and outlive the execution; its
    /// bytes must be visible to the copy.
    pub unsafe fn copy_from(
        &mut self,
        source: vk::Buffer,
        target: &Buffer,
        regions: &[vk::BufferCopy],
    ) {
        for region in regions {
            target.check_range(region.dst_offset, region.size);
        }
        let regions: Vec<_> = regions
            .iter()
            .copied()
            .filter(|region| region.size > 0)
            .collect();
        if regions.is_empty() {
            return;
        }
        self.before(&[(target.handle(), Access::TransferWrite)]);
        // SAFETY: `begin`'s contract covers `cmd` and `target`, the caller vouches for `source`.
        unsafe {
            self.device
                .raw()
                .cmd_copy_buffer(self.cmd, source, target.handle(), &regions)
        };
    }

    /// Makes buffers visible to draws later in the command buffer, as storage and arguments, so that they need no
    /// barrier inside a rendering scope. Draws in another queue see what the host's semaphore makes visible.
    pub fn ready_to_draw(&mut self, buffers: &[&Buffer]) {
        if self.tracker.draws() == Draws::Elsewhere {
            return;
        }
        self.ready(buffers, &[Access::DrawRead, Access::IndirectRead]);
    }

    /// Makes buffers visible to the host, once it has waited for the submission.
    pub fn ready_for_host(&mut self, buffers: &[&Buffer]) {
        self.ready(buffers, &[Access::HostRead]);
    }

    fn ready(&mut self, buffers: &[&Buffer], accesses: &[Access]) {
        let uses: SmallVec<[_; 24]> = buffers
            .iter()
            .flat_map(|buffer| accesses.iter().map(|access| (buffer.handle(), *access)))
            .collect();
        self.before(&uses);
    }

    fn before(&mut self, uses: &[(vk::Buffer, Access)]) {
        if let Some(barrier) = self.tracker.pass(uses) {
            self.barrier(&barrier);
        }
    }

    fn barrier(&self, barrier: &vk::MemoryBarrier2<'_>) {
        #[cfg(feature = "lab")]
        self.device
            .note_barrier(barrier.src_stage_mask | barrier.dst_stage_mask);
        let info = vk::DependencyInfo::default().memory_barriers(std::slice::from_ref(barrier));
        // SAFETY: `begin`'s contract covers `cmd`; the masks come from the table of accesses, for this device's stages.
        unsafe { self.device.commands().pipeline_barrier(self.cmd, &info) };
    }
}

fn aligned(what: &str, buffer: &Buffer, offset: u64, size: u64) {
    assert!(
        offset.is_multiple_of(4) && size.is_multiple_of(4),
        "{what} of buffer \"{}\": offset {offset} and size {size} must be multiples of 4",
        buffer.name()
    );
    buffer.check_range(offset, size);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_hold_every_group_within_the_limits() {
        assert_eq!(group_grid(1, 65_535), [1, 1, 1]);
        assert_eq!(group_grid(65_535, 65_535), [65_535, 1, 1]);
        assert_eq!(group_grid(65_536, 65_535), [GROUP_COLUMNS, 2, 1]);
        assert_eq!(group_grid(65_537, 65_535), [GROUP_COLUMNS, 3, 1]);
        assert_eq!(group_grid(1 << 30, u32::MAX), [1 << 30, 1, 1]);
    }

    #[test]
    #[should_panic(expected = "more than a dispatch can have")]
    fn too_many_groups_are_refused() {
        group_grid(u32::MAX, 65_535);
    }
}
