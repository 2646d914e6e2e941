//! The host's own device, lent to rara.

use std::ffi::c_void;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rara::ash::{self, vk};
use rara::gpu::{AdoptDesc, Device, DeviceShape};
use rara::{Error, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, list, read, versioned, write};
use crate::handles::{alive, create, destroy, end, number};
use crate::lent::{Lender, RaraAllocate, RaraFree};

/// `vkGetInstanceProcAddr`, or null.
#[allow(non_camel_case_types)] // Vulkan's name
pub type PFN_vkGetInstanceProcAddr = Option<vk::PFN_vkGetInstanceProcAddr>;

/// A host's device as rara uses it. Several threads may use it at once.
pub struct RaraDevice(pub(crate) Device);

/// For what kind of machine pipelines are chosen.
pub type RaraShape = u32;
/// The one that the device says it is. The default.
pub const RARA_SHAPE_AUTO: RaraShape = 0;
/// A driver that runs shaders on the processor's cores.
pub const RARA_SHAPE_CPU: RaraShape = 1;
/// A graphics processor.
pub const RARA_SHAPE_GPU: RaraShape = 2;

/// A host's own Vulkan, for rara_device_adopt. All of it stays the host's.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraAdoptDesc {
    /// Set by rara_adopt_desc_default.
    pub struct_size: usize,
    /// The loader's vkGetInstanceProcAddr.
    pub get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    /// Created for `api_version` below.
    pub instance: vk::Instance,
    /// The physical device that the device below was made from.
    pub physical_device: vk::PhysicalDevice,
    /// Created with what rara_support_features sets.
    pub device: vk::Device,
    /// A queue with graphics and compute. What rara itself submits goes to it, and so does everything that it records, but for
    /// what `shared_families` allows.
    pub queue: vk::Queue,
    /// The queue's family.
    pub queue_family: u32,
    /// True when VK_EXT_mesh_shader, meshShader and taskShader were enabled. Default: false.
    pub mesh_shader: vk::Bool32,
    /// True when VK_KHR_push_descriptor was enabled. Default: false.
    pub push_descriptor: vk::Bool32,
    /// True when VK_EXT_debug_utils was enabled on the instance: rara then names its objects and labels its stages.
    /// Default: false.
    pub debug_utils: vk::Bool32,
    /// The cache in which compiled pipelines are looked up and kept. Default: null, and none are kept.
    pub pipeline_cache: vk::PipelineCache,
    /// VkApplicationInfo::apiVersion of the instance, 1.2 or later. Default: VK_API_VERSION_1_3.
    pub api_version: u32,
    /// True when subgroupSizeControl and computeFullSubgroups were enabled, for which the host's chain needs
    /// VkPhysicalDeviceVulkan13Features or VkPhysicalDeviceSubgroupSizeControlFeatures. Default: false.
    pub full_subgroups: vk::Bool32,
    /// For what kind of machine pipelines are chosen. Pictures depend on it only by the rounding of sums. Default:
    /// RARA_SHAPE_AUTO.
    pub shape: RaraShape,
    /// With RARA_SHAPE_GPU the invocations of a subgroup that pipelines ask for, a power of two that the device can be asked
    /// for; 0, the default, for pipelines without subgroup operations. Otherwise ignored.
    pub subgroup: u32,
    /// Called once, when rara uses nothing of the host's any more, with `release_user`: by the call that ends the last of the
    /// RaraDevice and of what was made from it. Until then the host keeps its device. It may be on any thread, must throw
    /// nothing, and may destroy the device. It is not called after rara_device_adopt has failed. Null, the default, for none.
    pub release: RaraRelease,
    /// The value that `release` is called with. Default: null.
    pub release_user: *mut c_void,
    /// Lends all device memory that rara uses, such as vmaAllocateMemory does. Any thread calls it that makes or destroys
    /// something of rara's, several at once; rara_renderer_prepare and rara_renderer_draw never do. Null, the default, for
    /// an allocator of rara's own.
    pub allocate: RaraAllocate,
    /// Takes back what `allocate` has lent; null where that is.
    pub free: RaraFree,
    /// The value that `allocate` and `free` are called with. Default: null.
    pub allocator_user: *mut c_void,
    /// True when the feature pipelineStatisticsQuery was enabled. Default: false.
    pub pipeline_statistics: vk::Bool32,
    /// False when the feature bufferDeviceAddress was not enabled: RARA_BINDINGS_BOUND takes the place of the other ways, and
    /// needs `push_descriptor`. Default: true, which counts where the device has the feature.
    pub buffer_device_address: vk::Bool32,
    /// Further queue families whose queues use rara's memory: for `compute_family` of RaraRendererDesc, or for the copies of
    /// rara_scene_buffers_upload_with. Buffers are then created with VK_SHARING_MODE_CONCURRENT for all of them. Only the call
    /// itself reads it. Null, the default, for none.
    pub shared_families: *const u32,
    /// How many there are. Default: 0.
    pub shared_family_count: usize,
}

