//! The commands that are recorded and submitted with Vulkan 1.3, or with the two extensions of 1.2 that they come from. Only
//! the functions' names differ.

use std::ffi::{CStr, CString, c_void};

use ash::{khr, vk};

/// `VK_KHR_synchronization2` and `VK_KHR_dynamic_rendering`, whichever way the device has them. Each function wants of its
/// caller what Vulkan's of that name wants.
pub(super) struct Commands {
    synchronization2: khr::synchronization2::DeviceFn,
    dynamic_rendering: khr::dynamic_rendering::DeviceFn,
}

impl Commands {
    pub(super) fn load(instance: &ash::Instance, device: &ash::Device, api_version: u32) -> Self {
        let core = api_version >= vk::API_VERSION_1_3;
        let find = |name: &CStr| {
            let bytes = name.to_bytes();
            let wanted = if core {
                bytes.strip_suffix(b"KHR").unwrap_or(bytes)
            } else {
                bytes
            };
            let wanted = CString::new(wanted).expect("a part of a name without NUL");
            // SAFETY: the device is alive and was made from the instance, as whoever opens or adopts it made sure.
            let found = unsafe { instance.get_device_proc_addr(device.handle(), wanted.as_ptr()) };
            found.map_or(std::ptr::null(), |function| function as *const c_void)
        };
        Self {
            synchronization2: khr::synchronization2::DeviceFn::load(find),
            dynamic_rendering: khr::dynamic_rendering::DeviceFn::load(find),
        }
    }

    pub(super) unsafe fn pipeline_barrier(
        &self,
        cmd: vk::CommandBuffer,
        dependency: &vk::DependencyInfo<'_>,
    ) {
        // SAFETY: the caller's promise.
        unsafe { (self.synchronization2.cmd_pipeline_barrier2_khr)(cmd, dependency) };
    }

    pub(super) unsafe fn write_timestamp(
        &self,
        cmd: vk::CommandBuffer,
        stage: vk::PipelineStageFlags2,
        pool: vk::QueryPool,
        query: u32,
    ) {
        // SAFETY: the caller's promise.
        unsafe { (self.synchronization2.cmd_write_timestamp2_khr)(cmd, stage, pool, query) };
    }

    pub(super) unsafe fn submit(
        &self,
        queue: vk::Queue,
        submit: &vk::SubmitInfo2<'_>,
        fence: vk::Fence,
    ) -> ash::prelude::VkResult<()> {
        // SAFETY: the caller's promise.
        unsafe { (self.synchronization2.queue_submit2_khr)(queue, 1, submit, fence) }.result()
    }

    pub(super) unsafe fn begin_rendering(
        &self,
        cmd: vk::CommandBuffer,
        info: &vk::RenderingInfo<'_>,
    ) {
        // SAFETY: the caller's promise.
        unsafe { (self.dynamic_rendering.cmd_begin_rendering_khr)(cmd, info) };
    }

    pub(super) unsafe fn end_rendering(&self, cmd: vk::CommandBuffer) {
        // SAFETY: the caller's promise.
        unsafe { (self.dynamic_rendering.cmd_end_rendering_khr)(cmd) };
    }
}
