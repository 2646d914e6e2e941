//! Frames that are recorded while earlier ones are still drawn.

use ash::vk;

use super::device::Device;
use super::failure::failed;
use rara_base::error::Result;

/// How many frames may be unfinished at once: one is drawn while the next is recorded.
pub const FRAMES: usize = 2;

/// Command buffers, fences and semaphores of the frames in flight.
pub struct InFlight {
    slots: Vec<Slot>,
    /// The slot of the next frame.
    next: usize,
    device: Device,
}

#[derive(Default)]
struct Slot {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    /// Signalled when the frame's image may be drawn into.
    acquired: vk::Semaphore,
    /// True when a submission will signal, or has signalled, the fence.
    submitted: bool,
}

impl InFlight {
    #[doc(hidden)]
    pub fn new(device: &Device) -> Result<Self> {
        // From here on dropping `this` cleans up.
        let mut this = Self {
            slots: Vec::new(),
            next: 0,
            device: device.clone(),
        };
        for _ in 0..FRAMES {
            this.slots.push(Slot::default());
            let slot = this.slots.last_mut().expect("pushed above");
            let raw = device.raw();
            let info = vk::CommandPoolCreateInfo::default()
                .flags(vk::CommandPoolCreateFlags::TRANSIENT)
                .queue_family_index(device.queue_family());
            // SAFETY: the device is alive as long as `this`, also for the calls below.
            slot.pool = unsafe { raw.create_command_pool(&info, None) }
                .map_err(failed("vkCreateCommandPool"))?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(slot.pool)
                .command_buffer_count(1);
            // SAFETY: the pool was created just now.
            slot.cmd = unsafe { raw.allocate_command_buffers(&info) }
                .map_err(failed("vkAllocateCommandBuffers"))?[0];
            // SAFETY: as above.
            slot.fence = unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }
                .map_err(failed("vkCreateFence"))?;
            // SAFETY: as above.
            slot.acquired =
                unsafe { raw.create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }
                    .map_err(failed("vkCreateSemaphore"))?;
            device.set_name(slot.cmd, "frame");
            device.set_name(slot.acquired, "acquired");
        }
        Ok(this)
    }

    /// Waits for the oldest frame, so that the next one may reuse its slot.
    #[doc(hidden)]
    pub fn wait(&mut self) -> Result<()> {
        self.wait_for(self.next)
    }

    /// Waits for all frames.
    #[doc(hidden)]
    pub fn wait_for_all(&mut self) -> Result<()> {
        (0..FRAMES).try_for_each(|slot| self.wait_for(slot))
    }

    fn wait_for(&mut self, slot: usize) -> Result<()> {
        let slot = &mut self.slots[slot];
        if !slot.submitted {
            return Ok(());
        }
        let raw = self.device.raw();
        // SAFETY: the fence belongs to a submission; after the wait it is signalled and nothing waits for it.
        unsafe { raw.wait_for_fences(&[slot.fence], true, u64::MAX) }
            .map_err(failed("vkWaitForFences"))?;
        slot.submitted = false;
        // SAFETY: as above.
        unsafe { raw.reset_fences(&[slot.fence]) }.map_err(failed("vkResetFences"))
    }

    /// The number of the next frame's slot, below [`FRAMES`]. After [`wait`](Self::wait) nothing uses it.
    #[doc(hidden)]
    pub fn next(&self) -> usize {
        self.next
    }

    /// The semaphore with which the next frame's image is acquired, after [`wait`](Self::wait).
    #[doc(hidden)]
    pub fn acquired(&self) -> vk::Semaphore {
        self.slots[self.next].acquired
    }

    /// Records the next frame and submits it; `drawn` is signalled when its image is complete.
    ///
    /// # Safety
    /// [`wait`](Self::wait) was called before, an image was acquired with [`acquired`](Self::acquired), and everything that
    /// `record` uses lives until the frame has been waited for. `record` leaves `cmd` outside rendering. `drawn` is
    /// unsignalled.
    #[doc(hidden)]
    pub unsafe fn submit(
        &mut self,
        drawn: vk::Semaphore,
        record: impl FnOnce(vk::CommandBuffer) -> Result<()>,
    ) -> Result<()> {
        let raw = self.device.raw();
        let slot = &mut self.slots[self.next];
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot's last submission was waited for, says the caller.
        unsafe { raw.reset_command_pool(slot.pool, vk::CommandPoolResetFlags::empty()) }
            .map_err(failed("vkResetCommandPool"))?;
        // SAFETY: as above, the command buffer is initial.
        unsafe { raw.begin_command_buffer(slot.cmd, &begin) }
            .map_err(failed("vkBeginCommandBuffer"))?;
        record(slot.cmd)?; // after an error nothing is submitted, and the next reset undoes the recording
        // SAFETY: it is recording.
        unsafe { raw.end_command_buffer(slot.cmd) }.map_err(failed("vkEndCommandBuffer"))?;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(slot.cmd)];
        // Only the drawing waits for the image, and not what comes before.
        let waits = [vk::SemaphoreSubmitInfo::default()
            .semaphore(slot.acquired)
            .stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)];
        // The semaphore waits for all commands: the image's transition to the layout for showing is in no single stage.
        let signals = [vk::SemaphoreSubmitInfo::default()
            .semaphore(drawn)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let submit = vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(&commands)
            .signal_semaphore_infos(&signals);
        let queue = self.device.lock_queue();
        // SAFETY: the lock keeps our threads from the queue; the fence is unsignalled, the command buffer executable, and
        // the caller vouches for the semaphores.
        unsafe { self.device.commands().submit(*queue, &submit, slot.fence) }
            .map_err(failed("vkQueueSubmit2"))?;
        drop(queue);
        slot.submitted = true;
        self.next = (self.next + 1) % FRAMES;
        Ok(())
    }
}

impl Drop for InFlight {
    fn drop(&mut self) {
        let _queue = self.device.lock_queue();
        let raw = self.device.raw();
        // SAFETY: the device's only queue is locked, and nothing is in use after the first call, or the device is lost;
        // null handles are ignored.
        unsafe {
            let _ = raw.device_wait_idle();
            for slot in &self.slots {
                raw.destroy_command_pool(slot.pool, None);
                raw.destroy_fence(slot.fence, None);
                raw.destroy_semaphore(slot.acquired, None);
            }
        }
    }
}
