//! Scenes of several layers: they are sorted and blended as one scene, each in its place, with its opacity, or hidden.

use glam::{DQuat, DVec3, Quat};
use rara::reference;
use rara::{
    Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Picture, Placement, Scene, Settings,
};

use crate::common;

const SIZE: (u32, u32) = (253, 190);

/// A generated scene, and the same one as layers of uneven sizes, some of them smaller than a block and one empty.
fn in_parts(count: usize) -> (Gaussians, Vec<Gaussians>) {
    let (_, scene) = common::generated_scenes(count).remove(0);
    let ends = [0, 1, 1, 200, 457, scene.len() / 3, scene.len()];
    let parts = ends
        .windows(2)
        .map(|ends| common::picked(&scene, ends[0]..ends[1]));
    let parts = parts.collect();
    (scene, parts)
}

fn named<'a>(parts: impl IntoIterator<Item = (&'a Gaussians, LayerState)>) -> Scene<'a> {
    let layers = parts.into_iter().enumerate();
    layers
        .map(|(index, (part, state))| Layer::new(format!("layer {index}"), part).with(state))
        .collect()
}

/// A placement that turns, moves and scales.
fn elsewhere(scale: f64) -> Placement {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.9, -0.2).normalize(), 0.8);
    Placement::new(DVec3::new(0.4, -0.2, 0.3), turn, scale).expect("a placement")
}

fn picture(headless: &mut Headless) -> Picture {
    headless.picture().expect("reads back")
}

#[test]
fn layers_are_drawn_as_the_scene_that_they_are_parts_of() {
    let (scene, parts) = in_parts(6_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let (mut whole, mut layered) = (common::headless(), common::headless());
    whole.load(&scene).expect("uploads");
    layered.load(layers.clone()).expect("uploads");
    let names: Vec<_> = layered
        .layers()
        .iter()
        .map(|l| l.name().to_owned())
        .collect();
    assert_eq!(names[1], "layer 1");
    for camera in common::views(&scene, 2, common::scaled(SIZE)) {
        for raster in common::rasters(whole.device()) {
            for (mode, planes, op) in [
                (Mode::None, 0, ClipOp::And),
                (Mode::Hard, 1, ClipOp::And),
                (Mode::Rara, 2, ClipOp::Or),
                (Mode::Exact, 1, ClipOp::And),
                (Mode::Exact, 3, ClipOp::Or),
            ] {
                let clip = common::clip(&scene, planes, op);
                let settings = Settings::default().mode(mode).raster(raster);
                let counts = [&mut whole, &mut layered].map(|headless| {
                    headless
                        .render(&camera, &clip, &settings)
                        .expect("renders")
                        .counts
                });
                assert_eq!(counts[0], counts[1], "{raster:?}, {mode:?}");
                assert!(
                    picture(&mut whole) == picture(&mut layered),
                    "{raster:?}, {mode:?}"
                );
            }
        }
    }
    whole.close().expect("nothing to say");
    layered.close().expect("nothing to say");
}

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
        for (mode, planes, op) in [
            (Mode::None, 0, ClipOp::And),
            (Mode::Exact, 1, ClipOp::And),
            (Mode::Exact, 2, ClipOp::Or),
            (Mode::Rara, 1, ClipOp::And),
        ] {
            let clip = common::clip(&moved, planes, op);
            for raster in common::rasters(headless.device()) {
                let settings = Settings::default().mode(mode).raster(raster);
                common::check(&mut headless, "placed", &moved, &camera, &clip, &settings);
            }
            let settings = Settings::default().mode(mode);
            let truth = reference::render::<f64>(&moved, &camera, &clip, &settings);
            let twin = reference::render::<f64>(layers.clone(), &camera, &clip, &settings);
            common::assert_agrees("the twin", &twin.picture, &truth.picture);
        }
    }
    headless.close().expect("nothing to say");
}

fn placed(part: &Gaussians, state: &LayerState) -> Gaussians {
    let mut moved = part.clone();
    let (turn, scale) = (state.placement.rotation(), state.placement.scale() as f32);
    for position in moved.positions_mut() {
        *position = state.placement.to_world(position.as_dvec3()).as_vec3();
    }
    for one in moved.scales_mut() {
        *one *= scale;
    }
    for rotation in moved.rotations_mut() {
        let turned = (turn * rotation.as_dquat()).normalize();
        *rotation = Quat::from_array(turned.to_array().map(|x| x as f32));
    }
    for opacity in moved.opacities_mut() {
        *opacity *= state.opacity;
    }
    moved
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
    let apart = rara::measure::compare(&picture(&mut headless), &still).expect("the same size");
    assert!(apart.psnr < 40.0, "{apart:?}");
    headless.close().expect("nothing to say");
}

