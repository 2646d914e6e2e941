//! What the log tells a host that embeds rara, of its device, its scene and its frames; a frame like the one before it tells
//! of no pipeline and no buffer. A frame without timing has no GPU time.

use std::ffi::c_void;
use std::fmt::Write;
use std::ptr::{null, null_mut};

use crate::canvas::host::Host;
use crate::canvas::open_host;
use crate::folder::has_run_alone;
use crate::layer::one_layer;
use crate::logging::{Lines, keep};
use crate::results::assert_ok;
use rara::ash::{Entry, vk};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::device::*;
use rara_c::frame::*;
use rara_c::gaussians::*;
use rara_c::load::*;
use rara_c::logging::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;
use rara_c::scene::*;
use rara_c::stats::*;
use rara_c::upload::*;

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const VIEW: vk::Extent2D = vk::Extent2D {
    width: 90,
    height: 60,
};

/// A file of a hundred Gaussians on a grid.
fn file() -> String {
    let mut text = String::from("ply\nformat ascii 1.0\nelement vertex 100\n");
    for property in [
        "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
        "rot_0", "rot_1", "rot_2", "rot_3",
    ] {
        writeln!(text, "property float {property}").expect("memory");
    }
    text += "end_header\n";
    for i in 0..100 {
        let (x, y) = (i % 10, i / 10);
        writeln!(text, "{x} {y} 0 1 0 1 2 -1 -1 -1 1 0 0 0").expect("memory");
    }
    text
}

/// Draws a frame in C, and waits for it.
///
/// # Safety
/// The handles are alive.
unsafe fn draw(
    host: &mut Host,
    renderer: *mut RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: &RaraCamera,
) {
    // SAFETY: the caller's promise; the command buffer is where each call needs it, and the frame is waited for.
    unsafe {
        let mut frame = null_mut();
        assert_ok(rara_renderer_configure(
            renderer,
            scene,
            camera,
            null(),
            null(),
            &mut frame,
        ));
        let cmd = host.begin().expect("begins");
        assert_ok(rara_renderer_prepare(renderer, cmd, scene, null(), frame));
        host.begin_rendering(VIEW.into());
        assert_ok(rara_renderer_draw(renderer, cmd, 0.0, 0.0, frame));
        host.submit().expect("submits");
        host.wait_for_all().expect("waits");
        rara_frame_destroy(frame);
    }
}

#[test]
fn a_frame_has_lines_for_those_who_embed() {
    if has_run_alone(a_frame_has_lines_for_those_who_embed) {
        return;
    }
    let mut host = open_host(FORMAT, VIEW, true);
    let lent = host.lend();
    let mut lines = Lines::default();
    let user: *mut c_void = (&raw mut lines).cast();
    let taken = || -> Vec<(RaraLogLevel, String)> {
        // SAFETY: the lines outlive the log's function, which only locks them.
        let lines = unsafe { &*user.cast::<Lines>() };
        std::mem::take(&mut *lines.lock().expect("no panic"))
    };
    let has = |lines: &[(RaraLogLevel, String)], level, part: &str| {
        let found = lines
            .iter()
            .any(|(at, text)| *at == level && text.contains(part));
        assert!(
            found,
            "no line with {part:?} at level {level} among {lines:#?}"
        );
    };
    // SAFETY: the system's loader; every handle and pointer below is alive, or to be overwritten.
    unsafe {
        assert_eq!(rara_set_log(Some(keep), user), RARA_OK);
        let entry = Entry::load().expect("a Vulkan loader");
        let mut desc: RaraAdoptDesc = std::mem::zeroed();
        assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
        desc.get_instance_proc_addr = Some(entry.static_fn().get_instance_proc_addr);
        (desc.instance, desc.physical_device) = (lent.instance.handle(), lent.physical_device);
        (desc.device, desc.queue) = (lent.device.handle(), lent.queue);
        desc.queue_family = lent.queue_family;
        let mut device = null_mut();
        assert_ok(rara_device_adopt(&desc, &mut device));
        has(
            &taken(),
            RARA_LOG_LEVEL_INFO,
            "was adopted for Vulkan 1.3: pipelines for",
        );

        let (text, mut gaussians, mut scene) = (file(), null_mut(), null_mut());
        let (data, size) = (text.as_ptr(), text.len());
        let loaded =
            rara_gaussians_load_from(data, size, c"grid".as_ptr(), null(), 0, &mut gaussians);
        assert_ok(loaded);
        let format = RARA_SH_FORMAT_PACKED;
        assert_ok(rara_scene_buffers_upload(
            device,
            &one_layer(gaussians),
            1,
            format,
            &mut scene,
        ));
        has(
            &taken(),
            RARA_LOG_LEVEL_INFO,
            "a scene of 100 Gaussians in 1 layer takes",
        );

        let mut camera: RaraCamera = std::mem::zeroed();
        let up = [0.0, -1.0, 0.0];
        let (width, height) = (VIEW.width, VIEW.height);
        let framed = rara_camera_frame(
            gaussians,
            up.as_ptr(),
            50.0,
            width,
            height,
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
        let mut renderer = null_mut();
        assert_ok(rara_renderer_create(device, &desc, &mut renderer));
        desc.color_format = vk::Format::R8G8B8A8_SRGB;
        let mut other = null_mut();
        assert_ok(rara_renderer_create(device, &desc, &mut other));
        rara_renderer_destroy(other);
        has(
            &taken(),
            RARA_LOG_LEVEL_WARN,
            "RaraRendererDesc.color_format is R8G8B8A8_SRGB",
        );
        draw(&mut host, renderer, scene, &camera);
        let first = taken();
        has(&first, RARA_LOG_LEVEL_INFO, "splats become pixels by ");
        has(
            &first,
            RARA_LOG_LEVEL_DEBUG,
            "pipeline \"classify\" was made in ",
        );
        has(&first, RARA_LOG_LEVEL_DEBUG, "buffer \"splats\" of ");
        has(
            &first,
            RARA_LOG_LEVEL_TRACE,
            "frame 0 shows 100 Gaussians in 90x60 px with 0 surfaces",
        );

        draw(&mut host, renderer, scene, &camera);
        let second = taken();
        has(&second, RARA_LOG_LEVEL_TRACE, "the oldest frame drew ");
        has(&second, RARA_LOG_LEVEL_TRACE, "untimed");
        has(&second, RARA_LOG_LEVEL_TRACE, "frame 1 shows");
        let steps = second
            .iter()
            .all(|(level, _)| *level == RARA_LOG_LEVEL_TRACE);
        assert!(steps, "nothing was compiled or allocated: {second:#?}");

        let mut stats: RaraFrameStats = std::mem::zeroed();
        let size = size_of_val(&stats);
        assert_ok(rara_renderer_stats(renderer, &mut stats, size));
        assert!(stats.drawn > 0 && stats.pass_count == 0 && stats.gpu_ms.is_nan());

        rara_renderer_destroy(renderer);
        rara_scene_buffers_destroy(scene);
        rara_gaussians_destroy(gaussians);
        rara_device_destroy(device);
        assert_eq!(rara_set_log(None, null_mut()), RARA_OK);
    }
    assert_eq!(host.close(), Vec::<String>::new());
}
