//! Scenes of several layers: they are sorted and blended as one scene, each in its place, with its opacity, or hidden.

use glam::{DQuat, DVec3, Quat};
use rara::reference;
use rara::{
    Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Picture, Placement, Raster, Scene,
    Settings,
};

use crate::common;

const SIZE: (u32, u32) = (253, 190);

/// A generated scene, and the same one as layers of uneven sizes, some of them smaller than a block and one empty.
fn in_parts(count: usize) -> (Gaussians, Vec<Gaussians>) {
    let (_, scene) = common::generated_scenes(count).remove(0);
    let ends = [0, 1, 1, 200, 457, scene.len() / 3, scene.len()];
    let parts = ends.windows(2).map(|ends| {
        let mut part = Gaussians::default();
        part.set_sh_degree(scene.sh_degree());
        for index in ends[0]..ends[1] {
            part.push(
                scene.positions()[index],
                scene.scales()[index],
                scene.rotations()[index],
                scene.opacities()[index],
                scene.sh_of(index),
            );
        }
        part
    });
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

fn rasters(headless: &Headless) -> Vec<Raster> {
    let mut rasters = vec![Raster::Tiles, Raster::Quad];
    rasters.extend(
        headless
            .device()
            .support()
            .mesh_shader
            .then_some(Raster::Mesh),
    );
    rasters
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
        for raster in rasters(&whole) {
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
            for raster in rasters(&headless) {
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
    headless.layers_mut()[0].state.placement = placement;
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
    headless.layers_mut()[0].state.placement = Placement::IDENTITY;
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
    headless.layers_mut()[5].state = hidden;
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
    let mut state = 5_u64;
    let mut pick = |count: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % count
    };
    let cameras = common::views(&scene, 2, common::scaled((125, 95)));
    let (mut camera, mut shift, mut settings) = (0, 0.0, Settings::default());
    let (mut seen, mut changes) = (None, 0);
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
                    let layer = &mut headless.layers_mut()[layer];
                    let state = &mut layer.state;
                    match kind {
                        8 => layer.clip = (value > 0).then(|| own.clone()),
                        3 => state.opacity = [1.0, 0.5, 0.0][value],
                        4 | 5 => state.visible = value > 0,
                        _ => {
                            state.placement =
                                [Placement::IDENTITY, elsewhere(1.0), elsewhere(0.5)][value];
                        }
                    }
                }
            }
        }
        let clip = common::moved(common::clip(&scene, 2, ClipOp::And), shift);
        forgets.forget();
        let [ours, theirs] = [&mut keeps, &mut forgets].map(|headless| {
            headless
                .render(&cameras[camera], &clip, &settings)
                .expect("renders");
            picture(headless)
        });
        assert!(ours == theirs, "{settings:?}");
        changes += usize::from(seen.as_ref() != Some(&ours));
        seen = Some(ours);
    }
    assert!(
        changes > 25,
        "only {changes} of 90 frames were another picture"
    );
    keeps.close().expect("nothing to say");
    forgets.close().expect("nothing to say");
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
    headless.layers_mut()[0].state.opacity = 2.0;
    let camera = common::views(&common::generated_scenes(10)[0].1, 1, (8, 8))[0];
    let error = headless.render(&camera, &Clip::default(), &Settings::default());
    let text = error.expect_err("no opacity").to_string();
    assert!(text.contains("'layer 0'"), "{text}");
    headless.close().expect("nothing to say");
}

/// Unions and intersections of so many surfaces, and none at all, in one frame that has no clip itself.
#[test]
fn each_layer_may_have_a_clip_of_its_own() {
    let (scene, parts) = in_parts(6_000);
    let mut headless = common::headless();
    let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
    let clips = [
        common::clip(&scene, 2, ClipOp::Or),
        common::clip(&scene, 1, ClipOp::And),
        common::clip(&scene, 0, ClipOp::Or), // keeps everything
        common::clip(&scene, 3, ClipOp::And),
    ];
    let layer =
        |(index, part): (usize, _)| Layer::new("own", part).clipped(clips[index % 4].clone());
    let layers: Scene<'_> = parts.iter().enumerate().map(layer).collect();
    headless.load(layers.clone()).expect("uploads");
    for mode in [Mode::Exact, Mode::Rara] {
        let settings = Settings::default().mode(mode);
        headless
            .render(&camera, &Clip::default(), &settings)
            .expect("renders");
        let truth = reference::render::<f64>(layers.clone(), &camera, &Clip::default(), &settings);
        common::assert_agrees("own clips", &picture(&mut headless), &truth.picture);
    }
    headless.close().expect("nothing to say");
}