#[test]
fn a_hidden_layer_is_not_there() {
    let (scene, parts) = in_parts(6_000);
    let hidden = LayerState::default().visible(false);
    let all = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut headless = common::headless();
    headless.load(all).expect("uploads");
    headless.set_layer_state(5, hidden).expect("a layer");
    let mut rest = common::headless();
    let without = named(parts[..5].iter().map(|part| (part, LayerState::default())));
    rest.load(without).expect("uploads");
    let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
    for (mode, planes) in [(Mode::None, 0), (Mode::Exact, 1)] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let settings = Settings::default().mode(mode);
        let [ours, theirs] = [&mut headless, &mut rest].map(|headless| {
            headless
                .render(&camera, &clip, &settings)
                .expect("renders")
                .counts
        });
        assert!(picture(&mut headless) == picture(&mut rest), "{mode:?}");
        let gone = parts[5].len() as u32;
        assert_eq!(ours.culled, theirs.culled + gone);
        assert_eq!((ours.visible, ours.cutoff), (theirs.visible, theirs.cutoff));
        // Its blocks are settled as a whole: none of its Gaussians is tested.
        let sides = headless.working_buffer("block_sides").expect("a buffer");
        let sides: &[u32] = bytemuck::cast_slice(&sides);
        let blocks = |parts: &[Gaussians]| -> usize {
            parts.iter().map(|part| part.len().div_ceil(256)).sum()
        };
        let hidden = &sides[blocks(&parts[..5])..blocks(&parts)];
        assert!(hidden.iter().all(|&side| side == 0), "{mode:?}: {sides:?}");
    }
    headless.close().expect("nothing to say");
    rest.close().expect("nothing to say");
}

/// Whatever a frame takes over from the one before, its bytes are those of a whole frame.
#[test]
fn layers_that_change_leave_nothing_behind() {
    let (scene, parts) = in_parts(3_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let (mut keeps, mut forgets) = (common::headless(), common::headless());
    keeps.load(layers.clone()).expect("uploads");
    forgets.load(layers).expect("uploads");
    let mut pick = common::picker(5);
    let cameras = common::views(&scene, 2, common::scaled((125, 95)));
    let (mut camera, mut shift, mut settings) = (0, 0.0, Settings::default());
    let (mut seen, mut changes, mut reused) = (None, 0, [0; 3]);
    for _ in 0..90 {
        match pick(9) {
            0 => camera = pick(2),
            1 => settings.mode = [Mode::Exact, Mode::Hard, Mode::Rara, Mode::None][pick(4)],
            2 => shift = [0.0, 0.1, -0.1][pick(3)],
            kind => {
                let layer = pick(parts.len());
                let value = pick(3);
                let own = common::clip(&scene, 1 + value, [ClipOp::And, ClipOp::Or][layer % 2]);
                for headless in [&mut keeps, &mut forgets] {
                    let state = headless.layers()[layer].state();
                    let placements = [Placement::IDENTITY, elsewhere(1.0), elsewhere(0.5)];
                    let changed = match kind {
                        8 => headless.set_layer_clip(layer, (value > 0).then(|| own.clone())),
                        3 => headless.set_layer_state(layer, state.opacity([1.0, 0.5, 0.0][value])),
                        4 | 5 => headless.set_layer_state(layer, state.visible(value > 0)),
                        _ => headless.set_layer_state(layer, state.placement(placements[value])),
                    };
                    changed.expect("a layer");
                }
            }
        }
        let clip = common::moved(common::clip(&scene, 2, ClipOp::And), shift);
        forgets.forget();
        let [ours, theirs] = [&mut keeps, &mut forgets].map(|headless| {
            let drawn = headless.render(&cameras[camera], &clip, &settings);
            (drawn.expect("renders").skipped, picture(headless))
        });
        let ((skipped, ours), (_, theirs)) = (ours, theirs);
        assert!(ours == theirs, "{settings:?}");
        let skips = |stage| skipped.contains(&stage);
        reused[0] += usize::from(skips("project") && !skips("recut"));
        reused[1] += usize::from(!skips("project") && skips("clip"));
        reused[2] += usize::from(skips("project") && skips("tiles"));
        changes += usize::from(seen.as_ref() != Some(&ours));
        seen = Some(ours);
    }
    assert!(
        changes > 25,
        "only {changes} of 90 frames were another picture"
    );
    // Frames whose clip alone has moved, that find the view anew with the sides that there are, and that change nothing.
    assert!(reused.iter().all(|&frames| frames > 2), "{reused:?}");
    keeps.close().expect("nothing to say");
    forgets.close().expect("nothing to say");
}

/// Layers without Gaussians, wherever they stand among the others, and the last block of each no fuller than it is.
#[test]
fn layers_may_be_empty() {
    let (_, scene) = common::generated_scenes(300).remove(0);
    let none = Gaussians::default();
    let camera = common::views(&scene, 1, common::scaled((97, 61)))[0];
    let clip = common::clip(&scene, 1, ClipOp::And);
    let mut headless = common::headless();
    let mut draw = |scene: Scene<'_>, format| {
        headless.load_as(scene, format).expect("uploads");
        let stats = headless
            .render(&camera, &clip, &Settings::default())
            .expect("renders");
        (stats.counts, picture(&mut headless))
    };
    for format in [rara::ShFormat::Float, rara::ShFormat::Packed] {
        let alone = draw((&scene).into(), format);
        assert!(alone.0.drawn > 50, "{:?}", alone.0);
        for order in [
            [&scene, &none, &none],
            [&none, &scene, &none],
            [&none, &none, &scene],
        ] {
            let layers = order.map(|part| (part, LayerState::default()));
            assert!(draw(named(layers), format) == alone, "{format:?}");
        }
        let empty = draw(named([(&none, LayerState::default()); 2]), format);
        assert_eq!(empty.0, rara::Counts::default());
    }
    headless.close().expect("nothing to say");
}

