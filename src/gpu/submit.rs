//! Records, submits and waits, for headless frames, uploads and downloads.

use std::sync::{MutexGuard, PoisonError};

use ash::vk;

use super::device::Device;
use super::failure::failed;
use super::one_off::OneOff;
use rara_base::error::Result;

impl OneOff {
    fn new(device: &Device) -> Result<Self> {
        let raw = device.raw();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(device.queue_family());
        // SAFETY: the device is alive as long as `device`, also for the calls below.
        let pool = unsafe { raw.create_command_pool(&info, None) }
            .map_err(failed("vkCreateCommandPool"))?;
        let mut this = Self {
            pool,
            cmd: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
        };
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(1);
        // SAFETY: the pool was created just now.
        let made = unsafe { raw.allocate_command_buffers(&info) }
            .map_err(failed("vkAllocateCommandBuffers"))
            .and_then(|cmd| {
                this.cmd = cmd[0];
                // SAFETY: as above.
                unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }
                    .map_err(failed("vkCreateFence"))
            });
        match made {
            Ok(fence) => {
                this.fence = fence;
                device.set_name(this.pool, "one-off");
                device.set_name(this.cmd, "one-off");
                device.set_name(this.fence, "one-off");
                Ok(this)
            }
            Err(error) => {
                this.destroy(raw);
                Err(error)
            }
        }
    }

    fn run(
        &self,
        device: &Device,
        record: impl FnOnce(vk::CommandBuffer) -> Result<()>,
    ) -> Result<()> {
        let raw = device.raw();
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the pool's last submission is over: a `OneOff` is taken from the idle ones.
        unsafe { raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty()) }
            .map_err(failed("vkResetCommandPool"))?;
        // The fence is reset here and not after the wait: then it is unsignalled whatever failed last time.
        // SAFETY: as above, nothing uses the fence.
        unsafe { raw.reset_fences(&[self.fence]) }.map_err(failed("vkResetFences"))?;
        // SAFETY: as above, the command buffer is initial.
        unsafe { raw.begin_command_buffer(self.cmd, &begin) }
            .map_err(failed("vkBeginCommandBuffer"))?;
        let recorded = record(self.cmd);
        // SAFETY: it is recording.
        unsafe { raw.end_command_buffer(self.cmd) }.map_err(failed("vkEndCommandBuffer"))?;
        recorded?;

        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.cmd)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        {
            let queue = device.lock_queue();
            // SAFETY: the lock keeps our threads from the queue, the host keeps its own (see `Device::adopt`); the fence
            // is unsignalled and the command buffer executable.
            unsafe { device.commands().submit(*queue, &submit, self.fence) }
                .map_err(failed("vkQueueSubmit2"))?;
        }
        // SAFETY: the fence belongs to the submission above.
        let waited = unsafe { raw.wait_for_fences(&[self.fence], true, u64::MAX) };
        if waited.is_err() {
            // After the error the caller frees what the submission uses.
            // SAFETY: as above; whatever this returns, nothing more can be done.
            let _ = unsafe { raw.device_wait_idle() };
        }
        waited.map_err(failed("vkWaitForFences"))
    }
}

/// A [`OneOff`] in use; it returns to the idle ones even if recording panics.
struct Lease<'a> {
    device: &'a Device,
    one_off: Option<OneOff>,
}

impl<'a> Lease<'a> {
    fn new(device: &'a Device) -> Result<Self> {
        let idle = device.lock_idle().pop();
        let one_off = match idle {
            Some(one_off) => one_off,
            None => OneOff::new(device)?,
        };
        Ok(Self {
            device,
            one_off: Some(one_off),
        })
    }
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        self.device.lock_idle().extend(self.one_off.take());
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
        let one_off = lease.one_off.as_ref().expect("taken only by drop");
        let mut result = None;
        one_off.run(self, |cmd| {
            result = Some(record(cmd)?);
            Ok(())
        })?;
        Ok(result.expect("run succeeds only after record did"))
    }

    /// The queue, which no other thread of ours uses meanwhile.
    pub(super) fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        let queue = self.inner.queue.lock();
        queue.unwrap_or_else(PoisonError::into_inner)
    }

    fn lock_idle(&self) -> MutexGuard<'_, Vec<OneOff>> {
        let idle = self.inner.idle.lock();
        idle.unwrap_or_else(PoisonError::into_inner)
    }
}
