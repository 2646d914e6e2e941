//! The requirements for a device, which can be checked before a device exists.

use std::ffi::CStr;

use ash::{ext, khr, vk};

use super::failure::failed;
use super::functions::number;
use super::shader::MAX_BUFFERS;
use rara_base::error::{Error, Result};
use rara_base::limits::{BLOCK_SIZE, RADIX_GROUP_SIZE};

/// The least size for which a workgroup of the sort has room to count the digits of each subgroup.
pub const LEAST_SUBGROUP: u32 = 8;

/// The optional features of a physical device that meets the requirements.
///
/// Required are `synchronization2` and `dynamicRendering`, which are Vulkan 1.3, or 1.2 with `VK_KHR_synchronization2` and
/// `VK_KHR_dynamic_rendering`; a way to reach buffers, which is [`buffer_device_address`](Self::buffer_device_address) or
/// [`push_descriptor`](Self::push_descriptor); compute workgroups of 256, where Vulkan promises 128; and a queue family for
/// graphics and compute. Everything else is optional and is noted here.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Support {
    /// The Vulkan version that rara uses: 1.2 or 1.3.
    pub api_version: u32,
    /// The first queue family with graphics and compute.
    pub queue_family: u32,
    /// `VK_EXT_mesh_shader` with mesh and task shaders.
    pub mesh_shader: bool,
    /// `bufferDeviceAddress`. Without it [`Bindings::Bound`](super::Bindings::Bound) is the only way, as under tools that hide
    /// the feature. A host that leaves it disabled though the device has it sets this to false before it takes the features
    /// from here, and says the same by [`AdoptDesc::buffer_device_address`](super::AdoptDesc::buffer_device_address).
    pub buffer_device_address: bool,
    /// `VK_KHR_push_descriptor`, and as many storage buffers a stage as pipelines with
    /// [`Bindings::Bound`](super::Bindings::Bound) have.
    pub push_descriptor: bool,
    /// Invocations of a subgroup where compute shaders can vote and shuffle, else 0. The tile rasteriser uses subgroups on
    /// CPU drivers; there is nothing to enable.
    pub subgroup_size: u32,
    /// The least and the greatest size of the whole subgroups that compute shaders with ballots and shuffles can be asked
    /// for, invocations, at least 8; both 0 where they cannot: `subgroupSizeControl` and `computeFullSubgroups` (Vulkan 1.3 or
    /// `VK_EXT_subgroup_size_control`).
    pub full_subgroups: [u32; 2],
    /// Bytes of shared memory that a compute workgroup can have.
    pub max_shared_memory: u32,
    /// Nanoseconds a timestamp tick; 0 where [`Support::queue_family`] has no timestamps.
    pub timestamp_period: f32,
    /// Valid bits of a timestamp in [`Support::queue_family`].
    pub timestamp_bits: u32,
    /// Bytes of a buffer that a bound storage buffer can show; addresses have no such limit.
    pub max_storage_buffer_range: u64,
    /// Bytes that one buffer can have.
    pub max_buffer_size: u64,
    /// Workgroups along x or y of one dispatch.
    pub max_group_count: u32,
    /// Pixels along a side of a 2D image.
    pub max_image_size: u32,
    /// The feature `pipelineStatisticsQuery`, which is used where statistics are asked for.
    pub pipeline_statistics: bool,
    /// The extension by which timestamps can be set against the processor's clock, `VK_KHR_calibrated_timestamps` or its
    /// forerunner. It is used where rara opens the device.
    pub calibrated_timestamps: Option<&'static CStr>,
    /// `VK_KHR_portability_subset`, which must then be enabled.
    pub portability_subset: bool,
}

impl Support {
    /// The device extensions to enable. A host may leave out `VK_EXT_mesh_shader`, `VK_KHR_push_descriptor` and
    /// `VK_EXT_subgroup_size_control`.
    pub fn extensions(&self) -> Vec<&'static CStr> {
        let before_1_3 = self.api_version < vk::API_VERSION_1_3;
        let wanted = [
            (before_1_3, khr::synchronization2::NAME),
            (before_1_3, khr::dynamic_rendering::NAME),
            (
                before_1_3 && self.full_subgroups[1] > 0,
                ext::subgroup_size_control::NAME,
            ),
            (self.mesh_shader, ext::mesh_shader::NAME),
            (self.push_descriptor, khr::push_descriptor::NAME),
            (self.portability_subset, khr::portability_subset::NAME),
        ];
        wanted
            .into_iter()
            .filter(|(has, _)| *has)
            .map(|(_, name)| name)
            .collect()
    }
}

