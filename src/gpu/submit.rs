//! Records, submits and waits, for headless frames, uploads and downloads.

use std::sync::{MutexGuard, PoisonError};

use ash::vk;

use super::device::Device;
use super::failure::failed;
use super::submission::Submission;
use rara_base::error::Result;

impl Submission {
    /// One without commands; the name is for debuggers and validation messages.
    pub fn new(device: &Device, name: &str) -> Result<Self> {
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
    pub unsafe fn record<R>(
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
    pub unsafe fn submit(
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
}

/// A [`Submission`] in use; it returns to the idle ones even if recording panics.
struct Lease<'a> {
    device: &'a Device,
    submission: Option<Submission>,
}

impl<'a> Lease<'a> {
    fn new(device: &'a Device) -> Result<Self> {
        let idle = device.lock_idle().pop();
        let submission = match idle {
            Some(submission) => submission,
            None => Submission::new(device, "one-off")?,
        };
        Ok(Self {
            device,
            submission: Some(submission),
        })
    }
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        self.device.lock_idle().extend(self.submission.take());
    }
}

impl Device {
    /// Records a command buffer with `record`, submits it and waits until the device is done. If `record` fails,
    /// nothing is submitted. May be called by several threads, and from inside `record`.
    pub fn submit_and_wait<R>(
        &self,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R>,
    ) -> Result<R> {
        let lease = Lease::new(self)?;
        let submission = lease.submission.as_ref().expect("taken only by drop");
        let raw = self.raw();
        // The fence is reset here and not after the wait: then it is unsignalled whatever failed last time.
        // SAFETY: nothing uses the fence: the submission is from the idle ones.
        unsafe { raw.reset_fences(&[submission.fence]) }.map_err(failed("vkResetFences"))?;
        // SAFETY: as above, its last use is over.
        let result = unsafe { submission.record(self, record) }?;
        // SAFETY: it was recorded just now, the fence is unsignalled, and there are no semaphores.
        unsafe { submission.submit(self, &[], &[]) }?;
        // SAFETY: the fence belongs to the submission above.
        let waited = unsafe { raw.wait_for_fences(&[submission.fence], true, u64::MAX) };
        if waited.is_err() {
            // After the error the caller frees what the submission uses.
            // SAFETY: as above; whatever this returns, nothing more can be done.
            let _ = unsafe { raw.device_wait_idle() };
        }
        waited.map_err(failed("vkWaitForFences"))?;
        Ok(result)
    }

    /// The queue, which no other thread of ours uses meanwhile.
    #[doc(hidden)]
    pub fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        let queue = self.inner.queue.lock();
        queue.unwrap_or_else(PoisonError::into_inner)
    }

    fn lock_idle(&self) -> MutexGuard<'_, Vec<Submission>> {
        let idle = self.inner.idle.lock();
        idle.unwrap_or_else(PoisonError::into_inner)
    }
}
