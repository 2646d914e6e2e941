//! The device that everything else is made from: a host's own, adopted, or one that headless use opens and owns.

use std::ffi::CString;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationError, AllocationSizes, AllocatorDebugSettings};

use super::failure::failed;
use super::instance::{self, DeviceInfo, Instance};
use super::requirements::{self, Support};
use super::submit::OneOff;
use super::validation::Messages;
use super::{Buffer, BufferDesc, Image, ImageDesc};
use crate::{Error, Result};

/// What [`Device::headless`] opens.
#[derive(Debug, Clone)]
pub struct DeviceDesc {
    /// A number from [`list_devices`](super::list_devices) or part of a name; `None` is the best device.
    pub selector: Option<String>,
    /// Load the Khronos validation layer with synchronisation checks.
    pub validation: bool,
    /// What drivers and capture tools are told.
    pub application_name: String,
}

impl Default for DeviceDesc {
    fn default() -> Self {
        Self {
            selector: None,
            validation: false,
            application_name: "rara".into(),
        }
    }
}

/// A host's own device, for [`Device::adopt`].
#[derive(Clone)]
pub struct AdoptDesc {
    /// Created for Vulkan 1.3 or later.
    pub instance: ash::Instance,
    /// The device below was made from it.
    pub physical_device: vk::PhysicalDevice,
    /// Created with [`Support::features`], and as many of [`Support::extensions`] as the flags below say.
    pub device: ash::Device,
    /// Graphics and compute; everything that is recorded with this device goes to it.
    pub queue: vk::Queue,
    /// The queue's family.
    pub queue_family: u32,
    /// `VK_EXT_mesh_shader` and its features were enabled.
    pub mesh_shader: bool,
    /// `VK_KHR_push_descriptor` was enabled.
    pub push_descriptor: bool,
    /// `VK_EXT_debug_utils` was enabled on the instance.
    pub debug_utils: bool,
    /// Where compiled pipelines are looked up and kept; null for nowhere.
    pub pipeline_cache: vk::PipelineCache,
}

impl std::fmt::Debug for AdoptDesc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AdoptDesc")
            .field("physical_device", &self.physical_device)
            .field("queue_family", &self.queue_family)
            .finish_non_exhaustive()
    }
}

/// A device, shared by everything made from it; clones are the same device.
#[derive(Clone)]
pub struct Device {
    pub(super) inner: Arc<Inner>,
}

pub(super) struct Inner {
    raw: ash::Device,
    info: DeviceInfo,
    support: Support,
    pub(super) queue: Mutex<vk::Queue>,
    queue_family: u32,
    pipeline_cache: vk::PipelineCache,
    mesh_shader: Option<ext::mesh_shader::Device>,
    push_descriptor: Option<khr::push_descriptor::Device>,
    debug_utils: Option<ext::debug_utils::Device>,
    /// `None` only while being dropped.
    allocator: Mutex<Option<Allocator>>,
    allocated: AtomicU64,
    /// Idle command buffers of [`Device::submit_and_wait`].
    pub(super) idle: Mutex<Vec<OneOff>>,
    /// `None` for a host's device, which is never destroyed here.
    owned: Option<Instance>,
}

