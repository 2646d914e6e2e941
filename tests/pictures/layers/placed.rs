//! Layers in their places, with their colours, opacities and clips.

use super::*;
use rara::SortBy;

/// The truth knows nothing of layers: it draws Gaussians that were moved, turned, scaled and faded one by one.
#[test]
fn a_placed_layer_is_its_gaussians_placed() {
    let (_, mut parts) = in_parts(6_000);
    for part in &mut parts {
        part.set_sh_degree(0); // a colour that is the same from everywhere needs no turning
    }
    let states = [
        LayerState::default(),
        LayerState::default().placement(elsewhere(2.3)),
        LayerState::default(),
        LayerState::default().placement(elsewhere(0.7)).opacity(0.5),
        LayerState::default().opacity(0.25),
        LayerState::default().placement(elsewhere(0.4)),
    ];
    let mut moved = Gaussians::default();
    for (part, state) in parts.iter().zip(&states) {
        moved.append(&placed(part, state));
    }
    let layers = named(parts.iter().zip(states));
    let mut headless = common::headless();
    headless.load(layers.clone()).expect("uploads");
    let mut cameras = common::views(&moved, 2, common::scaled(SIZE));
    // Also from within, where splats are large and behind the eye.
    cameras[1].eye = 0.3 * cameras[1].eye + 0.7 * rara::Bounds::of(&moved).centre();
    for camera in cameras {
        for (mode, planes, op, by) in [
            (Mode::None, 0, ClipOp::And, SortBy::Distance),
            (Mode::Exact, 1, ClipOp::And, SortBy::Depth),
            (Mode::Exact, 2, ClipOp::Or, SortBy::Depth),
            (Mode::Rara, 1, ClipOp::And, SortBy::Distance),
        ] {
            let clip = common::clip(&moved, planes, op);
            let settings = Settings::default().mode(mode).sort_by(Some(by));
            for raster in common::rasters(headless.device()) {
                let settings = settings.raster(raster);
                common::check(&mut headless, "placed", &moved, &camera, &clip, &settings);
            }
            let truth = rara_reference::render::<f64>(&moved, &camera, &clip, &settings);
            let twin = rara_reference::render::<f64>(layers.clone(), &camera, &clip, &settings);
            common::assert_agrees("the twin", &twin.picture, &truth.picture);
        }
    }
    headless.close().expect("nothing to say");
}

/// Colours turn with their layer: a layer that is turned about the eye's target with its camera shows the same picture.
#[test]
fn colours_turn_with_their_layer() {
    let (_, scene) = common::generated_scenes(3_000).remove(0);
    assert!(scene.sh_degree() > 0);
    let mut headless = common::headless();
    let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
    let clip = common::clip(&scene, 1, ClipOp::And);
    headless.load(&scene).expect("uploads");
    headless
        .render(&camera, &clip, &Settings::default())
        .expect("renders");
    let still = picture(&mut headless);
    let placement = elsewhere(1.0);
    let moved = LayerState::default().placement(placement);
    headless.set_layer_state(0, moved).expect("a layer");
    let mut world = camera;
    world.eye = placement.to_world(camera.eye);
    world.rotation = camera.rotation * glam::DMat3::from_quat(placement.rotation().inverse());
    let planes = clip.surfaces.iter().filter_map(rara::Surface::as_plane);
    let carried = planes.map(|plane| {
        let normal = placement.rotation() * plane.normal();
        let offset = plane.offset() - normal.dot(placement.position());
        rara::Plane::new(normal, offset).expect("a plane")
    });
    let carried = Clip::of(carried, clip.op);
    headless
        .render(&world, &carried, &Settings::default())
        .expect("renders");
    common::assert_agrees("turned", &picture(&mut headless), &still);
    // Left where it was, the layer shows another picture.
    let back = headless.set_layer_state(0, LayerState::default());
    back.expect("a layer");
    headless
        .render(&world, &carried, &Settings::default())
        .expect("renders");
    let apart =
        rara_lab::measure::differences(&picture(&mut headless), &still).expect("the same size");
    assert!(apart.psnr < 40.0, "{apart:?}");
    headless.close().expect("nothing to say");
}

/// Unions and intersections of so many surfaces, and none at all, in one frame that has no clip itself. The truth draws
/// Gaussians that were placed one by one, so that it takes no clip into any layer's space.
#[test]
fn each_layer_may_have_a_clip_of_its_own() {
    let (scene, mut parts) = in_parts(6_000);
    for part in &mut parts {
        part.set_sh_degree(0);
    }
    let clips = [
        common::clip(&scene, 2, ClipOp::Or),
        common::clip(&scene, 1, ClipOp::And),
        common::clip(&scene, 0, ClipOp::Or), // keeps everything
        common::clip(&scene, 3, ClipOp::And),
    ];
    let states = [elsewhere(1.3), Placement::IDENTITY, elsewhere(0.6)];
    let states = states.map(|placement| LayerState::default().placement(placement));
    let layers = |parts| -> Scene<'_> {
        let each = <[Gaussians]>::iter(parts).enumerate();
        each.map(|(index, part)| Layer::new("own", part).clipped(clips[index % 4].clone()))
            .collect()
    };
    let each = parts.iter().enumerate();
    let moved: Vec<_> = each
        .map(|(index, part)| placed(part, &states[index % 3]))
        .collect();
    let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
    let mut headless = common::headless();
    headless.load(layers(&parts)).expect("uploads");
    for index in 0..parts.len() {
        let placed = headless.set_layer_state(index, states[index % 3]);
        placed.expect("a layer");
    }
    for mode in [Mode::Exact, Mode::Rara] {
        let settings = Settings::default().mode(mode);
        let drawn = headless.render(&camera, &Clip::default(), &settings);
        assert!(drawn.expect("renders").counts.cutoff > 50);
        let truth =
            rara_reference::render::<f64>(layers(&moved), &camera, &Clip::default(), &settings);
        common::assert_agrees("own clips", &picture(&mut headless), &truth.picture);
    }
    headless.close().expect("nothing to say");
}
