//! There are two ways to a device: headless use opens one of its own, and a host lends one.

use std::ffi::CStr;
use std::sync::{Arc, Mutex};

use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings};

use super::desc::{AdoptDesc, DeviceDesc};
use super::device::Device;
use super::devices::{self, DeviceInfo};
use super::failure::failed;
use super::instance::Instance;
use super::requirements::Support;
use super::shape::DeviceShape;
use super::{functions, requirements};
use rara_base::error::{Error, Result};

impl Device {
    /// Opens a device of its own, without a window.
    pub fn headless(desc: &DeviceDesc) -> Result<Self> {
        let instance = Instance::new(&desc.application_name, desc.validation, &[])?;
        let candidates = instance.devices()?;
        Self::open(Arc::new(instance), candidates, desc, &[])
    }

    /// Opens the one of the instance's devices that the description means, with extensions that all usable ones among them
    /// offer.
    #[doc(hidden)]
    pub fn open(
        owned: Arc<Instance>,
        candidates: Vec<(vk::PhysicalDevice, DeviceInfo)>,
        desc: &DeviceDesc,
        needed: &[&'static CStr],
    ) -> Result<Self> {
        let (physical, infos): (Vec<_>, Vec<_>) = candidates.into_iter().unzip();
        let chosen = devices::choose(&infos, desc.selector.as_deref())?;
        let (physical, info) = (physical[chosen], infos[chosen].clone());
        let mut support = info.support.clone().map_err(Error::Device)?;
        let shape = DeviceShape::from_environment(&support)?;
        let shape = DeviceShape::choose(&info, &support, desc.shape, shape)?;
        support.pipeline_statistics &= desc.statistics;

        let family = support.queue_family;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(family)
            .queue_priorities(&[1.0])];
        let extensions: Vec<_> = support
            .extensions()
            .iter()
            .chain(needed)
            .chain(&support.calibrated_timestamps)
            .map(|name| name.as_ptr())
            .collect();
        let mut features = support.features();
        let core = vk::PhysicalDeviceFeatures::default()
            .pipeline_statistics_query(support.pipeline_statistics);
        let create = vk::DeviceCreateInfo::default()
            .enabled_features(&core)
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions);
        let create = features.chain(create);
        #[cfg(feature = "lab")]
        let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        #[cfg(feature = "lab")]
        let create = match needed.contains(&ash::khr::pipeline_executable_properties::NAME) {
            true => create.push_next(&mut executables),
            false => create,
        };
        // SAFETY: instance and physical device are alive, and the device offers all that `create` asks for.
        let raw = unsafe { owned.raw.create_device(physical, &create, None) }
            .map_err(failed("vkCreateDevice"))?;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { raw.get_device_queue(family, 0) };
        let empty = vk::PipelineCacheCreateInfo::default();
        // SAFETY: the device was created just now. It works without a cache too.
        let pipeline_cache = unsafe { raw.create_pipeline_cache(&empty, None) }.unwrap_or_default();
        let instance = owned.raw.clone();
        let version = super::instance::API_VERSION;
        let adopt = AdoptDesc::new(version, instance, physical, raw.clone(), (queue, family))
            .mesh_shader(support.mesh_shader)
            .push_descriptor(support.push_descriptor)
            .full_subgroups(support.full_subgroups[1] > 0)
            .debug_utils(owned.debug_utils)
            .pipeline_statistics(support.pipeline_statistics)
            .pipeline_cache(pipeline_cache)
            .shape(desc.shape);
        let allocator = allocator(&adopt, &support).inspect_err(|_| {
            // SAFETY: nothing else was made from the device, and nobody else knows it.
            unsafe {
                raw.destroy_pipeline_cache(pipeline_cache, None);
                raw.destroy_device(None);
            }
        })?;
        let device = Self::new(adopt, info, support, allocator, Some(owned), shape);
        device.set_name(pipeline_cache, "pipelines");
        device.set_name(queue, "queue");
        Ok(device)
    }

    /// Works with a host's device. The host keeps owning it: nothing of the description is ever destroyed here.
    ///
    /// # Errors
    /// [`Error::Device`] as of [`check`](super::check), and [`Error::Invalid`] names an extension that the description
    /// claims and whose functions the device does not have. Features that are claimed cannot be checked.
    ///
    /// # Safety
    ///
    /// All handles must belong together, be as the description says, and outlive this device, its clones and
    /// everything made from them, which [`AdoptDesc::keep_alive`] can see to. While [`Device::submit_and_wait`] or an upload runs, the host must not use the queue.
    pub unsafe fn adopt(desc: AdoptDesc) -> Result<Self> {
        // SAFETY: the caller vouches for the handles.
        let mut support =
            unsafe { requirements::check(&desc.instance, desc.physical_device, desc.api_version) }?;
        support.buffer_device_address &= desc.buffer_device_address;
        // SAFETY: as above.
        unsafe { functions::check(&desc, &support) }?;
        // SAFETY: as above.
        let families = unsafe {
            desc.instance
                .get_physical_device_queue_family_properties(desc.physical_device)
        };
        let family = |index: u32, field: &str| {
            families.get(index as usize).ok_or_else(|| {
                Error::Invalid(format!(
                    "the device has no queue family {index}, as AdoptDesc::{field} says: it has {}, counted from 0",
                    families.len()
                ))
            })
        };
        let shared = desc.shared_families.iter();
        let shared = shared.map(|index| family(*index, "shared_families"));
        let shared = shared.collect::<Result<Vec<_>>>()?;
        let family = family(desc.queue_family, "queue_family")?;
        if !family
            .queue_flags
            .contains(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE)
        {
            return Err(Error::Invalid(format!(
                "queue family {} lacks graphics or compute; family {} has both",
                desc.queue_family, support.queue_family
            )));
        }
        support.queue_family = desc.queue_family;
        // Frames are timed in each queue that computes or draws.
        let timed = |family: &&&vk::QueueFamilyProperties| {
            family.queue_flags.contains(vk::QueueFlags::COMPUTE)
        };
        let bits = shared
            .iter()
            .filter(timed)
            .map(|family| family.timestamp_valid_bits);
        support.timestamp_bits = bits.fold(family.timestamp_valid_bits, u32::min);
        if support.timestamp_bits == 0 {
            support.timestamp_period = 0.0;
        }
        support.mesh_shader &= desc.mesh_shader;
        support.push_descriptor &= desc.push_descriptor;
        if !support.buffer_device_address && !support.push_descriptor {
            return Err(Error::Invalid(
                "the device has neither bufferDeviceAddress nor VK_KHR_push_descriptor, one of which is needed to reach \
                 buffers: enable one, and say so by AdoptDesc::buffer_device_address or AdoptDesc::push_descriptor"
                    .into(),
            ));
        }
        if !desc.full_subgroups {
            support.full_subgroups = [0; 2];
        }
        support.pipeline_statistics &= desc.pipeline_statistics;
        // The host does not say whether it was enabled, and only rara's own devices use it.
        support.calibrated_timestamps = None;
        // SAFETY: as above.
        let info =
            unsafe { devices::describe(&desc.instance, desc.physical_device, desc.api_version) };
        // A host does not fail for a variable that it knows nothing of.
        let shape = DeviceShape::from_environment(&support).unwrap_or_else(|error| {
            log::warn!("{error}; it is ignored");
            None
        });
        let shape = DeviceShape::choose(&info, &support, desc.shape, shape)?;
        if desc.allocator.is_some() && desc.memory.is_some() {
            return Err(Error::Invalid(
                "the description has an allocator and another source of memory: give one of them"
                    .into(),
            ));
        }
        let allocator = match &desc.allocator {
            Some(lent) => lent.clone(),
            None => allocator(&desc, &support)?,
        };
        let has = |feature| if feature { "" } else { "no " };
        log::info!(
            "{} ({}) was adopted for Vulkan {}.{}: pipelines for {:?}, {}; {}buffer addresses, {}mesh shaders, {}push descriptors, {}timestamps",
            info.name,
            info.driver,
            vk::api_version_major(support.api_version),
            vk::api_version_minor(support.api_version),
            shape.0,
            shape.1,
            has(support.buffer_device_address),
            has(support.mesh_shader),
            has(support.push_descriptor),
            has(support.timestamp_bits > 0),
        );
        Ok(Self::new(desc, info, support, allocator, None, shape))
    }
}

fn allocator(desc: &AdoptDesc, support: &Support) -> Result<Arc<Mutex<Allocator>>> {
    Allocator::new(&AllocatorCreateDesc {
        instance: desc.instance.clone(),
        device: desc.device.clone(),
        physical_device: desc.physical_device,
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: support.buffer_device_address,
        // Shared blocks start small: large buffers have memory of their own.
        allocation_sizes: AllocationSizes::new(32 << 20, 32 << 20),
    })
    .map(|allocator| Arc::new(Mutex::new(allocator)))
    .map_err(|error| Error::Memory(format!("the device's memory could not be set up: {error}")))
}
