//! The descriptions that devices are opened or adopted from.

use std::any::Any;
use std::sync::{Arc, Mutex};

use ash::vk;
use gpu_allocator::vulkan::Allocator;

use super::lent::MemorySource;
use super::shape::DeviceShape;
use rara_base::setters;

/// The description of the device that [`Device::headless`](super::Device::headless) opens.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct DeviceDesc {
    /// A number from [`list_devices`](super::list_devices) or part of a name; `None` is the best device.
    pub selector: Option<String>,
    /// Load the Khronos validation layer with synchronisation checks.
    pub validation: bool,
    /// Enable pipeline statistics where the device has them.
    pub statistics: bool,
    /// The name that drivers and capture tools show.
    pub application_name: String,
    /// The kind of machine that pipelines are chosen for; `None` is what suits the device.
    pub shape: Option<DeviceShape>,
}

setters!(DeviceDesc {
    selector: Option<String>,
    validation: bool,
    statistics: bool,
    application_name: String,
    shape: Option<DeviceShape>,
});

impl Default for DeviceDesc {
    fn default() -> Self {
        Self {
            selector: None,
            validation: false,
            statistics: false,
            application_name: "rara".into(),
            shape: None,
        }
    }
}

/// A host's own device, for [`Device::adopt`](super::Device::adopt): [`AdoptDesc::new`], and what the host has enabled besides.
#[derive(Clone)]
#[non_exhaustive]
pub struct AdoptDesc {
    /// `VkApplicationInfo::apiVersion` of the instance: 1.2 or later.
    pub api_version: u32,
    /// The instance, created for this version.
    pub instance: ash::Instance,
    /// The physical device from which the device below was made.
    pub physical_device: vk::PhysicalDevice,
    /// The device, created with [`Support::features`](super::Support::features), and with those of
    /// [`Support::extensions`](super::Support::extensions) that the flags below name.
    pub device: ash::Device,
    /// A queue for graphics and compute. rara's own submissions go to it, and so does everything that is recorded, but for
    /// what [`shared_families`](Self::shared_families) allows.
    pub queue: vk::Queue,
    /// The queue's family.
    pub queue_family: u32,
    /// Further queue families whose queues use rara's memory: for the compute commands of frames, or for the copies of
    /// `SceneBuffers::upload_with`. rara's buffers are then shared by all of them (`VK_SHARING_MODE_CONCURRENT`), so that none
    /// has to change its owner. None are needed for several queues of one family.
    pub shared_families: Vec<u32>,
    /// False when `bufferDeviceAddress` was not enabled: [`Bindings::Bound`](super::Bindings::Bound) takes the place of the
    /// other ways, and needs [`push_descriptor`](Self::push_descriptor). It counts where the device has the feature.
    pub buffer_device_address: bool,
    /// True when `VK_EXT_mesh_shader` and its features were enabled.
    pub mesh_shader: bool,
    /// True when `VK_KHR_push_descriptor` was enabled.
    pub push_descriptor: bool,
    /// True when `subgroupSizeControl` and `computeFullSubgroups` were enabled.
    pub full_subgroups: bool,
    /// True when `VK_EXT_debug_utils` was enabled on the instance.
    pub debug_utils: bool,
    /// True when the feature `pipelineStatisticsQuery` was enabled.
    pub pipeline_statistics: bool,
    /// The cache in which compiled pipelines are looked up and kept; null for none.
    pub pipeline_cache: vk::PipelineCache,
    /// The source of all device memory, made for this device and with `buffer_device_address` where that is enabled. `None`
    /// means an allocator of rara's own. It is locked while a buffer or an image is made or destroyed, never by
    /// `Renderer::prepare` or a draw.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
    /// The source of all device memory in place of an allocator, for a host whose own is no `gpu_allocator`. `None` where there
    /// is none.
    pub memory: Option<Arc<dyn MemorySource>>,
    /// The kind of machine that pipelines are chosen for; `None` is what suits the device.
    pub shape: Option<DeviceShape>,
    /// A value that keeps the host's device and instance alive. It is dropped after the last clone of the
    /// [`Device`](super::Device) and everything that was made from them. `None` if the host keeps them alive by itself.
    pub keep_alive: Option<Arc<dyn Any + Send + Sync>>,
}

setters!(AdoptDesc {
    shared_families: Vec<u32>,
    buffer_device_address: bool,
    mesh_shader: bool,
    push_descriptor: bool,
    full_subgroups: bool,
    debug_utils: bool,
    pipeline_statistics: bool,
    pipeline_cache: vk::PipelineCache,
    allocator: Option<Arc<Mutex<Allocator>>>,
    memory: Option<Arc<dyn MemorySource>>,
    shape: Option<DeviceShape>,
    keep_alive: Option<Arc<dyn Any + Send + Sync>>,
});

impl AdoptDesc {
    /// A device of one queue family, with `bufferDeviceAddress` where it has that and nothing else that is optional, no
    /// pipeline cache, and an allocator of rara's own.
    pub fn new(
        api_version: u32,
        instance: ash::Instance,
        physical_device: vk::PhysicalDevice,
        device: ash::Device,
        (queue, queue_family): (vk::Queue, u32),
    ) -> Self {
        Self {
            api_version,
            instance,
            physical_device,
            device,
            queue,
            queue_family,
            shared_families: Vec::new(),
            buffer_device_address: true,
            mesh_shader: false,
            push_descriptor: false,
            full_subgroups: false,
            debug_utils: false,
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            allocator: None,
            memory: None,
            shape: None,
            keep_alive: None,
        }
    }
}

impl std::fmt::Debug for AdoptDesc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AdoptDesc")
            .field("physical_device", &self.physical_device)
            .field("queue_family", &self.queue_family)
            .finish_non_exhaustive()
    }
}
