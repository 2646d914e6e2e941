//! What one submission at a time is recorded into.

use ash::vk;

use super::device::Device;
use super::failure::failed;
use rara_base::error::Result;

/// A command buffer for one submission at a time, with the fence that says when it is done.
#[derive(Default)]
pub(super) struct Submission {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    pub(super) fence: vk::Fence,
}

impl Submission {
    pub(super) fn new(device: &Device, name: &str) -> Result<Self> {
        let mut this = Self::default();
        match this.make(device) {
            Ok(()) => {
                device.set_name(this.pool, name);
                device.set_name(this.cmd, name);
                device.set_name(this.fence, name);
                Ok(this)
            }
            Err(error) => {
                this.destroy(device.raw());
                Err(error)
            }
        }
    }

    fn make(&mut self, device: &Device) -> Result<()> {
        let raw = device.raw();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(device.queue_family());
        // SAFETY: the device is alive as long as `device`, also for the calls below.
        self.pool = unsafe { raw.create_command_pool(&info, None) }
            .map_err(failed("vkCreateCommandPool"))?;
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(1);
        // SAFETY: the pool was created just now.
        self.cmd = unsafe { raw.allocate_command_buffers(&info) }
            .map_err(failed("vkAllocateCommandBuffers"))?[0];
        // SAFETY: as above.
        self.fence = unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }
            .map_err(failed("vkCreateFence"))?;
        Ok(())
    }

    /// Records the commands of the next submission. After an error nothing may be submitted.
    ///
    /// # Safety
    /// The last submission is over. `record` leaves the command buffer outside rendering.
    pub(super) unsafe fn record<R>(
        &self,
        device: &Device,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R>,
    ) -> Result<R> {
        let raw = device.raw();
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the last submission is over, says the caller.
        unsafe { raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()) }
            .map_err(failed("vkResetCommandPool"))?;
        // SAFETY: as above, the command buffer is initial.
        unsafe { raw.begin_command_buffer(self.cmd, &begin) }
            .map_err(failed("vkBeginCommandBuffer"))?;
        let recorded = record(self.cmd)?; // after an error the next reset undoes the recording
        // SAFETY: it is recording.
        unsafe { raw.end_command_buffer(self.cmd) }.map_err(failed("vkEndCommandBuffer"))?;
        Ok(recorded)
    }

    /// Submits what was recorded; the fence is signalled when it is done.
    ///
    /// # Safety
    /// [`record`](Self::record) has succeeded since the last submission, the fence is unsignalled, and the semaphores are as
    /// Vulkan wants them.
    pub(super) unsafe fn submit(
        &self,
        device: &Device,
        waits: &[vk::SemaphoreSubmitInfo<'_>],
        signals: &[vk::SemaphoreSubmitInfo<'_>],
    ) -> Result<()> {
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.cmd)];
        let submit = vk::SubmitInfo2::default()
            .wait_semaphore_infos(waits)
            .command_buffer_infos(&commands)
            .signal_semaphore_infos(signals);
        let queue = device.lock_queue();
        // SAFETY: the lock keeps our threads from the queue, the host keeps its own (see `Device::adopt`); the caller
        // vouches for the rest.
        unsafe { device.commands().submit(*queue, &submit, self.fence) }
            .map_err(failed("vkQueueSubmit2"))
    }

    /// Destroys it, which no submission uses any more.
    pub(super) fn destroy(&self, raw: &ash::Device) {
        // SAFETY: it is idle, and null handles are ignored.
        unsafe {
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