versioned!(RaraAdoptDesc);

const NOTHING: RaraAdoptDesc = RaraAdoptDesc {
    api_version: vk::API_VERSION_1_3,
    buffer_device_address: vk::TRUE,
    ..Versioned::BLANK
};

/// Takes the news that rara uses nothing of the host's any more.
pub type RaraRelease = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// Tells the host when it is dropped that its device is not used any more.
struct Release {
    release: RaraRelease,
    user: *mut c_void,
    /// False until the device has been adopted.
    armed: AtomicBool,
}

// SAFETY: whoever calls rara_device_adopt promises that any thread may call the function with this pointer.
unsafe impl Send for Release {}
// SAFETY: as above; it is called once.
unsafe impl Sync for Release {}

impl Drop for Release {
    fn drop(&mut self) {
        if let Some(release) = self.release.filter(|_| *self.armed.get_mut()) {
            // SAFETY: the host's promise, and nothing of the device is left.
            unsafe { release(self.user) };
        }
    }
}

/// Enables nothing optional but bufferDeviceAddress, and sets all handles to null; the host replaces them. `desc_size` is
/// sizeof *desc.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_adopt_desc_default(
    desc: *mut RaraAdoptDesc,
    desc_size: usize,
) -> RaraResult {
    guard(|| write(desc, desc_size, &NOTHING, "desc"))
}

/// Works with the host's device. Nothing in `desc` is ever destroyed, and only rara_scene_buffers_upload and
/// rara_renderer_channels submit to the queue. RARA_ERROR_INVALID names an extension that the description claims and whose
/// functions the device does not have. Features that are claimed cannot be checked.
///
/// # Safety
/// The handles belong together, are as the description says, and outlive all that is made from the RaraDevice, of which
/// `release` tells the end. It may be called with `release_user` by any thread, and so may `allocate` and `free` with
/// `allocator_user`; they keep what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_adopt(
    desc: *const RaraAdoptDesc,
    device: *mut *mut RaraDevice,
) -> RaraResult {
    create(device, "device", || {
        let desc = read(desc, NOTHING, "desc")?;
        let instance = load_instance(
            desc.get_instance_proc_addr,
            desc.instance,
            desc.physical_device,
        )?;
        let device = load_device(&instance, &desc)?;
        let queue = (desc.queue, desc.queue_family);
        let version = desc.api_version;
        let (first, count) = (desc.shared_families, desc.shared_family_count);
        let families = list(first, count, "desc->shared_families")?;
        let lender = Lender::new(desc.allocate, desc.free, desc.allocator_user)?;
        let adopt = AdoptDesc::new(version, instance, desc.physical_device, device, queue)
            .shared_families(families.to_vec())
            .buffer_device_address(desc.buffer_device_address != 0)
            .mesh_shader(desc.mesh_shader != 0)
            .push_descriptor(desc.push_descriptor != 0)
            .full_subgroups(desc.full_subgroups != 0)
            .shape(shape(&desc)?)
            .debug_utils(desc.debug_utils != 0)
            .pipeline_statistics(desc.pipeline_statistics != 0)
            .pipeline_cache(desc.pipeline_cache)
            .memory(lender.map(|lender| Arc::new(lender) as _));
        let release = Arc::new(Release {
            release: desc.release,
            user: desc.release_user,
            armed: AtomicBool::new(false),
        });
        let device = Device::adopt(adopt.keep_alive(Some(release.clone())))?;
        release.armed.store(true, Ordering::Relaxed);
        Ok(RaraDevice(device))
    })
}

