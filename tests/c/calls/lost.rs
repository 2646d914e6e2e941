//! A device that is lost: the host's functions say so.

use std::ffi::c_char;
use std::sync::OnceLock;

use super::*;

/// The system's functions, which those that lose the device call.
static REAL: OnceLock<(vk::PFN_vkGetInstanceProcAddr, vk::PFN_vkGetDeviceProcAddr)> =
    OnceLock::new();

/// # Safety
/// As for vkGetInstanceProcAddr.
unsafe extern "system" fn instance_function(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let (real, _) = REAL.get().expect("set by the test");
    // SAFETY: the caller's promise; a function's type is known by its name.
    unsafe {
        match CStr::from_ptr(name).to_bytes() {
            b"vkGetDeviceProcAddr" => Some(std::mem::transmute::<
                vk::PFN_vkGetDeviceProcAddr,
                unsafe extern "system" fn(),
            >(device_function)),
            _ => real(instance, name),
        }
    }
}

/// # Safety
/// As for vkGetDeviceProcAddr.
unsafe extern "system" fn device_function(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    unsafe extern "system" fn lost(
        _: vk::Queue,
        _: u32,
        _: *const vk::SubmitInfo2<'_>,
        _: vk::Fence,
    ) -> vk::Result {
        vk::Result::ERROR_DEVICE_LOST
    }
    let (_, real) = REAL.get().expect("set by the test");
    // SAFETY: as above.
    unsafe {
        match CStr::from_ptr(name).to_bytes() {
            b"vkQueueSubmit2" | b"vkQueueSubmit2KHR" => Some(std::mem::transmute::<
                vk::PFN_vkQueueSubmit2,
                unsafe extern "system" fn(),
            >(lost)),
            _ => real(device, name),
        }
    }
}

#[test]
fn a_lost_device_has_a_code_of_its_own() {
    let host = host();
    let ours = host.lend();
    // SAFETY: the system's loader; every handle and pointer below is alive, or to be overwritten.
    unsafe {
        let entry = Entry::load().expect("a Vulkan loader");
        let real = (
            entry.static_fn().get_instance_proc_addr,
            ours.instance.fp_v1_0().get_device_proc_addr,
        );
        REAL.set(real).expect("set once");
        let mut desc: RaraAdoptDesc = std::mem::zeroed();
        assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
        desc.get_instance_proc_addr = Some(instance_function);
        (desc.instance, desc.physical_device) = (ours.instance.handle(), ours.physical_device);
        (desc.device, desc.queue) = (ours.device.handle(), ours.queue);
        desc.queue_family = ours.queue_family;
        let (mut device, mut gaussians, mut scene) = (null_mut(), null_mut(), null_mut());
        assert_ok(rara_device_adopt(&desc, &mut device));
        let (data, size) = (SCENE.as_ptr(), SCENE.len());
        assert_ok(rara_gaussians_load_from(
            data,
            size,
            c"one".as_ptr(),
            null(),
            0,
            &mut gaussians,
        ));
        let lost = rara_scene_buffers_upload(
            device,
            &one_layer(gaussians),
            1,
            RARA_SH_FORMAT_HALF,
            &mut scene,
        );
        assert_fails(
            lost,
            RARA_ERROR_DEVICE_LOST,
            "the device was lost (vkQueueSubmit2)",
        );
        assert!(scene.is_null());
        rara_gaussians_destroy(gaussians);
        assert_eq!(
            rara_device_bytes(device),
            0,
            "everything allocated was freed"
        );
        rara_device_destroy(device);
    }
    assert_eq!(host.close(), Vec::<String>::new());
}