impl Device {
    /// Opens a device of its own, without a window.
    pub fn headless(desc: &DeviceDesc) -> Result<Self> {
        let owned = Instance::new(&desc.application_name, desc.validation)?;
        let (physical, infos): (Vec<_>, Vec<_>) = owned.devices()?.into_iter().unzip();
        let chosen = instance::choose(&infos, desc.selector.as_deref())?;
        let (physical, info) = (physical[chosen], infos[chosen].clone());
        let support = info.support.clone().map_err(Error::Device)?;

        let family = support.queue_family;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(family)
            .queue_priorities(&[1.0])];
        let extensions: Vec<_> = support
            .extensions()
            .iter()
            .map(|name| name.as_ptr())
            .collect();
        let mut features = support.features();
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions);
        let create = features.chain(create);
        // SAFETY: instance and physical device are alive, and the device offers all that `create` asks for.
        let raw = unsafe { owned.raw.create_device(physical, &create, None) }
            .map_err(failed("vkCreateDevice"))?;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { raw.get_device_queue(family, 0) };
        let adopt = AdoptDesc {
            instance: owned.raw.clone(),
            physical_device: physical,
            device: raw.clone(),
            queue,
            queue_family: family,
            mesh_shader: support.mesh_shader,
            push_descriptor: support.push_descriptor,
            debug_utils: owned.debug_utils,
            pipeline_cache: vk::PipelineCache::null(),
        };
        let allocator = allocator(&adopt).inspect_err(|_| {
            // SAFETY: nothing was made from the device, and nobody else knows it.
            unsafe { raw.destroy_device(None) };
        })?;
        Ok(Self::new(adopt, info, support, allocator, Some(owned)))
    }

    /// Works with a host's device. The host keeps owning it: nothing of the description is ever destroyed here.
    ///
    /// # Safety
    ///
    /// All handles must belong together, be as the description says, and outlive this device, its clones and
    /// everything made from them. While [`Device::submit_and_wait`] or an upload runs, the host must not use the queue.
    pub unsafe fn adopt(desc: AdoptDesc) -> Result<Self> {
        // SAFETY: the caller vouches for the handles.
        let mut support = unsafe { requirements::check(&desc.instance, desc.physical_device) }?;
        // SAFETY: as above.
        let families = unsafe {
            desc.instance
                .get_physical_device_queue_family_properties(desc.physical_device)
        };
        let Some(family) = families.get(desc.queue_family as usize) else {
            return Err(Error::Invalid(format!(
                "the device has no queue family {}",
                desc.queue_family
            )));
        };
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
        support.timestamp_bits = family.timestamp_valid_bits;
        if support.timestamp_bits == 0 {
            support.timestamp_period = 0.0;
        }
        support.mesh_shader &= desc.mesh_shader;
        support.push_descriptor &= desc.push_descriptor;
        // SAFETY: as above.
        let info = unsafe { instance::describe(&desc.instance, desc.physical_device) };
        let allocator = allocator(&desc)?;
        Ok(Self::new(desc, info, support, allocator, None))
    }

    fn new(
        desc: AdoptDesc,
        info: DeviceInfo,
        support: Support,
        allocator: Allocator,
        owned: Option<Instance>,
    ) -> Self {
        let AdoptDesc {
            instance,
            device: raw,
            ..
        } = &desc;
        Self {
            inner: Arc::new(Inner {
                mesh_shader: support
                    .mesh_shader
                    .then(|| ext::mesh_shader::Device::new(instance, raw)),
                push_descriptor: support
                    .push_descriptor
                    .then(|| khr::push_descriptor::Device::new(instance, raw)),
                debug_utils: desc
                    .debug_utils
                    .then(|| ext::debug_utils::Device::new(instance, raw)),
                raw: raw.clone(),
                info,
                support,
                queue: Mutex::new(desc.queue),
                queue_family: desc.queue_family,
                pipeline_cache: desc.pipeline_cache,
                allocator: Mutex::new(Some(allocator)),
                allocated: AtomicU64::new(0),
                idle: Mutex::new(Vec::new()),
                owned,
            }),
        }
    }

    /// The device's name, driver and kind.
    pub fn info(&self) -> &DeviceInfo {
        &self.inner.info
    }

    /// What it offers, less what the host did not enable.
    pub fn support(&self) -> &Support {
        &self.inner.support
    }

    /// The ash device.
    pub fn raw(&self) -> &ash::Device {
        &self.inner.raw
    }

    /// The family of the queue.
    pub fn queue_family(&self) -> u32 {
        self.inner.queue_family
    }

    /// Creates a buffer.
    pub fn create_buffer(&self, desc: &BufferDesc<'_>) -> Result<Buffer> {
        Buffer::new(self, desc)
    }

    /// Creates a colour target.
    pub fn create_image(&self, desc: &ImageDesc<'_>) -> Result<Image> {
        Image::new(self, desc)
    }

    /// Bytes of device memory that live buffers and images take.
    pub fn device_bytes(&self) -> u64 {
        self.inner.allocated.load(Ordering::Relaxed)
    }

    /// Takes the validation layer's warnings and errors since the last call, from all threads. Empty without the
    /// layer, and for a host's device, whose messages go to the host.
    pub fn validation_messages(&self) -> Vec<String> {
        self.messages()
            .map(|messages| messages.drain())
            .unwrap_or_default()
    }

    /// Gives up this handle and returns the validation layer's messages. If it was the last one, the device is
    /// destroyed first, so that the messages include what the layer says of things left alive.
    pub fn close(self) -> Vec<String> {
        let messages = self.messages();
        drop(self);
        messages
            .map(|messages| messages.drain())
            .unwrap_or_default()
    }

    fn messages(&self) -> Option<Arc<Messages>> {
        let validation = self.inner.owned.as_ref()?.validation.as_ref()?;
        Some(validation.messages.clone())
    }

    pub(crate) fn mesh_shader(&self) -> Option<&ext::mesh_shader::Device> {
        self.inner.mesh_shader.as_ref()
    }

    pub(crate) fn push_descriptor(&self) -> Option<&khr::push_descriptor::Device> {
        self.inner.push_descriptor.as_ref()
    }

    pub(crate) fn debug_utils(&self) -> Option<&ext::debug_utils::Device> {
        self.inner.debug_utils.as_ref()
    }

    pub(crate) fn pipeline_cache(&self) -> vk::PipelineCache {
        self.inner.pipeline_cache
    }

    /// Names an object of this device for debuggers and validation messages.
    pub(crate) fn set_name<H: vk::Handle>(&self, object: H, name: &str) {
        let Some(debug) = self.debug_utils() else {
            return;
        };
        let name = CString::new(name.replace('\0', "")).expect("no NUL is left");
        let info = vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(object)
            .object_name(&name);
        // SAFETY: callers name objects that they just made from this device. A failure costs a name, nothing else.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    pub(crate) fn allocate(
        &self,
        desc: &AllocationCreateDesc<'_>,
    ) -> std::result::Result<Allocation, AllocationError> {
        let mut allocator = self
            .inner
            .allocator
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let allocation = allocator
            .as_mut()
            .expect("taken only by drop")
            .allocate(desc)?;
        self.inner
            .allocated
            .fetch_add(allocation.size(), Ordering::Relaxed);
        Ok(allocation)
    }

    pub(crate) fn free(&self, allocation: Allocation) {
        self.inner
            .allocated
            .fetch_sub(allocation.size(), Ordering::Relaxed);
        let mut allocator = self
            .inner
            .allocator
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Err(error) = allocator
            .as_mut()
            .expect("taken only by drop")
            .free(allocation)
        {
            log::error!("device memory could not be freed: {error}");
        }
    }
}

fn allocator(desc: &AdoptDesc) -> Result<Allocator> {
    Allocator::new(&AllocatorCreateDesc {
        instance: desc.instance.clone(),
        device: desc.device.clone(),
        physical_device: desc.physical_device,
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: true,
        // Shared blocks start small: large buffers have memory of their own.
        allocation_sizes: AllocationSizes::new(32 << 20, 32 << 20),
    })
    .map_err(|error| Error::Memory(format!("the device's memory could not be set up: {error}")))
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device")
            .field("name", &self.inner.info.name)
            .field("owned", &self.inner.owned.is_some())
            .field("device_bytes", &self.device_bytes())
            .finish_non_exhaustive()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        for one_off in self
            .idle
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner)
            .drain(..)
        {
            one_off.destroy(&self.raw);
        }
        drop(
            self.allocator
                .get_mut()
                .unwrap_or_else(PoisonError::into_inner)
                .take(),
        );
        if self.owned.is_some() {
            // SAFETY: everything made from the device holds an `Arc` of it or was destroyed above. The instance goes
            // after this function, with the field.
            unsafe { self.raw.destroy_device(None) };
        }
    }
}
