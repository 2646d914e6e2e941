//! The functions that a host's device must have: ash ends the process where one is called that was not found.

use std::ffi::CStr;

use ash::vk;

use super::desc::AdoptDesc;
use super::requirements::Support;
use rara_base::error::{Error, Result};

/// The remedy where a function of the version's own is missing, which drivers hide where the instance was made for less.
const MAKE_OR_SAY: &str = "create the instance for the Vulkan version that AdoptDesc::api_version says \
                           (VkApplicationInfo::apiVersion), or say there for which it was created";

/// The remedy where a function of an extension is missing that the version needs.
const ENABLE_OR_SAY: &str = "create the device with the extensions and features that gpu::check names, or, if the instance was \
                             created for Vulkan 1.3, say so by AdoptDesc::api_version";

/// A version as people write it.
pub(super) fn number(version: u32) -> String {
    let (major, minor) = (
        vk::api_version_major(version),
        vk::api_version_minor(version),
    );
    format!("{major}.{minor}")
}

/// Checks that a host's device has the functions of what its description claims, and of what it uses of the device's support.
///
/// # Safety
///
/// The handles of the description are alive and belong together.
pub(super) unsafe fn check(desc: &AdoptDesc, support: &Support) -> Result<()> {
    let core = support.api_version >= vk::API_VERSION_1_3;
    let needed: [(bool, &CStr, &str, &str); 8] = [
        (true, c"vkCreateRenderPass2", "Vulkan 1.2", MAKE_OR_SAY),
        (
            support.buffer_device_address,
            c"vkGetBufferDeviceAddress",
            "bufferDeviceAddress",
            "enable it, or set the description's buffer_device_address to false",
        ),
        (core, c"vkCmdPipelineBarrier2", "Vulkan 1.3", MAKE_OR_SAY),
        (
            !core,
            c"vkCmdPipelineBarrier2KHR",
            "VK_KHR_synchronization2",
            ENABLE_OR_SAY,
        ),
        (
            !core,
            c"vkCmdBeginRenderingKHR",
            "VK_KHR_dynamic_rendering",
            ENABLE_OR_SAY,
        ),
        (
            desc.mesh_shader,
            c"vkCmdDrawMeshTasksEXT",
            "VK_EXT_mesh_shader",
            "enable it, or leave the description's mesh_shader false",
        ),
        (
            desc.push_descriptor,
            c"vkCmdPushDescriptorSetKHR",
            "VK_KHR_push_descriptor",
            "enable it, or leave the description's push_descriptor false",
        ),
        (
            desc.debug_utils,
            c"vkSetDebugUtilsObjectNameEXT",
            "VK_EXT_debug_utils",
            "enable it on the instance, or leave the description's debug_utils false",
        ),
    ];
    for (wanted, function, of, remedy) in needed {
        if !wanted {
            continue;
        }
        let device = desc.device.handle();
        // SAFETY: the caller vouches for both handles.
        let found = unsafe {
            desc.instance
                .get_device_proc_addr(device, function.as_ptr())
        };
        if found.is_none() {
            return Err(Error::Invalid(format!(
                "the device was created without {of}: it has no {}; {remedy}",
                function.to_string_lossy()
            )));
        }
    }
    Ok(())
}
