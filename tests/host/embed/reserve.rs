//! Room that is made before the first frame: frames within what was reserved compile and allocate nothing, a budget is kept,
//! and what no frame needs is given back.

use super::*;
use rara::glam::DVec3;
use rara::{DepthMap, Error, FrameLimits, Layer, Mode, Placement, Scene, Shape, Show};

/// Clips of every kind that the limits below have room for.
fn clips(scene: &Gaussians) -> Vec<Clip> {
    let bounds = rara::Bounds::of(scene);
    let (centre, radius) = (bounds.centre(), 0.5 * bounds.radius());
    let ball = Shape::sphere(centre, radius).expect("a ball");
    let half = Shape::cuboid(centre, DVec3::splat(radius), rara::glam::DQuat::IDENTITY);
    let bite = ball.complement();
    vec![
        Clip::default(),
        common::clip(scene, 1, ClipOp::And),
        common::clip(scene, 6, ClipOp::Or),
        ball.clip(),
        Clip::of_shapes(&[half.expect("a box"), bite], ClipOp::And),
        common::clip(scene, 3, ClipOp::And),
    ]
}

/// Frames whose modes, clips, sizes and cameras change, over and over.
fn changing(scene: &Gaussians, settings: &[Settings]) -> Vec<Frame> {
    let sizes = [(VIEW.width, VIEW.height), (40, 131), (189, 9), (64, 64)];
    let clips = clips(scene);
    let mut frames = Vec::new();
    for (index, settings) in settings.iter().enumerate() {
        for (at, clip) in clips.iter().enumerate() {
            let size = sizes[(index + at) % sizes.len()];
            let camera = common::views(scene, 5, size).swap_remove((index + 2 * at) % 5);
            frames.push((camera, clip.clone(), *settings));
            // The clip moves before a camera that stands still, which takes over what it can.
            if at % 3 == index % 3 {
                frames.push((camera, clips[(at + 1) % clips.len()].clone(), *settings));
            }
        }
    }
    frames
}

/// All modes, what can be shown, and ways to draw it; the usual ones first.
fn all_settings(device: &Device) -> Vec<Settings> {
    let usual = Settings::default();
    let modes = [Mode::None, Mode::Hard, Mode::Rara];
    let rasters = common::rasters(device).into_iter().skip(1); // tiles, which all others have
    [usual]
        .into_iter()
        .chain(modes.map(|mode| usual.mode(mode)))
        .chain(rasters.map(|raster| usual.raster(raster)))
        .chain([usual.show(Show::Count)])
        .collect()
}

/// The limits of all of these frames.
fn limits(scene: &Gaussians, settings: &[Settings]) -> FrameLimits {
    FrameLimits::new((VIEW.width, VIEW.height), scene.len() as u32)
        .layers(2)
        .planes(6)
        .surfaces(8)
        .settings(settings.to_vec())
        .pairs(Some(400_000))
}

/// What has been compiled and allocated on a device.
fn made(device: &Device) -> (u64, u64) {
    (device.pipeline_count(), device.allocation_count())
}

/// The pictures of frames, alternately of a scene and of its halves as layers, and what configuring and recording them has
/// compiled and allocated. Those of the first settings are drawn, and the others only configured: all that they need is there
/// then, while a CPU driver compiles for the first draw of each.
fn drawn(
    desc: RendererDesc,
    scene: &Gaussians,
    reserve: bool,
    settings: impl Fn(&Device) -> Vec<Settings>,
) -> (Vec<Vec<[f32; 4]>>, (u64, u64)) {
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, scene, ShFormat::default(), desc);
    let half = common::picked(scene, 0..scene.len() / 2);
    let layers = [Layer::new("a", &half), Layer::new("b", &half)];
    let layered = Scene::from_iter(layers);
    let halves = SceneBuffers::upload(&engine.device, layered, ShFormat::default());
    let mut other = halves.expect("uploads");
    let settings = settings(&engine.device);
    if reserve {
        let limits = limits(scene, &settings);
        engine.renderer.reserve(&limits).expect("reserves");
    }
    let before = made(&engine.device);
    let mut pictures = Vec::new();
    for (index, frame) in changing(scene, &settings).iter().enumerate() {
        if index % 4 == 2 {
            std::mem::swap(&mut engine.scene, &mut other);
        }
        engine.wait();
        engine.configure(frame);
        if frame.2 == settings[0] {
            engine.record(vk::Offset2D::default());
            pictures.push(engine.wait_for_all());
            assert!(!engine.renderer.fell_back(), "frame {index}");
        }
    }
    let after = made(&engine.device);
    drop(other);
    engine.close();
    (pictures, (after.0 - before.0, after.1 - before.1))
}

