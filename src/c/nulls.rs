//! Calls every function with null for every pointer, and with a panic inside: both become a code.

use std::cell::Cell;
use std::ptr::{null, null_mut};

use rara::ash::vk;

use crate::arrays::*;
use crate::bake::*;
use crate::boundary::*;
use crate::camera::*;
use crate::camera_files::*;
use crate::channels::*;
use crate::clip::*;
use crate::depth::*;
use crate::device::*;
use crate::frame::*;
use crate::gaussians::*;
use crate::layer::*;
use crate::layer_info::*;
use crate::logging::*;
use crate::matrices::*;
use crate::orthographic::*;
use crate::picker::*;
use crate::placement::*;
use crate::region::*;
use crate::renderer::*;
use crate::renderer_desc::*;
use crate::reserve::*;
use crate::scene::*;
use crate::selection::*;
use crate::settings::*;
use crate::staging::*;
use crate::stats::*;
use crate::support::*;
use crate::tests::{assert_fails, message};

thread_local! {
    static PANIC: Cell<bool> = const { Cell::new(false) };
}

/// Panics when a test asks every function to.
pub(crate) fn panic_if_asked() {
    assert!(!PANIC.get(), "injected");
}

/// What a call with null for every pointer and handle has given: its result, its name, and what its message says.
type Called = (RaraResult, &'static str, &'static str);

macro_rules! call_in {
    ($called:expr, $function:ident($($argument:expr),*), $says:literal) => {
        // SAFETY: every function must stand null.
        $called.push((unsafe { $function($($argument),*) }, stringify!($function), $says));
        assert!($called.last().is_none_or(|(_, name, _)| PANIC.get() || {
            let says = message();
            let is_right = says.contains($says);
            if !is_right { eprintln!("{name}: {says}"); }
            is_right
        }));
    };
}

mod scenes;

/// Calls each function.
fn calls() -> Vec<Called> {
    let mut called = Vec::new();
    macro_rules! call {
        ($($call:tt)*) => { call_in!(called, $($call)*); };
    }
    let map = RaraDepthMap {
        z_near: 1.0,
        z_far: 2.0,
        reversed: 0,
    };
    let format = vk::Format::R8G8B8A8_UNORM;
    let no_device = vk::PhysicalDevice::null();
    let no_cmd = vk::CommandBuffer::null();
    call!(
        rara_check(None, vk::Instance::null(), no_device, 0, null_mut(), 0),
        "get_instance_proc_addr"
    );
    call!(rara_support_features(null(), null_mut()), "support is null");
    call!(
        rara_adopt_desc_default(null_mut(), size_of::<RaraAdoptDesc>()),
        "desc is null"
    );
    call!(rara_device_adopt(null(), null_mut()), "device is null");
    scenes::calls(&mut called);
    call!(
        rara_cameras_load(null(), null_mut(), null_mut()),
        "count is null"
    );
    call!(
        rara_camera_look_at(null(), null(), null(), 50.0, 8, 8, null_mut()),
        "camera is null"
    );
    call!(
        rara_camera_from_world_to_camera(null(), 1.0, 1.0, 0.0, 0.0, 8, 8, null_mut()),
        "camera is null"
    );
    call!(
        rara_camera_frame(null(), null(), 50.0, 8, 8, null_mut()),
        "camera is null"
    );
    call!(
        rara_depth_desc_default(null_mut(), size_of::<RaraDepthDesc>(), format, map),
        "desc is null"
    );
    let image_size = size_of::<RaraDepthImage>();
    call!(
        rara_depth_image_default(null_mut(), image_size, vk::Image::null(), 1, 1),
        "depth is null"
    );
    call!(
        rara_settings_default(null_mut(), size_of::<RaraSettings>(), 0),
        "settings is null"
    );
    call!(
        rara_renderer_desc_default(null_mut(), size_of::<RaraRendererDesc>(), format),
        "desc is null"
    );
    call!(
        rara_renderer_create(null(), null(), null_mut()),
        "renderer is null"
    );
    call!(
        rara_renderer_create_sharing(null(), null(), null_mut()),
        "renderer is null"
    );
    call!(
        rara_renderer_set_depth_map(null_mut(), null()),
        "renderer is null"
    );
    call!(
        rara_renderer_set_color_format(null_mut(), format),
        "renderer is null"
    );
    call!(
        rara_renderer_set_placement(null_mut(), null()),
        "renderer is null"
    );
    call!(
        rara_camera_orthographic(null(), null(), null(), 1.0, 8, 8, null_mut()),
        "camera is null"
    );
    call!(
        rara_renderer_set_orthographic_depth_map(null_mut(), 1.0, 2.0),
        "renderer is null"
    );
    call!(
        rara_ndc_default(null_mut(), size_of::<RaraNdc>()),
        "ndc is null"
    );
    let view_size = size_of::<RaraHostView>();
    call!(
        rara_camera_of_projection(null(), null(), null(), 8, 8, null_mut(), view_size),
        "seen is null"
    );
    call!(
        rara_camera_of_projection_floats(null(), null(), null(), 8, 8, null_mut(), view_size),
        "seen is null"
    );
    call!(
        rara_renderer_set_depth_of_projection(null_mut(), null()),
        "renderer is null"
    );
    call!(
        rara_renderer_configure_orthographic(
            null_mut(),
            null(),
            null(),
            null(),
            null(),
            null_mut()
        ),
        "frame is null"
    );
    call!(
        rara_renderer_configure(null_mut(), null(), null(), null(), null(), null_mut()),
        "frame is null"
    );
    call!(
        rara_renderer_prepare(null_mut(), no_cmd, null(), null(), null_mut()),
        "renderer is null"
    );
    call!(
        rara_renderer_draw(null_mut(), no_cmd, 0.0, 0.0, null()),
        "renderer is null"
    );
    call!(
        rara_renderer_draw_depth(null_mut(), no_cmd, 0.0, 0.0, null()),
        "renderer is null"
    );
    call!(rara_renderer_forget(null_mut()), "renderer is null");
    call!(
        rara_channels_default(null_mut(), size_of::<RaraChannels>(), 1, 1, 1),
        "channels is null"
    );
    call!(
        rara_renderer_channels(null(), null(), 0, null(), 0, null(), null(), null()),
        "renderer is null"
    );
    call!(
        rara_renderer_stats(null(), null_mut(), 0),
        "renderer is null"
    );
    call!(rara_set_log(None, null_mut()), ""); // null stands for nobody
    let refused = rara_set_log_level(6);
    called.push((refused, "rara_set_log_level", "6 is no RaraLogLevel"));
    call!(
        rara_frame_limits_default(null_mut(), size_of::<RaraFrameLimits>(), 1, 1, 1),
        "limits is null"
    );
    call!(
        rara_renderer_reserve(null_mut(), null()),
        "renderer is null"
    );
    call!(rara_renderer_trim(null_mut(), null()), "renderer is null");
    call!(
        rara_scene_buffers_estimated_pairs(null(), null(), null_mut()),
        "pairs is null"
    );
    call!(rara_picker_create(null(), 1, null_mut()), "picker is null");
    call!(
        rara_picker_set_placement(null_mut(), null()),
        "picker is null"
    );
    call!(
        rara_picker_record(
            null_mut(),
            no_cmd,
            null(),
            null(),
            0,
            null(),
            null(),
            0,
            0,
            1,
            1,
            null_mut()
        ),
        "ticket is null"
    );
    call!(
        rara_picker_read(null(), RaraPickTicket::default(), null_mut(), 0, null_mut()),
        "answered is null"
    );
    call!(rara_device_memory(null(), null_mut(), 0), "device is null");
    call!(rara_device_set_memory_budget(null(), 0), "device is null");
    called
}