/// True when an extension is among those that a device, an instance or a layer offers.
pub fn offers(extensions: &[vk::ExtensionProperties], wanted: &CStr) -> bool {
    extensions
        .iter()
        .any(|offered| offered.extension_name_as_c_str() == Ok(wanted))
}

/// Checks that a physical device can run this library; the error says in a sentence what it lacks.
///
/// # Safety
///
/// `instance` must be alive and created for `api_version`, and `physical` must be one of its devices.
pub unsafe fn check(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    api_version: u32,
) -> Result<Support> {
    // SAFETY: the caller vouches for both handles.
    let base = unsafe { instance.get_physical_device_properties(physical) };
    let name = base
        .device_name_as_c_str()
        .unwrap_or(c"?")
        .to_string_lossy();
    let lacks = |what: String| Err(Error::Device(format!("{name} cannot be used: {what}")));
    if api_version < vk::API_VERSION_1_2 {
        return Err(Error::Invalid(format!(
            "the instance was created for Vulkan {} and 1.2 is needed: set VkApplicationInfo::apiVersion",
            number(api_version)
        )));
    }
    if base.api_version < vk::API_VERSION_1_2 {
        return lacks(format!(
            "it offers Vulkan {} and 1.2 is needed; a newer driver may help",
            number(base.api_version)
        ));
    }
    let version = api_version.min(base.api_version);
    let has_1_3 = version >= vk::API_VERSION_1_3;

    // SAFETY: as above.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }
        .map_err(failed("vkEnumerateDeviceExtensionProperties"))?;
    let has = |wanted: &CStr| offers(&extensions, wanted);
    let has_mesh = has(ext::mesh_shader::NAME);
    for needed in [khr::synchronization2::NAME, khr::dynamic_rendering::NAME] {
        if !has_1_3 && !has(needed) {
            let (version, needed) = (number(version), needed.to_string_lossy());
            return lacks(format!(
                "Vulkan {version} needs the extension {needed}, which it lacks"
            ));
        }
    }

    let has_sizes = has_1_3 || has(ext::subgroup_size_control::NAME);
    let mut v11 = vk::PhysicalDeviceVulkan11Properties::default();
    let mut v13_limits = vk::PhysicalDeviceVulkan13Properties::default();
    let mut size_limits = vk::PhysicalDeviceSubgroupSizeControlProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut v11);
    if has_sizes {
        properties = properties.push_next(&mut size_limits);
    }
    if has_1_3 {
        properties = properties.push_next(&mut v13_limits);
    }
    // SAFETY: as above.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    // Every device has subgroups; the loader asks none where the instance was made for Vulkan 1.0.
    if v11.subgroup_size == 0 {
        return Err(Error::Invalid(format!(
            "the instance was created for less than Vulkan {}, which it is said to be for: set VkApplicationInfo::apiVersion",
            number(api_version)
        )));
    }

    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut synchronization2 = vk::PhysicalDeviceSynchronization2Features::default();
    let mut dynamic_rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default();
    let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
    let mut sizes = vk::PhysicalDeviceSubgroupSizeControlFeatures::default();
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut v12)
        .push_next(&mut synchronization2)
        .push_next(&mut dynamic_rendering);
    if has_mesh {
        features = features.push_next(&mut mesh);
    }
    if has_sizes {
        features = features.push_next(&mut sizes);
    }
    // SAFETY: as above; every struct in the chain is known to a device of this version and these extensions.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let pipeline_statistics = features.features.pipeline_statistics_query == vk::TRUE;
    for (offered, feature) in [
        (synchronization2.synchronization2, "synchronization2"),
        (dynamic_rendering.dynamic_rendering, "dynamicRendering"),
    ] {
        if offered == vk::FALSE {
            return lacks(format!("it lacks the feature {feature}"));
        }
    }

    // SAFETY: as above.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let Some(family) = families.iter().position(|f| f.queue_flags.contains(both)) else {
        return lacks("no queue family has both graphics and compute".into());
    };

    let limits = base.limits;
    let group = limits
        .max_compute_work_group_invocations
        .min(limits.max_compute_work_group_size[0]);
    if group < BLOCK_SIZE {
        return lacks(format!(
            "its compute workgroups have {group} invocations at most (maxComputeWorkGroupInvocations, \
             maxComputeWorkGroupSize) and {BLOCK_SIZE} are needed"
        ));
    }
    let binds = limits
        .max_per_stage_descriptor_storage_buffers
        .min(limits.max_descriptor_set_storage_buffers)
        >= MAX_BUFFERS as u32;
    let buffer_device_address = v12.buffer_device_address == vk::TRUE;
    let push_descriptor = binds && has(khr::push_descriptor::NAME);
    if !buffer_device_address && !push_descriptor {
        return lacks(format!(
            "it lacks the feature bufferDeviceAddress, and VK_KHR_push_descriptor with {MAX_BUFFERS} storage buffers a stage, \
             one of which is needed to reach buffers"
        ));
    }
    let operations = vk::SubgroupFeatureFlags::VOTE | vk::SubgroupFeatureFlags::SHUFFLE;
    let has_subgroups = v11.subgroup_supported_operations.contains(operations)
        && v11
            .subgroup_supported_stages
            .contains(vk::ShaderStageFlags::COMPUTE);
    let ballots = operations | vk::SubgroupFeatureFlags::BALLOT;
    let asks_for_subgroups = has_subgroups
        && v11.subgroup_supported_operations.contains(ballots)
        && sizes.subgroup_size_control == vk::TRUE
        && sizes.compute_full_subgroups == vk::TRUE
        && size_limits
            .required_subgroup_size_stages
            .contains(vk::ShaderStageFlags::COMPUTE);
    let mesh_shader = mesh.mesh_shader == vk::TRUE && mesh.task_shader == vk::TRUE;
    Ok(Support {
        api_version: version.min(vk::API_VERSION_1_3),
        queue_family: family as u32,
        mesh_shader,
        buffer_device_address,
        push_descriptor,
        subgroup_size: if has_subgroups { v11.subgroup_size } else { 0 },
        full_subgroups: if asks_for_subgroups {
            // Subgroups so small that the largest workgroup would have more of them than the device allows are left out.
            let least =
                RADIX_GROUP_SIZE.div_ceil(size_limits.max_compute_workgroup_subgroups.max(1));
            let least = least.next_power_of_two().max(LEAST_SUBGROUP);
            let least = size_limits.min_subgroup_size.max(least);
            let most = size_limits.max_subgroup_size;
            if least <= most { [least, most] } else { [0; 2] }
        } else {
            [0; 2]
        },
        max_shared_memory: limits.max_compute_shared_memory_size,
        timestamp_period: if families[family].timestamp_valid_bits > 0 {
            limits.timestamp_period
        } else {
            0.0
        },
        timestamp_bits: families[family].timestamp_valid_bits,
        max_storage_buffer_range: limits.max_storage_buffer_range.into(),
        max_buffer_size: if has_1_3 {
            v11.max_memory_allocation_size
                .min(v13_limits.max_buffer_size)
        } else {
            v11.max_memory_allocation_size
        },
        max_group_count: limits.max_compute_work_group_count[0]
            .min(limits.max_compute_work_group_count[1]),
        max_image_size: limits.max_image_dimension2_d,
        pipeline_statistics,
        // Validation layers of before 2024 know only the second name, and warn of the first.
        calibrated_timestamps: [
            ext::calibrated_timestamps::NAME,
            khr::calibrated_timestamps::NAME,
        ]
        .into_iter()
        .find(|name| has(name)),
        portability_subset: has(khr::portability_subset::NAME),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_only_approaches_vulkan_is_opened_with_the_subset() {
        for portability_subset in [false, true] {
            let support = Support {
                portability_subset,
                ..Support::default()
            };
            let extensions = support.extensions();
            let has = extensions.contains(&khr::portability_subset::NAME);
            assert_eq!(has, portability_subset);
        }
    }
}
