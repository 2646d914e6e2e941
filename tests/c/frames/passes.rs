//! What a host in C learns of the stages of a frame: their times, their places on the device's clock, and their work.

use super::*;
use crate::canvas::CanvasDesc;
use crate::results::assert_fails;
use std::cell::Cell;
use std::ffi::{CStr, c_char};
use std::ptr::null;

use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::frame::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;
use rara_c::stats::*;

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const VIEW: (u32, u32) = (121, 83);

type Name = [c_char; RARA_NAME_SIZE];
type List<T> = unsafe extern "C" fn(*const RaraRenderer, *mut T, *mut usize) -> RaraResult;

fn name(of: &Name) -> String {
    // SAFETY: it ends in NUL.
    let text = unsafe { CStr::from_ptr(of.as_ptr()) };
    text.to_str().expect("UTF-8").to_owned()
}

/// All that a function lists. With too little room it writes no more than fits.
///
/// # Safety
/// The renderer is alive, and all bytes of a `T` may be zero.
unsafe fn listed<T: Copy>(
    list: List<T>,
    renderer: *const RaraRenderer,
    named: impl Fn(&T) -> String,
) -> Vec<T> {
    // SAFETY: the caller's promise, and there is as much room as the count says.
    unsafe {
        let mut count = 0;
        assert_ok(list(renderer, null_mut(), &mut count));
        let all = count;
        let mut found: Vec<T> = vec![std::mem::zeroed(); all];
        count = all.saturating_sub(1);
        assert_ok(list(renderer, found.as_mut_ptr(), &mut count));
        assert_eq!(count, all);
        assert!(found.last().is_none_or(|last| named(last).is_empty()));
        assert_ok(list(renderer, found.as_mut_ptr(), &mut count));
        assert!(found.iter().all(|one| !named(one).is_empty()));
        count = usize::MAX;
        let refused = list(renderer, &mut std::mem::zeroed(), &mut count);
        assert_fails(refused, RARA_ERROR_INVALID, "count: 18446744073709551615");
        let refused = list(renderer, null_mut(), null_mut());
        assert_fails(refused, RARA_ERROR_INVALID, "count is null");
        found
    }
}

/// Draws a frame in C and waits, and returns what is known of it then.
///
/// # Safety
/// The handles are alive.
unsafe fn drawn(
    ours: &Ours,
    canvas: &Canvas,
    scene: *const RaraSceneBuffers,
    asked: bool,
) -> (RaraFrameStats, Vec<RaraPassSpan>, Vec<RaraPassStatistics>) {
    // SAFETY: the caller's promise; the command buffer is where each call needs it, and the frame is waited for.
    unsafe {
        let mut desc: RaraRendererDesc = std::mem::zeroed();
        let size = size_of_val(&desc);
        assert_ok(rara_renderer_desc_default(&mut desc, size, FORMAT));
        (desc.timing, desc.statistics) = (asked.into(), asked.into());
        desc.bindings = RARA_BINDINGS_MIXED;
        let mut renderer = null_mut();
        assert_ok(rara_renderer_create(ours.device, &desc, &mut renderer));
        let mut camera: RaraCamera = std::mem::zeroed();
        let up = [0.0, -1.0, 0.0];
        assert_ok(rara_camera_frame(
            ours.gaussians,
            up.as_ptr(),
            50.0,
            VIEW.0,
            VIEW.1,
            &mut camera,
            size_of::<RaraCamera>(),
        ));
        let made = Cell::new(null_mut());
        let before = |cmd| {
            let mut frame = null_mut();
            let configured =
                rara_renderer_configure(renderer, scene, &camera, null(), null(), &mut frame);
            assert_ok(configured);
            assert_ok(rara_renderer_prepare(renderer, cmd, scene, null(), frame));
            made.set(frame);
        };
        let inside = |cmd| {
            canvas.viewport(cmd, 0, 0, VIEW);
            assert_ok(rara_renderer_draw(renderer, cmd, 0.0, 0.0, made.get()));
        };
        canvas.draw(before, inside);
        let mut stats: RaraFrameStats = std::mem::zeroed();
        let size = size_of_val(&stats);
        assert_ok(rara_renderer_stats(renderer, &mut stats, size));
        let spans = listed(rara_renderer_pass_spans, renderer, |span| name(&span.name));
        let counted = listed(rara_renderer_pass_statistics, renderer, |pass| {
            name(&pass.name)
        });
        rara_frame_destroy(made.get());
        rara_renderer_destroy(renderer);
        (stats, spans, counted)
    }
}

#[test]
fn passes_have_a_place_on_the_devices_clock_and_work() {
    with_both(3_000, |_, lent, device, ours| {
        let canvas = Canvas::new(lent, device, CanvasDesc::new(VIEW, FORMAT));
        let scene = ours.uploaded();
        // SAFETY: the handles are alive.
        let (stats, spans, counted) = unsafe { drawn(ours, &canvas, scene, true) };
        let support = device.support();
        let passes = &stats.passes[..stats.pass_count as usize];
        assert_eq!(spans.is_empty(), support.timestamp_period == 0.0);
        for pass in passes {
            let own = spans
                .iter()
                .filter(|span| name(&span.name) == name(&pass.name));
            let ticks: u64 = own.map(|span| span.end - span.begin).sum();
            let ms = ticks as f64 * f64::from(support.timestamp_period) * 1e-6;
            assert!((ms - pass.ms).abs() < 1e-9, "{ms} of {}", pass.ms);
        }
        assert!(spans.windows(2).all(|pair| pair[0].begin <= pair[1].begin));
        assert!(spans.is_empty() || spans.iter().any(|span| name(&span.name) == "project"));

        assert_eq!(counted.is_empty(), !support.pipeline_statistics);
        let is_timed = |pass: &RaraPassStatistics| {
            let named = |timed: &RaraPassTime| name(&timed.name) == name(&pass.name);
            passes.iter().any(named)
        };
        assert!(passes.is_empty() || counted.iter().all(is_timed));
        for (stage, count) in counted.iter().map(|pass| (name(&pass.name), pass)) {
            match stage.as_str() {
                "project" => assert!(count.compute_invocations > 0, "{count:?}"),
                "splat" => assert!(count.fragment_invocations > 1_000, "{count:?}"),
                _ => {}
            }
        }

        // SAFETY: as above.
        let (stats, spans, counted) = unsafe { drawn(ours, &canvas, scene, false) };
        assert!(stats.drawn > 0 && spans.is_empty() && counted.is_empty());
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(scene) };
    });
}
