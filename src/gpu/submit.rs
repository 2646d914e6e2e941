//! Records, submits and waits, for headless frames, uploads and downloads.

use std::sync::{MutexGuard, PoisonError};

use ash::vk;

use super::device::Device;
use super::failure::failed;
use super::submission::Submission;
use rara_base::error::Result;

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
    pub(super) fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        let queue = self.inner.queue.lock();
        queue.unwrap_or_else(PoisonError::into_inner)
    }

    fn lock_idle(&self) -> MutexGuard<'_, Vec<Submission>> {
        let idle = self.inner.idle.lock();
        idle.unwrap_or_else(PoisonError::into_inner)
    }
}