#[test]
fn what_is_no_layer_is_refused() {
    let part = Gaussians::default();
    let mut headless = common::headless();
    let error = headless.load(Scene::default()).expect_err("no layer");
    assert!(error.to_string().contains("at least one layer"), "{error}");
    for opacity in [-0.1, 1.5, f32::NAN] {
        let state = LayerState::default().opacity(opacity);
        let error = headless
            .load(named([(&part, state)]))
            .expect_err("no opacity");
        let text = error.to_string();
        assert!(
            text.contains("'layer 0'") && text.contains("give 0 to 1"),
            "{text}"
        );
    }
    headless
        .load(named([(&part, LayerState::default())]))
        .expect("uploads");
    let state = LayerState::default();
    for state in [state.opacity(2.0), state.opacity(f32::NAN)] {
        let error = headless.set_layer_state(0, state).expect_err("no opacity");
        assert!(error.to_string().contains("'layer 0'"), "{error}");
    }
    let error = headless.set_layer_state(1, state).expect_err("no layer");
    assert!(error.to_string().contains("the scene has 1"), "{error}");
    let plane = rara::Plane::new(DVec3::X, 0.0).expect("a plane");
    let error = headless.set_layer_clip(0, Some(Clip::of(vec![plane; 33], ClipOp::And)));
    let error = error.expect_err("too many surfaces").to_string();
    assert!(
        error.contains("'layer 0'") && error.contains("33 surfaces"),
        "{error}"
    );
    let far = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 1e39).expect("a placement");
    let error = headless.set_layer_state(0, state.placement(far));
    assert!(error.expect_err("no scale").to_string().contains("1e39"));
    assert_eq!(
        headless.layers()[0].state(),
        state,
        "what is refused changes nothing"
    );
    // A scene that is refused leaves the one before it.
    headless.load(Scene::default()).expect_err("no layer");
    assert_eq!(headless.layers().len(), 1);
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
        let truth = reference::render::<f64>(layers(&moved), &camera, &Clip::default(), &settings);
        common::assert_agrees("own clips", &picture(&mut headless), &truth.picture);
    }
    headless.close().expect("nothing to say");
}

/// Layers store their harmonics at the highest degree of any, in every format.
#[test]
fn layers_of_different_degrees_keep_their_colours() {
    let (scene, mut parts) = in_parts(2_000);
    for (index, part) in parts.iter_mut().enumerate() {
        part.set_sh_degree([3, 0, 1, 2][index % 4]);
    }
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let camera = common::views(&scene, 1, common::scaled((125, 95)))[0];
    let (clip, settings) = (Clip::default(), Settings::default());
    let truth = reference::render::<f64>(&layers, &camera, &clip, &settings).picture;
    let mut headless = common::headless();
    for (format, least) in [
        (rara::ShFormat::Float, 60.0),
        (rara::ShFormat::Half, 50.0),
        (rara::ShFormat::Packed, 45.0),
        (rara::ShFormat::Byte, 40.0),
    ] {
        headless.load_as(&layers, format).expect("uploads");
        headless.render(&camera, &clip, &settings).expect("renders");
        let apart = rara::measure::compare(&picture(&mut headless), &truth).expect("one size");
        assert!(apart.psnr >= least, "{format:?}: {apart:?}");
    }
    headless.close().expect("nothing to say");
}

/// With all layers hidden a frame shows nothing, whatever it takes over, and then shows again what it did.
#[test]
fn all_layers_may_be_hidden() {
    let (scene, parts) = in_parts(2_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut headless = common::headless();
    headless.load(&layers).expect("uploads");
    let camera = common::views(&scene, 1, common::scaled((125, 95)))[0];
    let clips = [0.0, 0.1].map(|by| common::moved(common::clip(&scene, 1, ClipOp::And), by));
    let mut draw = |visible: Option<bool>, clip| {
        for index in 0..visible.map_or(0, |_| parts.len()) {
            let state = LayerState::default().visible(visible == Some(true));
            headless.set_layer_state(index, state).expect("a layer");
        }
        let drawn = headless.render(&camera, clip, &Settings::default());
        (drawn.expect("renders").counts, picture(&mut headless))
    };
    let shown = draw(None, &clips[0]);
    assert!(shown.0.cutoff > 10, "{:?}", shown.0);
    // A whole frame, one whose clip alone has moved, and one in which nothing has changed.
    for (visible, clip) in [(Some(false), 0), (None, 1), (None, 1)] {
        let (counts, picture) = draw(visible, &clips[clip]);
        assert_eq!((counts.drawn, counts.culled as usize), (0, scene.len()));
        assert!(picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
    }
    assert!(draw(Some(true), &clips[0]) == shown);
    headless.close().expect("nothing to say");
}