#[test]
fn frames_within_what_was_reserved_compile_and_allocate_nothing() {
    let scene = generate(Kind::General, 1_500, 5);
    let usual = in_flight(FLOATS, Bindings::Mixed);
    let ours = |reserve| drawn(usual.reuse(true), &scene, reserve, all_settings);
    let (pictures, made) = ours(true);
    assert_eq!(made, (0, 0), "pipelines and allocations");
    let (expected, made) = ours(false);
    assert!(made.0 > 10 && made.1 > 10, "what is not reserved: {made:?}");
    for (index, (own, expected)) in pictures.iter().zip(&expected).enumerate() {
        assert!(own == expected, "frame {index}");
    }
    // Each computes everything, from buffers that are reached by address.
    let exact = |_: &Device| vec![Settings::default()];
    let (_, made) = drawn(usual.bindings(Bindings::Address), &scene, true, exact);
    assert_eq!(made, (0, 0), "pipelines and allocations");
}

/// Frames beyond the limits are drawn as without them, and what was reserved stays.
#[test]
fn what_was_reserved_outlives_a_frame_beyond_it() {
    let scene = generate(Kind::General, 1_500, 5);
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let limits = FrameLimits::new((64, 64), 1_500)
        .planes(1)
        .pairs(Some(100_000));
    engine.renderer.reserve(&limits).expect("reserves");
    let within = |index: usize| {
        let camera = common::views(&scene, 4, (64, 64)).swap_remove(index);
        (
            camera,
            common::clip(&scene, 1, ClipOp::And),
            Settings::default(),
        )
    };
    let beyond = frames(&scene).swap_remove(2);
    for (frame, is_within) in [
        (within(0), true),
        (beyond, false),
        (within(1), true),
        (within(2), true),
    ] {
        engine.wait();
        let before = made(&engine.device);
        engine.configure(&frame);
        assert_eq!(made(&engine.device) == before, is_within);
        engine.record(vk::Offset2D::default());
    }
    engine.wait_for_all();
    engine.close();
}

/// A renderer that shares the pipelines compiles them on a thread of the host's.
#[test]
fn another_thread_can_compile_what_frames_will_need() {
    let scene = scene();
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let mut other = engine.renderer.sharing(desc).expect("a renderer");
    let limits = FrameLimits::new((VIEW.width, VIEW.height), scene.len() as u32);
    std::thread::scope(|scope| {
        let reserved = scope.spawn(|| other.reserve(&limits));
        reserved.join().expect("no panic").expect("reserves");
    });
    drop(other);
    let (compiled, _) = made(&engine.device);
    for frame in &frames(&scene) {
        engine.wait();
        engine.configure(frame);
        engine.record(vk::Offset2D::default());
    }
    engine.wait_for_all();
    assert_eq!(engine.device.pipeline_count(), compiled);
    engine.close();
}

#[test]
fn a_budget_is_kept_and_says_what_to_do() {
    let scene = scene();
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let device = engine.device.clone();
    let shown = frames(&scene).swap_remove(1);
    let (camera, clip, settings) = &shown;
    assert_eq!(device.memory_budget(), None);
    let budget = device.device_bytes() + (64 << 10);
    device.set_memory_budget(Some(budget));
    assert_eq!(device.memory_budget(), Some(budget));
    let before = made(&device);
    let refused = |result: rara::Result<()>, what: &str| {
        let error = result.expect_err("there is no room");
        assert!(matches!(error, Error::Budget(_)), "{error}");
        let text = error.to_string();
        for part in [
            what,
            "Device::set_memory_budget",
            "Renderer::trim",
            "budget of",
        ] {
            assert!(text.contains(part), "{text}");
        }
        assert_eq!(made(&device), before, "nothing is allocated before: {text}");
    };
    let limits = FrameLimits::new((VIEW.width, VIEW.height), 100_000);
    refused(engine.renderer.reserve(&limits), "a frame's working memory");
    let configured = engine
        .renderer
        .configure(&engine.scene, camera, clip, settings);
    refused(configured.map(drop), "a frame's working memory");
    let uploaded = SceneBuffers::upload(&device, &scene, ShFormat::Float).map(drop);
    refused(uploaded, "a scene of 3000 Gaussians");

    // With room for the frame it is drawn, and the budget is never exceeded.
    let budget = device.device_bytes() + (8 << 20);
    device.set_memory_budget(Some(budget));
    for frame in &frames(&scene) {
        engine.wait();
        engine.configure(frame);
        engine.record(vk::Offset2D::default());
        assert!(device.device_bytes() <= budget);
    }
    engine.wait_for_all();
    assert!(device.peak_device_bytes() <= budget);
    drop(device);
    engine.close();
}

