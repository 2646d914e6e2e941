//! Handles that are used after their end, and the host's device, which is released when nothing uses it any more.

use std::sync::atomic::{AtomicU32, Ordering};

use super::*;
use rara_c::layer_info::rara_scene_buffers_layer_count;

/// # Safety
/// `user` points to a number.
unsafe extern "C" fn count(user: *mut c_void) {
    // SAFETY: the caller's promise.
    unsafe { &*user.cast::<AtomicU32>() }.fetch_add(1, Ordering::Relaxed);
}

#[test]
fn what_was_destroyed_is_refused_and_the_device_is_released_at_last() {
    let host = host();
    let ours = host.lend();
    let released = AtomicU32::new(0);
    let releases = || released.load(Ordering::Relaxed);
    // SAFETY: the system's loader; every handle is alive or was destroyed, and every pointer is alive, or to be overwritten.
    unsafe {
        let entry = Entry::load().expect("a Vulkan loader");
        let mut desc: RaraAdoptDesc = std::mem::zeroed();
        assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
        assert!(desc.release.is_none() && desc.release_user.is_null());
        desc.get_instance_proc_addr = Some(entry.static_fn().get_instance_proc_addr);
        (desc.instance, desc.physical_device) = (ours.instance.handle(), ours.physical_device);
        (desc.device, desc.queue) = (ours.device.handle(), ours.queue);
        desc.release = Some(count);
        desc.release_user = (&raw const released).cast_mut().cast();
        let mut device = null_mut();
        desc.queue_family = 99;
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "no queue family 99");
        assert_eq!(releases(), 0, "nothing was adopted");
        desc.queue_family = ours.queue_family;
        assert_ok(rara_device_adopt(&desc, &mut device));

        let (mut gaussians, mut scene, mut renderer) = (null_mut(), null_mut(), null_mut());
        let (data, size) = (SCENE.as_ptr(), SCENE.len());
        let loaded =
            rara_gaussians_load_from(data, size, c"one".as_ptr(), null(), 0, &mut gaussians);
        assert_ok(loaded);
        let format = RARA_SH_FORMAT_HALF;
        assert_ok(rara_scene_buffers_upload(
            device,
            &one_layer(gaussians),
            1,
            format,
            &mut scene,
        ));
        let mut camera: RaraCamera = std::mem::zeroed();
        let up = [0.0, -1.0, 0.0];
        let framed = rara_camera_frame(
            gaussians,
            up.as_ptr(),
            50.0,
            90,
            60,
            &mut camera,
            size_of::<RaraCamera>(),
        );
        assert_ok(framed);
        let mut desc: RaraRendererDesc = std::mem::zeroed();
        assert_ok(rara_renderer_desc_default(
            &mut desc,
            size_of_val(&desc),
            FORMAT,
        ));
        assert_ok(rara_renderer_create(device, &desc, &mut renderer));
        let mut frame = null_mut();
        let mut configure = |scene| {
            rara_frame_destroy(frame);
            rara_renderer_configure(renderer, scene, &camera, null(), null(), &mut frame)
        };
        assert_ok(configure(scene));

        // What is to go after a fence is refused at once, and goes when the fence is signalled.
        let mut last = null_mut();
        let layer = one_layer(gaussians);
        assert_ok(rara_scene_buffers_upload(
            device, &layer, 1, format, &mut last,
        ));
        let fence = ours
            .device
            .create_fence(&Default::default(), None)
            .expect("a fence");
        let (before, mut left) = (rara_device_bytes(device), 0);
        assert_ok(rara_device_destroy_after(device, null_mut(), fence));
        assert_ok(rara_device_destroy_after(device, last.cast(), fence));
        for object in [last.cast(), (&raw mut left).cast()] {
            let failed = rara_device_destroy_after(device, object, fence);
            assert_fails(
                failed,
                RARA_ERROR_INVALID,
                "object is no handle that is alive",
            );
        }
        let failed = rara_device_destroy_after(device, device.cast(), fence);
        assert_fails(failed, RARA_ERROR_INVALID, "object is a RaraDevice");
        let failed = rara_device_destroy_after(device, scene.cast(), vk::Fence::null());
        assert_fails(failed, RARA_ERROR_INVALID, "fence is null");
        assert_eq!(
            rara_scene_buffers_layer_count(last),
            0,
            "its handle has ended"
        );
        assert_ok(rara_device_destroy_finished(device, &mut left));
        assert_eq!((left, rara_device_bytes(device)), (1, before));
        ours.device
            .queue_submit2(ours.queue, &[], fence)
            .expect("submits");
        ours.device
            .wait_for_fences(&[fence], true, u64::MAX)
            .expect("waits");
        assert_ok(rara_device_destroy_finished(device, null_mut()));
        assert!(rara_device_bytes(device) < before);
        ours.device.destroy_fence(fence, None);

        rara_gaussians_destroy(gaussians);
        let mut again = null_mut();
        let failed =
            rara_scene_buffers_upload(device, &one_layer(gaussians), 1, format, &mut again);
        assert_fails(
            failed,
            RARA_ERROR_INVALID,
            "gaussians is no RaraGaussians that is alive",
        );
        // The device lives on in what was made from it.
        rara_device_destroy(device);
        let mut other = null_mut();
        let failed = rara_renderer_create(device, &desc, &mut other);
        assert_fails(
            failed,
            RARA_ERROR_INVALID,
            "device is no RaraDevice that is alive",
        );
        assert_eq!((rara_device_bytes(device), releases()), (0, 0));
        assert_ok(configure(scene));

        rara_scene_buffers_destroy(scene);
        let says = "scene is no RaraSceneBuffers that is alive: it was destroyed";
        assert_fails(configure(scene), RARA_ERROR_INVALID, says);
        // Nothing is recorded into it: the scene is seen to be none before.
        let cmd = <vk::CommandBuffer as vk::Handle>::from_raw(8);
        let failed = rara_renderer_prepare(renderer, cmd, scene, null(), null_mut());
        assert_fails(failed, RARA_ERROR_INVALID, says);
        assert_eq!(rara_scene_buffers_layer_count(scene), 0);
        rara_scene_buffers_destroy(scene);
        // A handle of another kind.
        let mut other = null_mut();
        let loaded = rara_gaussians_load_from(data, size, c"one".as_ptr(), null(), 0, &mut other);
        assert_ok(loaded);
        let failed = configure(other.cast::<RaraSceneBuffers>());
        assert_fails(failed, RARA_ERROR_INVALID, "scene is no RaraSceneBuffers");
        rara_gaussians_destroy(other);
        assert_eq!(releases(), 0, "the renderer is left");

        rara_renderer_destroy(renderer);
        assert_eq!(releases(), 1);
        rara_renderer_destroy(renderer);
        let says = "renderer is no RaraRenderer that is alive: it was destroyed";
        assert_fails(configure(scene), RARA_ERROR_INVALID, says);
        assert_fails(rara_renderer_forget(renderer), RARA_ERROR_INVALID, says);
        let mut stats: RaraFrameStats = std::mem::zeroed();
        let failed = rara_renderer_stats(renderer, &mut stats, size_of_val(&stats));
        assert_fails(failed, RARA_ERROR_INVALID, says);
        assert_eq!(releases(), 1, "once");
    }
    assert_eq!(host.close(), Vec::<String>::new());
}
