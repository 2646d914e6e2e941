//! What one submission at a time is recorded into.

use ash::vk;

/// A command buffer for one submission at a time, with the fence that says when it is done.
#[derive(Default)]
pub struct Submission {
    pub(super) pool: vk::CommandPool,
    pub(super) cmd: vk::CommandBuffer,
    /// It is signalled when the submission is done.
    pub fence: vk::Fence,
}

impl Submission {
    /// Destroys it, which no submission uses any more.
    pub fn destroy(&self, raw: &ash::Device) {
        // SAFETY: it is idle, and null handles are ignored.
        unsafe {
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}