/// Pairs of tile and splat that a budget has no room for are no reason to draw nothing: the frame has coarse lists.
#[test]
fn a_budget_without_room_for_all_pairs_has_coarse_lists() {
    let mut scene = generate(Kind::General, 1_000, 5);
    scene.scales_mut().fill(rara::glam::Vec3::splat(2.0));
    scene.opacities_mut().fill(0.02);
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &settings).picture;
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let expected = expected(&engine.host, &truth, 0);
    let device = engine.device.clone();
    // Enough for all but the growth.
    let shown = (camera, clip, settings.raster(Raster::Tiles));
    device.set_memory_budget(Some(device.device_bytes() + (3 << 20)));
    for _ in 0..3 {
        engine.wait();
        engine.configure(&shown);
        engine.record(vk::Offset2D::default());
        let pixels = engine.wait_for_all();
        assert_shows("with coarse lists", FLOATS, &pixels, &expected);
    }
    assert!(engine.renderer.fell_back());
    // With another budget it grows.
    device.set_memory_budget(None);
    for _ in 0..3 {
        engine.wait();
        engine.configure(&shown);
        engine.record(vk::Offset2D::default());
        let pixels = engine.wait_for_all();
        assert_shows("with room", FLOATS, &pixels, &expected);
    }
    assert!(!engine.renderer.fell_back());
    drop(device);
    engine.close();
}

#[test]
fn what_the_frame_does_not_need_is_given_back() {
    let scene = scene();
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let shown = frames(&scene).swap_remove(1);
    let needed = {
        let host = open_host(FLOATS, VIEW, true);
        let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
        engine.configure(&shown);
        let bytes = engine.renderer.bytes();
        engine.close();
        bytes
    };
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let limits = FrameLimits::new((2048, 2048), 50_000).surfaces(8);
    engine.renderer.reserve(&limits).expect("reserves");
    assert!(engine.renderer.bytes() > 10 * needed);
    engine.configure(&shown);
    engine.record(vk::Offset2D::default());
    let picture = engine.wait_for_all();
    let trimmed = engine.renderer.trim(engine.prepared.as_ref());
    trimmed.expect("trims");
    engine.prepared = None;
    assert_eq!(engine.renderer.bytes(), needed);
    let scene_bytes = engine.scene.bytes();
    let beside = engine.device.device_bytes() - scene_bytes - needed;
    assert!(beside < 1 << 16, "alignment: {beside} bytes");
    let before = made(&engine.device);
    engine.wait();
    engine.configure(&shown);
    assert_eq!(made(&engine.device), before, "the same frame");
    engine.record(vk::Offset2D::default());
    assert!(engine.wait_for_all() == picture);
    engine.prepared = None;
    engine.renderer.trim(None).expect("trims");
    assert!(engine.renderer.bytes() < 4096, "the counts of frames");
    engine.close();
}

/// The depth of the host and expected depths are reserved for too, wherever the scene is placed.
#[test]
fn depths_are_reserved_for() {
    let scene = scene();
    let map = DepthMap::reversed(0.1, f64::INFINITY).expect("a map");
    let depth = rara::DepthDesc::new(vk::Format::D32_SFLOAT, map).readable(true);
    let expected = rara::ExpectedDepthDesc::new(vk::Format::R32G32_SFLOAT);
    let desc = in_flight(FLOATS, Bindings::Mixed)
        .depth(Some(depth))
        .expected_depth(Some(expected));
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let limits = FrameLimits::new((VIEW.width, VIEW.height), scene.len() as u32);
    engine
        .renderer
        .reserve(&limits.pairs(Some(400_000)))
        .expect("reserves");
    let before = made(&engine.device);
    let moved = Placement::new(DVec3::X, rara::glam::DQuat::IDENTITY, 2.0).expect("finite");
    engine.renderer.set_placement(moved);
    for frame in &frames(&scene) {
        engine.configure(frame);
    }
    assert_eq!(made(&engine.device), before);
    engine.close();
}
