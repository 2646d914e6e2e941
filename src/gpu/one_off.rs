//! What one submission at a time is recorded into.

use ash::vk;

/// A command buffer for one submission at a time, with the fence that says when it is done.
pub(super) struct OneOff {
    pub(super) pool: vk::CommandPool,
    pub(super) cmd: vk::CommandBuffer,
    pub(super) fence: vk::Fence,
}

impl OneOff {
    pub(super) fn destroy(self, raw: &ash::Device) {
        // SAFETY: a `OneOff` is destroyed only when idle; null handles are ignored.
        unsafe {
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
