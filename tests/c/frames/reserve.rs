//! Room that a host in C reserves: frames within it compile and allocate nothing, and a budget is kept.

use super::*;
use crate::clips::clip_of;
use crate::results::assert_fails;
use std::ptr::{null, null_mut};

use rara_c::boundary::{RARA_ERROR_INVALID, RARA_ERROR_MEMORY};
use rara_c::camera::*;
use rara_c::clip::*;
use rara_c::frame::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;
use rara_c::reserve::*;
use rara_c::settings::*;

/// What is there on a device.
fn memory(device: *const RaraDevice) -> RaraDeviceMemory {
    // SAFETY: the device is alive, and all bytes may be zero.
    unsafe {
        let mut memory: RaraDeviceMemory = std::mem::zeroed();
        assert_ok(rara_device_memory(
            device,
            &mut memory,
            size_of_val(&memory),
        ));
        memory
    }
}

/// What takes that memory, by name, and all of it together.
fn parts(device: *const RaraDevice) -> (Vec<String>, u64) {
    let mut count = 0;
    // SAFETY: the device is alive, and there is as much room as `count` says.
    unsafe {
        assert_ok(rara_device_memory_by_name(device, null_mut(), &mut count));
        let mut parts: Vec<RaraNamedBytes> = vec![std::mem::zeroed(); count];
        assert_ok(rara_device_memory_by_name(
            device,
            parts.as_mut_ptr(),
            &mut count,
        ));
        assert_eq!(count, parts.len());
        let name = |part: &RaraNamedBytes| {
            let text = std::ffi::CStr::from_ptr(part.name.as_ptr());
            text.to_str().expect("UTF-8").to_owned()
        };
        let bytes = parts.iter().map(|part| part.bytes).sum();
        (parts.iter().map(name).collect(), bytes)
    }
}

fn made(device: *const RaraDevice) -> (u64, u64) {
    let memory = memory(device);
    (memory.pipeline_count, memory.allocation_count)
}

/// The default settings in a mode.
fn settings(mode: RaraMode) -> RaraSettings {
    // SAFETY: all bytes may be zero.
    unsafe {
        let mut settings: RaraSettings = std::mem::zeroed();
        let (size, preset) = (size_of_val(&settings), RARA_PRESET_BALANCED);
        assert_ok(rara_settings_default(&mut settings, size, preset));
        settings.mode = mode;
        settings
    }
}

#[test]
fn a_host_in_c_reserves_within_a_budget_and_gives_back() {
    with_both(1_000, |_, _, _, ours| {
        let uploaded = ours.uploaded();
        let device = ours.device;
        // SAFETY: handles are alive until they are destroyed, structs are as their fields say.
        unsafe {
            let mut desc: RaraRendererDesc = std::mem::zeroed();
            let format = vk::Format::R8G8B8A8_UNORM;
            assert_ok(rara_renderer_desc_default(
                &mut desc,
                size_of_val(&desc),
                format,
            ));
            let mut renderer = null_mut();
            assert_ok(rara_renderer_create(device, &desc, &mut renderer));
            let mut limits: RaraFrameLimits = std::mem::zeroed();
            let size = size_of_val(&limits);
            assert_ok(rara_frame_limits_default(&mut limits, size, 128, 96, 1_000));
            let all = [settings(RARA_MODE_NONE), settings(RARA_MODE_EXACT)];
            (limits.settings, limits.settings_count) = (all.as_ptr(), all.len());
            (limits.planes, limits.pairs) = (2, 200_000);

            let before = memory(device);
            assert_eq!(before.budget, 0);
            assert_ok(rara_device_set_memory_budget(
                device,
                before.bytes + (1 << 10),
            ));
            let refused = rara_renderer_reserve(renderer, &limits);
            assert_fails(refused, RARA_ERROR_MEMORY, "rara_device_set_memory_budget");
            assert_eq!(
                made(device),
                (before.pipeline_count, before.allocation_count)
            );
            let budget = before.bytes + (64 << 20);
            assert_ok(rara_device_set_memory_budget(device, budget));
            assert_eq!(memory(device).budget, budget);
            limits.layers = 0;
            let refused = rara_renderer_reserve(renderer, &limits);
            assert_fails(refused, RARA_ERROR_INVALID, "layers is 0");
            limits.layers = 1;
            assert_ok(rara_renderer_reserve(renderer, &limits));

            let (names, bytes) = parts(device);
            assert!(names.iter().any(|name| name == "tile_splats"), "{names:?}");
            assert_eq!(bytes, memory(device).bytes);
            let mut bindings = 99;
            assert_ok(rara_bindings_suiting(device, &mut bindings));
            assert!(bindings <= RARA_BINDINGS_MIXED);

            let reserved = made(device);
            let planes = [([1.0, 0.0, 0.0], 0.0), ([0.0, 1.0, 0.0], 0.3)]
                .map(|(normal, offset)| RaraPlane { normal, offset });
            let (eye, target, up) = ([0.0, -1.0, -4.0], [0.0; 3], [0.0, -1.0, 0.0]);
            let mut pairs = 0;
            for (index, (width, height)) in [(128, 96), (33, 96), (128, 7)].into_iter().enumerate()
            {
                let mut camera: RaraCamera = std::mem::zeroed();
                let looked = rara_camera_look_at(
                    eye.as_ptr(),
                    target.as_ptr(),
                    up.as_ptr(),
                    50.0,
                    width,
                    height,
                    &mut camera,
                    size_of::<RaraCamera>(),
                );
                assert_ok(looked);
                assert_ok(rara_scene_buffers_estimated_pairs(
                    uploaded, &camera, &mut pairs,
                ));
                assert!((1..200_000).contains(&pairs), "{pairs}");
                let clip = clip_of(&planes[..index]);
                for settings in &all {
                    let mut frame = null_mut();
                    assert_ok(rara_renderer_configure(
                        renderer, uploaded, &camera, clip, settings, &mut frame,
                    ));
                    let refused = rara_renderer_trim(renderer, frame);
                    assert_fails(refused, RARA_ERROR_INVALID, "frame was not prepared");
                    rara_frame_destroy(frame);
                }
                rara_clip_destroy(clip);
            }
            assert_eq!(made(device), reserved, "pipelines and allocations");
            let bytes = rara_renderer_bytes(renderer);
            assert_ok(rara_renderer_trim(renderer, null()));
            assert!(rara_renderer_bytes(renderer) < bytes);
            let memory = memory(device);
            assert!(memory.bytes < memory.peak_bytes && memory.peak_bytes <= budget);
            rara_renderer_destroy(renderer);
            rara_scene_buffers_destroy(uploaded);
        }
    });
}
