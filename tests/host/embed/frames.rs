//! Frames in flight show the headless pictures, also when one takes over from another and when settings change between a
//! frame's preparation and its draw.

use super::*;
use rara::Counts;

#[test]
fn frames_in_flight_show_the_headless_pictures_over_what_the_host_has_painted() {
    let scene = scene();
    let frames = frames(&scene);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let truth: Vec<(Picture, Counts)> = frames
        .iter()
        .map(|(camera, clip, settings)| {
            let stats = headless.render(camera, clip, settings).expect("renders");
            (headless.picture().expect("reads back"), stats.counts)
        })
        .collect();

    for (format, bindings) in [
        (FLOATS, Bindings::Mixed),
        (FLOATS, Bindings::Address),
        (HALVES, Bindings::Mixed),
        (BYTES, Bindings::Mixed),
    ] {
        let desc = in_flight(format, bindings);
        let host = open_host(format, VIEW, true);
        let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
        let check = |host: &Host, pixels: &[[f32; 4]], frame: usize| {
            let expected = expected(host, &truth[frame].0, 0);
            let what = format!("{format:?}, {bindings:?}, frame {frame}");
            assert_shows(&what, format, pixels, &expected);
        };
        for (index, frame) in frames.iter().enumerate() {
            if let Some(pixels) = engine.wait() {
                check(&engine.host, &pixels, index - FRAMES);
                assert_eq!(engine.renderer.counts(), truth[index - FRAMES].1);
                let times = engine.renderer.pass_times();
                let named = |name| times.iter().any(|time| time.name == name);
                assert!(times.is_empty() || named("classify") && named("splat"));
            } else {
                assert_eq!(engine.renderer.counts(), Counts::default());
            }
            engine.configure(frame);
            engine.record(vk::Offset2D::default());
        }
        let pixels = engine.wait().expect("a frame so long ago");
        check(&engine.host, &pixels, frames.len() - FRAMES);
        let pixels = engine.wait_for_all();
        check(&engine.host, &pixels, frames.len() - 1);
        engine.close();
    }
}

/// A clip that moves, stands still and moves back before a camera that stands still, then another camera.
pub(super) fn sweep(scene: &Gaussians) -> Vec<Frame> {
    let cameras = common::views(scene, 3, (VIEW.width, VIEW.height));
    let (low, high) = rara::scene::extent_along(scene, glam::DVec3::X);
    let steps = [
        (0, 0.2),
        (0, 0.4),
        (0, 0.6),
        (0, 0.6),
        (0, 0.3),
        (0, 0.7),
        (1, 0.7),
        (1, 0.5),
    ];
    let frame = |(camera, share): (usize, f64)| {
        let plane = rara::Plane::new(glam::DVec3::X, -(low + share * (high - low)));
        let clip = Clip::of([plane.expect("a finite normal")], ClipOp::And);
        (cameras[camera], clip, Settings::default())
    };
    steps.map(frame).to_vec()
}

#[test]
fn a_host_whose_frames_take_over_from_each_other_gets_the_same_pictures() {
    let scene = scene();
    let frames = sweep(&scene);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let truth: Vec<Picture> = frames
        .iter()
        .map(|(camera, clip, settings)| {
            headless.forget();
            headless.render(camera, clip, settings).expect("renders");
            headless.picture().expect("reads back")
        })
        .collect();
    let rasters = common::rasters(headless.device());
    if !rasters.contains(&Raster::Mesh) {
        eprintln!("SKIPPED: this device has no mesh shaders");
    }
    let bindings = common::bindings(headless.device());
    let ways = rasters
        .iter()
        .flat_map(|raster| bindings.iter().map(|bindings| (*raster, *bindings)));
    for (raster, bindings) in ways {
        let desc = in_flight(FLOATS, bindings).reuse(true);
        let host = open_host(FLOATS, VIEW, true);
        let mut engine = Engine::new(host, &scene, ShFormat::Float, desc);
        let check = |host: &Host, pixels: &[[f32; 4]], frame: usize| {
            let what = format!("{raster:?}, {bindings:?}, frame {frame}");
            assert_shows(&what, FLOATS, pixels, &expected(host, &truth[frame], 0));
        };
        let mut reused = 0;
        for (index, (camera, clip, settings)) in frames.iter().enumerate() {
            if let Some(pixels) = engine.wait() {
                check(&engine.host, &pixels, index - FRAMES);
            }
            engine.configure(&(*camera, clip.clone(), settings.raster(raster)));
            let configured = engine.configured.as_ref().expect("it was configured");
            reused += usize::from(configured.skipped().contains(&"project"));
            engine.record(vk::Offset2D::default());
        }
        let pixels = engine.wait().expect("a frame so long ago");
        check(&engine.host, &pixels, frames.len() - FRAMES);
        let pixels = engine.wait_for_all();
        check(&engine.host, &pixels, frames.len() - 1);
        assert_eq!(reused, 4, "the third frame to the sixth");
        engine.close();
    }
}

/// A setting that changes between a frame's preparation and its draw takes effect in the next frame.
#[test]
fn settings_of_the_next_frame_leave_the_prepared_one_alone() {
    let scene = scene();
    let shown = frames(&scene).swap_remove(1);
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let moved = rara::Placement::new(glam::DVec3::X, glam::DQuat::IDENTITY, 2.0).expect("finite");
    let mut pictures = Vec::new();
    for frame in 0..2 {
        engine.wait();
        engine.configure(&shown);
        let cmd = engine.prepare();
        if frame == 1 {
            engine.renderer.set_placement(moved);
            engine.renderer.set_color_format(BYTES);
        }
        engine.host.begin_rendering(VIEW.into());
        // There are more draws than the timer has room for; the picture of the last is blended over the others.
        for _ in 0..20 {
            engine.draw(cmd, [0.0; 2]);
        }
        engine.host.submit().expect("submits");
        pictures.push(engine.wait_for_all());
        let times = engine.renderer.pass_times();
        assert!(times.is_empty() || times.iter().any(|time| time.name == "splat"));
    }
    assert!(pictures[0] == pictures[1]);
    engine.close();
}

#[test]
fn an_empty_scene_records_nothing() {
    let scene = Gaussians::default();
    let frame = frames(&super::scene()).swap_remove(1);
    let desc = in_flight(BYTES, Bindings::Address);
    let host = open_host(BYTES, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    for _ in 0..3 {
        engine.wait();
        engine.configure(&frame);
        engine.record(vk::Offset2D::default());
    }
    let pixels = engine.wait_for_all();
    let nothing = Picture::filled(VIEW.width, VIEW.height, [0.0; 4]);
    assert_eq!(pixels, expected(&engine.host, &nothing, 0));
    assert_eq!(engine.renderer.counts(), Counts::default());
    assert!(engine.renderer.pass_times().is_empty());
    engine.close();
}