/// Bytes of device memory that rara has allocated on the device, 0 for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_bytes(device: *const RaraDevice) -> u64 {
    number(device, "device", |device| device.0.device_bytes())
}

/// Destroys what frames in flight may still use, when a fence is signalled: a RaraSceneBuffers, a RaraRenderer, a RaraFrame, a
/// RaraCut, a RaraPicker or a RaraLayerEditor that was made from `device`. Its handle ends at once; null is ignored.
/// rara_device_destroy_finished destroys it afterwards, and until then it keeps the device, so that a host calls that once more
/// before rara_device_destroy. RARA_ERROR_INVALID for what is not alive; nothing is destroyed then.
///
/// # Safety
/// `fence` is of the VkDevice, and belongs to a submission that is unfinished or yet to come, behind all that uses the object. It
/// lives until the object has been destroyed; it may be reset and submitted again before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_destroy_after(
    device: *const RaraDevice,
    object: *mut c_void,
    fence: vk::Fence,
) -> RaraResult {
    guard(|| {
        let device = alive(device, "device")?;
        if fence == vk::Fence::null() {
            return invalid("fence is null");
        }
        if !object.is_null() {
            device
                .0
                .drop_after(end::<RaraDevice>(object, "object")?, fence);
        }
        Ok(())
    })
}

/// Destroys what was given to rara_device_destroy_after and whose fence is signalled, or all of it where the device is lost.
/// Nothing waits. `*left`, unless `left` is null, becomes how many objects are still kept. No other thread resets one of the
/// fences meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_destroy_finished(
    device: *const RaraDevice,
    left: *mut usize,
) -> RaraResult {
    guard(|| {
        let kept = alive(device, "device")?.0.drop_finished();
        if let Some(left) = left.as_mut() {
            *left = kept;
        }
        Ok(())
    })
}

/// Gives the device back; the VkDevice lives on. What was made from the RaraDevice may be destroyed later, but before the
/// VkDevice. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_device_destroy(device: *mut RaraDevice) {
    destroy(device);
}

fn shape(desc: &RaraAdoptDesc) -> Result<Option<DeviceShape>> {
    Ok(match desc.shape {
        RARA_SHAPE_AUTO => None,
        RARA_SHAPE_CPU => Some(DeviceShape::Cpu),
        RARA_SHAPE_GPU => Some(DeviceShape::Gpu {
            subgroup: desc.subgroup,
        }),
        other => return invalid(format!("desc->shape is {other}, which no RaraShape is")),
    })
}

/// The instance's functions. Those of Vulkan 1.1 must be there: ash would abort where one is missing.
pub(crate) unsafe fn load_instance(
    get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
) -> Result<ash::Instance> {
    let Some(get_instance_proc_addr) = get_instance_proc_addr else {
        return invalid("get_instance_proc_addr is null");
    };
    if instance == vk::Instance::null() {
        return invalid("instance is null");
    }
    if physical_device == vk::PhysicalDevice::null() {
        return invalid("physical_device is null");
    }
    for name in [
        c"vkGetPhysicalDeviceFeatures2",
        c"vkGetPhysicalDeviceProperties2",
    ] {
        // SAFETY: the instance is alive, as the caller promises.
        if unsafe { get_instance_proc_addr(instance, name.as_ptr()) }.is_none() {
            return Err(Error::Device(
                "the instance was not created for Vulkan 1.2 or later: set VkApplicationInfo::apiVersion to \
                 VK_API_VERSION_1_3"
                    .into(),
            ));
        }
    }
    let functions = ash::StaticFn {
        get_instance_proc_addr,
    };
    Ok(ash::Instance::load(&functions, instance))
}

/// The device's functions. Device::adopt checks that it has those of the extensions that the host says it has enabled.
unsafe fn load_device(instance: &ash::Instance, desc: &RaraAdoptDesc) -> Result<ash::Device> {
    if desc.device == vk::Device::null() {
        return invalid("desc->device is null");
    }
    if desc.queue == vk::Queue::null() {
        return invalid("desc->queue is null");
    }
    // SAFETY: both handles are alive and not null, as the caller promises and was checked.
    Ok(unsafe { ash::Device::load(instance.fp_v1_0(), desc.device) })
}
