//! Physical devices that pretend to lack something.

use std::ffi::{c_char, c_void};

use ash::vk;

use super::{driver, with};

/// The kind of device that a physical device pretends to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pretence {
    Vulkan11,
    Vulkan12,
    /// One without a single extension.
    Vulkan12Alone,
    Without(&'static str),
    WithoutGraphics,
    /// One with a second queue family, which only computes and copies.
    SecondFamily,
    WithoutExtensions,
    WithoutSubgroups,
    ExtensionsFail,
    CreateFails(vk::Result),
}

fn pretence() -> Option<Pretence> {
    with(|state| state.pretence)
}

/// The structs of a chain.
///
/// # Safety
///
/// `first` is null or begins a valid chain, which outlives the iterator.
unsafe fn chain(first: *mut c_void) -> impl Iterator<Item = *mut vk::BaseOutStructure<'static>> {
    let one = |next: *mut vk::BaseOutStructure<'static>| (!next.is_null()).then_some(next);
    std::iter::successors(one(first.cast()), move |&next| {
        // SAFETY: none of them is null, and each struct begins with its type and the next one.
        one(unsafe { (*next).p_next })
    })
}

pub(super) unsafe extern "system" fn properties(
    physical: vk::PhysicalDevice,
    out: *mut vk::PhysicalDeviceProperties,
) {
    // SAFETY: the caller's arguments, passed on.
    unsafe {
        (driver().fp_v1_0().get_physical_device_properties)(physical, out);
        match pretence() {
            Some(Pretence::Vulkan11) => (*out).api_version = vk::API_VERSION_1_1,
            Some(Pretence::Vulkan12 | Pretence::Vulkan12Alone) => {
                (*out).api_version = vk::API_VERSION_1_2;
            }
            _ => {}
        }
    }
}

pub(super) unsafe extern "system" fn properties2(
    physical: vk::PhysicalDevice,
    out: *mut vk::PhysicalDeviceProperties2<'_>,
) {
    // SAFETY: the caller's arguments, passed on; each struct of the chain begins with its type and the next one.
    unsafe {
        (driver().fp_v1_1().get_physical_device_properties2)(physical, out);
        if pretence() == Some(Pretence::WithoutSubgroups) {
            for next in chain((*out).p_next) {
                if (*next).s_type == vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES {
                    type All = vk::PhysicalDeviceVulkan11Properties<'static>;
                    (*next.cast::<All>()).subgroup_supported_operations =
                        vk::SubgroupFeatureFlags::BASIC;
                }
            }
        }
    }
}

pub(super) unsafe extern "system" fn queue_families(
    physical: vk::PhysicalDevice,
    count: *mut u32,
    out: *mut vk::QueueFamilyProperties,
) {
    let real = driver()
        .fp_v1_0()
        .get_physical_device_queue_family_properties;
    // SAFETY: the caller's arguments, passed on; it has made room for `count`, and real devices have at least one family.
    unsafe {
        let second = u32::from(pretence() == Some(Pretence::SecondFamily));
        if !out.is_null() {
            *count -= second;
        }
        real(physical, count, out);
        if second == 1 && !out.is_null() {
            let mut computes = *out;
            computes.queue_flags &= !vk::QueueFlags::GRAPHICS;
            out.add(*count as usize).write(computes);
        }
        *count += second;
        if pretence() == Some(Pretence::WithoutGraphics) && !out.is_null() {
            for family in std::slice::from_raw_parts_mut(out, *count as usize) {
                family.queue_flags &= !vk::QueueFlags::GRAPHICS;
            }
        }
    }
}

pub(super) unsafe extern "system" fn extensions(
    physical: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    out: *mut vk::ExtensionProperties,
) -> vk::Result {
    let real = driver().fp_v1_0().enumerate_device_extension_properties;
    match pretence() {
        Some(Pretence::ExtensionsFail) => vk::Result::ERROR_OUT_OF_HOST_MEMORY,
        Some(Pretence::WithoutExtensions | Pretence::Vulkan12Alone) => {
            // SAFETY: the caller's pointer.
            unsafe { *count = 0 };
            vk::Result::SUCCESS
        }
        // SAFETY: the caller's arguments, passed on.
        _ => unsafe { real(physical, layer, count, out) },
    }
}

pub(super) unsafe extern "system" fn features(
    physical: vk::PhysicalDevice,
    out: *mut vk::PhysicalDeviceFeatures2<'_>,
) {
    // SAFETY: the caller's arguments, passed on; each struct of the chain begins with its type and the next one.
    unsafe {
        (driver().fp_v1_1().get_physical_device_features2)(physical, out);
        let Some(Pretence::Without(feature)) = pretence() else {
            return;
        };
        for next in chain((*out).p_next) {
            match (*next).s_type {
                vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => {
                    let all = &mut *next.cast::<vk::PhysicalDeviceVulkan12Features<'static>>();
                    if feature == "bufferDeviceAddress" {
                        all.buffer_device_address = vk::FALSE;
                    }
                }
                vk::StructureType::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES
                    if feature == "synchronization2" =>
                {
                    type One = vk::PhysicalDeviceSynchronization2Features<'static>;
                    (*next.cast::<One>()).synchronization2 = vk::FALSE;
                }
                vk::StructureType::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES
                    if feature == "dynamicRendering" =>
                {
                    type One = vk::PhysicalDeviceDynamicRenderingFeatures<'static>;
                    (*next.cast::<One>()).dynamic_rendering = vk::FALSE;
                }
                _ => {}
            }
        }
    }
}

pub(super) unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    out: *mut vk::Device,
) -> vk::Result {
    if let Some(Pretence::CreateFails(result)) = pretence() {
        return result;
    }
    // SAFETY: the caller's arguments, passed on.
    unsafe { (driver().fp_v1_0().create_device)(physical, info, allocator, out) }
}
