//! The host may be done with something before the device is: it is then dropped when a fence of the host's is signalled.

use std::any::Any;
use std::sync::{MutexGuard, PoisonError};

use ash::vk;

use super::device::Device;

/// Something to be dropped, and the fence that it waits for.
pub(super) type Deferred = (vk::Fence, Box<dyn Any + Send>);

impl Device {
    /// Keeps something that frames in flight may use until a fence is signalled: a scene, a renderer, a cut, a picker, an
    /// editor, or several of them as a tuple. [`drop_finished`](Self::drop_finished) then drops it. The device lives on in what
    /// is kept, so that a host calls that once more at its end.
    ///
    /// # Safety
    /// The fence is of this device, and belongs to a submission that is unfinished or yet to come, behind all that uses what is
    /// kept. It lives until that has been dropped; it may be reset and submitted again before.
    pub unsafe fn drop_after(&self, what: impl Any + Send, fence: vk::Fence) {
        self.lock_deferred().push((fence, Box::new(what)));
    }

    /// Drops what [`drop_after`](Self::drop_after) keeps and whose fence is signalled, or all of it where the device is lost.
    /// Nothing waits. Returns how many objects are still kept. No other thread resets one of the fences meanwhile.
    pub fn drop_finished(&self) -> usize {
        let mut deferred = self.lock_deferred();
        let is_finished = |(fence, _): &mut Deferred| {
            // SAFETY: it is alive, as whoever called `drop_after` promised.
            let status = unsafe { self.raw().get_fence_status(*fence) };
            matches!(status, Ok(true) | Err(vk::Result::ERROR_DEVICE_LOST))
        };
        let finished: Vec<Deferred> = deferred.extract_if(.., is_finished).collect();
        let left = deferred.len();
        // A drop may call the host, which may come back here.
        drop(deferred);
        drop(finished);
        left
    }

    fn lock_deferred(&self) -> MutexGuard<'_, Vec<Deferred>> {
        let deferred = self.inner.deferred.lock();
        deferred.unwrap_or_else(PoisonError::into_inner)
    }
}