/// Functions without a result neither fail nor report anything.
fn assert_nothing_comes_of_null() {
    // SAFETY: these functions ignore null.
    unsafe {
        rara_gaussians_destroy(null_mut());
        rara_scene_buffers_destroy(null_mut());
        rara_renderer_destroy(null_mut());
        rara_device_destroy(null_mut());
        rara_region_destroy(null_mut());
        rara_frame_destroy(null_mut());
        rara_picker_destroy(null_mut());
        assert_eq!(
            rara_device_bytes(null())
                + rara_scene_buffers_bytes(null())
                + rara_renderer_bytes(null()),
            0
        );
        assert_eq!(rara_scene_buffers_layer_count(null()), 0);
    }
}

#[test]
fn null_is_named() {
    for (result, function, says) in calls() {
        let expected = [RARA_ERROR_INVALID, RARA_OK][usize::from(says.is_empty())];
        assert_eq!(result, expected, "{function}");
    }
    assert_nothing_comes_of_null();
}

#[test]
fn no_panic_crosses() {
    PANIC.set(true);
    for (result, function, _) in calls() {
        assert_eq!(result, RARA_ERROR_PANIC, "{function}");
        assert_eq!(message(), "injected");
    }
    assert_nothing_comes_of_null();
    PANIC.set(false);
    let odd = guard(|| std::panic::panic_any(7));
    assert_fails(odd, RARA_ERROR_PANIC, "without a message");
}

#[test]
fn every_function_is_called_here() {
    let header = include_str!("rara.h");
    let called: Vec<_> = calls().into_iter().map(|(_, name, _)| name).collect();
    for line in header
        .lines()
        .filter(|line| line.starts_with("RaraResult rara_"))
    {
        let name = line["RaraResult ".len()..].split('(').next();
        let name = name.expect("a function");
        assert!(called.contains(&name), "{name} is not in calls()");
    }
}
