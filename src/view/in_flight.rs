//! Frames that are recorded while earlier ones are still drawn.

use rara::Result;
use rara::ash::vk;
use rara_gpu::{Device, Submission, failed};

/// How many frames may be unfinished at once: one is drawn while the next is recorded.
pub(crate) const FRAMES: usize = 2;

/// Command buffers, fences and semaphores of the frames in flight.
pub(crate) struct InFlight {
    slots: Vec<Slot>,
    next: usize,
    device: Device,
}

struct Slot {
    submission: Submission,
    /// Signalled when the frame's image may be drawn into.
    acquired: vk::Semaphore,
    /// True when a submission will signal, or has signalled, the fence.
    submitted: bool,
}

impl InFlight {
    pub(crate) fn new(device: &Device) -> Result<Self> {
        // From here on dropping `this` cleans up.
        let mut this = Self {
            slots: Vec::new(),
            next: 0,
            device: device.clone(),
        };
        for _ in 0..FRAMES {
            this.slots.push(Slot {
                submission: Submission::new(device, "frame")?,
                acquired: vk::Semaphore::null(),
                submitted: false,
            });
            let slot = this.slots.last_mut().expect("pushed above");
            let info = vk::SemaphoreCreateInfo::default();
            // SAFETY: the device is alive as long as `this`.
            slot.acquired = unsafe { device.raw().create_semaphore(&info, None) }
                .map_err(failed("vkCreateSemaphore"))?;
            device.set_name(slot.acquired, "acquired");
        }
        Ok(this)
    }

    /// Waits for the oldest frame, so that the next one may reuse its slot.
    pub(crate) fn wait(&mut self) -> Result<()> {
        self.wait_for(self.next)
    }

    /// Waits for all frames.
    pub(crate) fn wait_for_all(&mut self) -> Result<()> {
        (0..FRAMES).try_for_each(|slot| self.wait_for(slot))
    }

    fn wait_for(&mut self, slot: usize) -> Result<()> {
        let slot = &mut self.slots[slot];
        if !slot.submitted {
            return Ok(());
        }
        let raw = self.device.raw();
        // SAFETY: the fence belongs to a submission; after the wait it is signalled and nothing waits for it.
        unsafe { raw.wait_for_fences(&[slot.submission.fence], true, u64::MAX) }
            .map_err(failed("vkWaitForFences"))?;
        slot.submitted = false;
        // SAFETY: as above.
        unsafe { raw.reset_fences(&[slot.submission.fence]) }.map_err(failed("vkResetFences"))
    }

    /// The number of the next frame's slot, below [`FRAMES`]. After [`wait`](Self::wait) nothing uses it.
    pub(crate) fn next(&self) -> usize {
        self.next
    }

    /// The semaphore with which the next frame's image is acquired, after [`wait`](Self::wait).
    pub(crate) fn acquired(&self) -> vk::Semaphore {
        self.slots[self.next].acquired
    }

    /// Records the next frame and submits it; `drawn` is signalled when its image is complete.
    ///
    /// # Safety
    /// [`wait`](Self::wait) was called before, an image was acquired with [`acquired`](Self::acquired), and everything that
    /// `record` uses lives until the frame has been waited for. `record` leaves `cmd` outside rendering. `drawn` is
    /// unsignalled.
    pub(crate) unsafe fn submit(
        &mut self,
        drawn: vk::Semaphore,
        record: impl FnOnce(vk::CommandBuffer) -> Result<()>,
    ) -> Result<()> {
        let slot = &mut self.slots[self.next];
        // SAFETY: the slot's last submission was waited for, says the caller.
        unsafe { slot.submission.record(&self.device, record) }?;
        // Only the drawing waits for the image, and not what comes before.
        let waits = [vk::SemaphoreSubmitInfo::default()
            .semaphore(slot.acquired)
            .stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)];
        // The semaphore waits for all commands: the image's transition to the layout for showing is in no single stage.
        let signals = [vk::SemaphoreSubmitInfo::default()
            .semaphore(drawn)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        // SAFETY: it was recorded just now, the fence is unsignalled, and the caller vouches for the semaphores.
        unsafe { slot.submission.submit(&self.device, &waits, &signals) }?;
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
                slot.submission.destroy(raw);
                raw.destroy_semaphore(slot.acquired, None);
            }
        }
    }
}
