//! Requirements before there is a device.

use std::ffi::{c_char, c_void};

use rara::ash::vk;
use rara::gpu::{self, Support};

use crate::boundary::{RaraResult, guard, read, versioned, write};
use crate::device::{PFN_vkGetInstanceProcAddr, load_instance};

/// Room for the names of extensions in RaraSupport.
pub const RARA_MAX_EXTENSIONS: usize = 8;

/// The features of a suitable physical device beyond the requirements. Required are Vulkan 1.3, or 1.2 with
/// VK_KHR_synchronization2 and VK_KHR_dynamic_rendering, the features synchronization2 and dynamicRendering,
/// bufferDeviceAddress or VK_KHR_push_descriptor, and a queue family with graphics and compute.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraSupport {
    /// Set by rara_check.
    pub struct_size: usize,
    /// The first queue family with graphics and compute. Any other with both will do too.
    pub queue_family: u32,
    /// VK_EXT_mesh_shader with meshShader and taskShader. Optional: splats can be drawn without them.
    pub mesh_shader: vk::Bool32,
    /// VK_KHR_push_descriptor. Optional: RARA_BINDINGS_BOUND needs it.
    pub push_descriptor: vk::Bool32,
    /// VK_KHR_portability_subset. A host must enable it where the device has it.
    pub portability_subset: vk::Bool32,
    /// Nanoseconds of one tick of a timestamp; 0 where the queue family has no timestamps, and frames then have no times.
    pub timestamp_period: f32,
    /// Number of extensions.
    pub extension_count: u32,
    /// The extensions named above that the device has, and those that Vulkan 1.2 needs, to be added to
    /// ppEnabledExtensionNames. The strings live as long as the library.
    pub extensions: [*const c_char; RARA_MAX_EXTENSIONS],
    /// Bytes of the largest buffer, which limits a scene's spherical harmonics.
    pub max_buffer_size: u64,
    /// Most pixels along a side of an image.
    pub max_image_size: u32,
    /// The Vulkan version that rara uses: VK_API_VERSION_1_2 or VK_API_VERSION_1_3.
    pub api_version: u32,
    /// subgroupSizeControl and computeFullSubgroups, of Vulkan 1.3 or VK_EXT_subgroup_size_control. Optional: on GPUs the
    /// sort is faster with them.
    pub full_subgroups: vk::Bool32,
    /// pipelineStatisticsQuery of VkPhysicalDeviceFeatures. Optional: RaraRendererDesc::statistics needs it, and a host that
    /// wants them enables it, as rara_support_features does not.
    pub pipeline_statistics: vk::Bool32,
    /// bufferDeviceAddress. Without it RARA_BINDINGS_BOUND is the only way to reach buffers. A host that leaves it disabled
    /// sets this to false before rara_support_features, and RaraAdoptDesc::buffer_device_address too.
    pub buffer_device_address: vk::Bool32,
}

versioned!(RaraSupport);

impl RaraSupport {
    fn from_support(support: &Support) -> Self {
        let mut extensions = [std::ptr::null(); RARA_MAX_EXTENSIONS];
        let names = support.extensions();
        for (to, name) in extensions.iter_mut().zip(&names) {
            *to = name.as_ptr();
        }
        Self {
            struct_size: size_of::<Self>(),
            queue_family: support.queue_family,
            mesh_shader: support.mesh_shader.into(),
            push_descriptor: support.push_descriptor.into(),
            portability_subset: support.portability_subset.into(),
            timestamp_period: support.timestamp_period,
            extension_count: names.len().min(RARA_MAX_EXTENSIONS) as u32,
            extensions,
            max_buffer_size: support.max_buffer_size,
            max_image_size: support.max_image_size,
            api_version: support.api_version,
            full_subgroups: (support.full_subgroups[1] > 0).into(),
            pipeline_statistics: support.pipeline_statistics.into(),
            buffer_device_address: support.buffer_device_address.into(),
        }
    }

    /// As much of it as features depend on.
    fn support(&self) -> Support {
        let mut support = Support::default();
        support.buffer_device_address = self.buffer_device_address != 0;
        support.mesh_shader = self.mesh_shader != 0;
        // Whether there are any sizes matters, and not which.
        support.full_subgroups = [u32::from(self.full_subgroups != 0); 2];
        support
    }
}

/// Checks whether a physical device will do, before there is a device. If it will not, the result is RARA_ERROR_DEVICE
/// and the message names what is missing.
///
/// `api_version` is the VkApplicationInfo::apiVersion that the instance was created with, 1.2 or later; `support_size` is
/// sizeof *support.
///
/// # Safety
/// `instance` is alive and was created for `api_version`, `physical_device` is one of its own, and
/// `get_instance_proc_addr` is the loader's. `support` has room for `support_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_check(
    get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
    api_version: u32,
    support: *mut RaraSupport,
    support_size: usize,
) -> RaraResult {
    guard(|| {
        let instance = load_instance(get_instance_proc_addr, instance, physical_device)?;
        let found =
            RaraSupport::from_support(&gpu::check(&instance, physical_device, api_version)?);
        write(support, support_size, &found, "support")
    })
}

/// Sets the features that rara needs in the host's own structs: those in the pNext chain of its VkDeviceCreateInfo,
/// whichever of Vulkan's structs they are in. No other field is touched. RARA_ERROR_INVALID names a feature for which the
/// chain has no struct; these may be missing, since a host can do without: meshShader and taskShader, subgroupSizeControl and
/// computeFullSubgroups.
///
/// # Safety
/// `support` was filled by rara_check; `p_next` is null, or a chain of structs that may be changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_support_features(
    support: *const RaraSupport,
    p_next: *mut c_void,
) -> RaraResult {
    guard(|| {
        let default = RaraSupport {
            buffer_device_address: vk::TRUE, // of hosts that do not know the field
            ..RaraSupport::from_support(&Support::default())
        };
        let support = read(support, default, "support")?;
        support.support().set_features(p_next)
    })
}
