//! A scene that is placed by a similarity, and seen by a camera that is moved by it: the same picture, setting by setting,
//! whether the renderer places the scene, the scene its layer, or both.

use ash::vk;
use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use rara::gpu::Bindings;
use rara::scene::{Kind, generate};
use rara::{
    Aov, Camera, Channel, Clip, ClipOp, ExactForm, FrameStats, Gaussians, Headless, Layer,
    LayerState, Picture, Placement, Plane, Precision, Projection, Renderer, RendererDesc, Scene,
    Settings,
};
use rara_lab::measure::differences;

use super::SIZE;
use crate::common;

/// The similarities: a unit of the scene is so many of the world's.
const SCALES: [f64; 2] = [1000.0, 0.001];

fn similarity(scale: f64) -> Placement {
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9);
    let placement = Placement::new(scale * DVec3::new(4.0, -1.0, 2.5), turn, scale);
    placement.expect("finite numbers")
}

/// The camera in the world, with all its depths.
fn moved(camera: &Camera, placement: &Placement) -> Camera {
    let scale = placement.scale();
    let turn = DMat3::from_quat(placement.rotation());
    let pixels = match camera.projection {
        Projection::Orthographic => 1.0 / scale,
        _ => 1.0,
    };
    camera
        .eye(placement.to_world(camera.eye))
        .rotation(camera.rotation * turn.transpose())
        .fx(camera.fx * pixels)
        .fy(camera.fy * pixels)
        .near_cut(camera.near_cut.map(|depth| depth * scale))
        .clip_near(camera.clip_near.map(|depth| depth * scale))
        .clip_far(camera.clip_far.map(|depth| depth * scale))
}

/// The planes in the world.
fn carried(clip: &Clip, placement: &Placement) -> Clip {
    let planes = clip.surfaces.iter().map(|surface| {
        let plane = surface.as_plane().expect("a plane");
        let normal = placement.rotation() * plane.normal();
        let offset = placement.scale() * plane.offset() - normal.dot(placement.position());
        Plane::new(normal, offset).expect("a normal")
    });
    Clip::of(planes, clip.op)
}

/// The ways to place the Gaussians by a similarity: what the renderer does with the scene, and the scene with its layer.
fn ways(whole: &Placement) -> [(&'static str, Placement, Placement); 3] {
    let turn = DQuat::from_xyzw(-0.6, 0.1, 0.7, 0.3);
    let layer = Placement::new(DVec3::new(-0.5, -0.1, 2.0), turn, 3.0).expect("finite numbers");
    let rotation = whole.rotation() * layer.rotation().inverse();
    let scale = whole.scale() / layer.scale();
    let position = whole.position() - scale * (rotation * layer.position());
    let rest = Placement::new(position, rotation, scale).expect("finite numbers");
    [
        ("the renderer", *whole, Placement::IDENTITY),
        ("the layer", Placement::IDENTITY, *whole),
        ("both", rest, layer),
    ]
}

/// Runs a check with a scene that is placed in every way and by every similarity: it gets what draws the scene as it is,
/// what draws it in its place, the scene in its place, the similarity and the placement of the layer.
fn check(
    gaussians: &Gaussians,
    check: impl Fn(&str, [&mut Headless; 2], &Scene<'_>, &Placement, &Placement),
) {
    let headless = common::headless();
    let desc = RendererDesc::new(vk::Format::R32G32B32A32_SFLOAT).bindings(Bindings::Mixed);
    let mut renderer = Renderer::new(headless.device(), desc).expect("a renderer");
    // All beside one renderer, so that nothing is compiled twice.
    let mut plain = Headless::beside(&renderer).expect("beside");
    plain.load(gaussians).expect("uploads");
    for scale in SCALES {
        let whole = similarity(scale);
        for (way, world, layer) in ways(&whole) {
            renderer.set_placement(world);
            let mut placed = Headless::beside(&renderer).expect("beside");
            let state = LayerState::default().placement(layer);
            let scene = Scene::from_iter([Layer::new("placed", gaussians).with(state)]);
            placed.load(scene.clone()).expect("uploads");
            let what = format!("{way} places by {scale}");
            check(&what, [&mut plain, &mut placed], &scene, &whole, &layer);
        }
    }
    drop((plain, renderer));
    headless.close().expect("no validation messages");
}

/// Looks along the z axis. Its near cut is a length in the world, whatever is placed.
fn before_the_origin(fov_y: f64) -> Camera {
    let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, -DVec3::Y, fov_y, SIZE);
    camera.expect("a view").near_cut(Some(0.01))
}

fn drawn(
    headless: &mut Headless,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> (FrameStats, Picture) {
    let stats = headless.render(camera, clip, settings).expect("renders");
    (stats, headless.picture().expect("reads back"))
}

/// Largest difference of two pictures, of 255.
fn apart(a: &Picture, b: &Picture) -> f64 {
    differences(a, b).expect("the same size").max
}

/// Asserts that a frame in the world is the one of the scene as it is.
fn assert_same(
    what: &str,
    [plain, placed]: [&mut Headless; 2],
    [camera, there]: [&Camera; 2],
    (clip, settings, whole): (&Clip, &Settings, &Placement),
) -> Picture {
    let (stats, picture) = drawn(plain, camera, clip, settings);
    let (found, ours) = drawn(placed, there, &carried(clip, whole), settings);
    assert_eq!(found.counts, stats.counts, "{what}");
    let apart = apart(&ours, &picture);
    assert!(apart < 0.1, "{what}: {apart} of 255");
    picture
}

/// Splats one behind the other and side by side, each half as far again as the one before, from 0.05 on.
fn staggered() -> Gaussians {
    let mut scene = Gaussians::default();
    for number in 0..12 {
        let depth = 0.05 * 1.5_f32.powi(number);
        let aside = [-0.3, 0.1, 0.35, -0.1][number as usize % 4];
        let at = depth * Vec3::new(aside, 0.07 * number as f32 - 0.4, 1.0);
        let shade = 0.15 * number as f32 - 1.0;
        let scale = depth * Vec3::new(0.1, 0.05, 0.07);
        scene.push(
            at,
            scale,
            Quat::from_rotation_z(0.5),
            0.8,
            &[shade, 0.5, -shade],
        );
    }
    scene
}

/// Depths of the camera are lengths in the world. Without a near cut splats are drawn from 0.2 of the scene's units on,
/// which the renderer scales and no layer does.
#[test]
fn depths_of_the_camera_are_scaled_with_the_scene() {
    let scene = staggered();
    let camera = before_the_origin(50.0);
    let flat = camera.projection(Projection::Orthographic);
    let clip = Clip::of([Plane::new(DVec3::X, 0.02).expect("a normal")], ClipOp::And);
    let settings = Settings::default();
    check(&scene, |what, [plain, placed], _, whole, layer| {
        for camera in [camera, flat.fx(25.0).fy(25.0)] {
            let cameras = [
                ("all", camera),
                ("near cut", camera.near_cut(Some(0.7))),
                ("nearer cut", camera.near_cut(Some(0.1))),
                ("near plane", camera.clip_near(Some(0.6))),
                ("far plane", camera.clip_far(Some(0.9))),
            ];
            let mut pictures = Vec::new();
            for (name, camera) in cameras {
                let there = moved(&camera, whole);
                let what = format!("{what}: {name}, {:?}", camera.projection);
                let same = (&clip, &settings, whole);
                let picture = assert_same(&what, [plain, placed], [&camera, &there], same);
                for (other, before) in &pictures {
                    assert!(apart(&picture, before) > 10.0, "{name} is {other}");
                }
                pictures.push((name, picture));
            }
            // A unit of the scene is one of the world's where only a layer is placed.
            let usual = camera.near_cut(Some(0.2 / layer.scale()));
            let what = format!("{what}: no near cut, {:?}", camera.projection);
            let there = moved(&camera.near_cut(None), whole);
            let same = (&clip, &settings, whole);
            assert_same(&what, [plain, placed], [&usual, &there], same);
        }
    });
}

/// The plane that passes through the middles of all [`sizes`].
fn through_all() -> Plane {
    Plane::new(DVec3::new(0.6, 0.3, 0.5), -1.2).expect("a normal")
}

/// Splats whose size is 0.004 to 0.15 of their depth.
fn sizes() -> Gaussians {
    let mut scene = Gaussians::default();
    let plane = through_all();
    for number in 0..12 {
        let (column, row) = ((number % 4) as f32 - 1.5, (number / 4) as f32 - 1.0);
        let ray = Vec3::new(0.22 * column, 0.25 * row, 1.0);
        let depth = -plane.offset() / plane.normal().dot(ray.as_dvec3());
        let at = ray * depth as f32;
        let size = at.z * 0.004 * 1.39_f32.powi(number);
        let turn = Quat::from_rotation_y(0.4 * number as f32);
        let shade = 0.2 * number as f32 - 1.2;
        let scale = size * Vec3::new(1.0, 0.6, 0.8);
        scene.push(at, scale, turn, 0.95, &[0.5, shade, -shade]);
    }
    scene
}

/// From which size on a splat follows true rays is a share of its depth, which no unit changes.
#[test]
fn affine_and_beam_form_are_chosen_alike_in_every_unit() {
    let camera = before_the_origin(60.0);
    let clip = Clip::of([through_all()], ClipOp::And);
    let usual = Settings::default();
    let switch = |switch: f32| usual.precision(Precision::default().beam_switch(switch));
    let ways = [
        ("affine", usual.form(ExactForm::Affine)),
        ("a switch of 0.05", switch(0.05)),
        ("a switch of 0.005", switch(0.005)),
        ("beam", usual.form(ExactForm::Beam)),
    ];
    check(&sizes(), |what, [plain, placed], _, whole, _| {
        let there = moved(&camera, whole);
        let pictures = ways.each_ref().map(|(name, settings)| {
            let same = (&clip, settings, whole);
            let both = [&mut *plain, &mut *placed];
            assert_same(&format!("{what}: {name}"), both, [&camera, &there], same)
        });
        for (pair, names) in pictures.windows(2).zip(ways.windows(2)) {
            let apart = apart(&pair[0], &pair[1]);
            assert!(apart > 0.05, "{} is {}: {apart}", names[0].0, names[1].0);
        }
    });
}

/// A large splat that follows true rays is cut by planes farther away, also where its whole block is asked.
#[test]
fn blocks_of_large_splats_are_cut_from_as_far_in_every_unit() {
    let mut scene = Gaussians::default();
    let at = Vec3::new(0.05, 0.02, 1.0);
    scene.push(
        at,
        Vec3::splat(0.1),
        Quat::IDENTITY,
        0.95,
        &[0.5, 0.0, -0.5],
    );
    let camera = before_the_origin(90.0);
    check(&scene, |what, [plain, placed], _, whole, _| {
        let there = moved(&camera, whole);
        for (deviations, form, cut) in [
            (4.0, ExactForm::Auto, 1),
            (4.0, ExactForm::Affine, 0),
            (6.0, ExactForm::Auto, 0),
        ] {
            let normal = DVec3::new(0.7, 0.1, -0.6).normalize();
            let plane = Plane::new(normal, 0.1 * deviations - normal.dot(at.as_dvec3()));
            let clip = Clip::of([plane.expect("a normal")], ClipOp::And);
            let settings = Settings::default().form(form);
            let (stats, _) = drawn(plain, &camera, &clip, &settings);
            assert_eq!(stats.counts.cutoff, cut, "{deviations}, {form:?}");
            let what = format!("{what}: {deviations} deviations, {form:?}");
            let same = (&clip, &settings, whole);
            assert_same(&what, [plain, placed], [&camera, &there], same);
        }
    });
}

/// Normals are directions in the world, depths are lengths in it, and whatever else a pixel has knows nothing of it.
#[test]
fn channels_turn_and_scale_with_the_scene() {
    let mut scene = generate(Kind::General, 400, 5);
    scene.set_sh_degree(0);
    // Wide and near, so that lines of sight differ much from the axis.
    let eye = DVec3::new(0.3, -0.4, -1.6);
    let camera = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 90.0, (64, 48)).expect("a view");
    let flat = camera.projection(Projection::Orthographic);
    let clip = common::clip(&scene, 1, ClipOp::And);
    let settings = Settings::default();
    let all = [Aov::Depth, Aov::Normal, Aov::Layer, Aov::Weight, Aov::Count];
    check(&scene, |what, [plain, placed], _, whole, _| {
        for camera in [camera, flat.fx(20.0).fy(20.0)] {
            let camera = camera.near_cut(Some(0.2));
            let there = moved(&camera, whole);
            let frame = (&camera, &clip, &settings);
            let before = plain.channels(&all, frame).expect("channels");
            let frame = (&there, &carried(&clip, whole), &settings);
            let after = placed.channels(&all, frame).expect("channels");
            let what = format!("{what}: {:?}", camera.projection);
            assert_channels(&what, &before, &after, whole);
        }
    });
}

fn assert_channels(what: &str, before: &[Channel], after: &[Channel], whole: &Placement) {
    let names = |all: &[Channel]| -> Vec<String> { all.iter().map(|c| c.name.clone()).collect() };
    assert_eq!(
        names(before),
        ["Z", "N.X", "N.Y", "N.Z", "layer", "weight", "count"]
    );
    assert_eq!(names(before), names(after), "{what}");
    let normal = |all: &[Channel], at: usize| {
        DVec3::new(
            all[1].values[at].into(),
            all[2].values[at].into(),
            all[3].values[at].into(),
        )
    };
    let pixels = before[0].values.len();
    let mut off = [0; 5];
    let mut shown = 0;
    for at in 0..pixels {
        let value = |channel: usize| [before, after].map(|all| f64::from(all[channel].values[at]));
        let [depth, scaled] = value(0);
        let turned = whole.rotation() * normal(before, at);
        let same = |channel: usize| {
            let [a, b] = value(channel);
            (a - b).abs() < 1e-3
        };
        let fits = [
            (scaled / whole.scale() - depth).abs() < 1e-3,
            turned.distance(normal(after, at)) < 1e-2,
            same(4),
            same(5),
            same(6),
        ];
        for (off, fits) in off.iter_mut().zip(fits) {
            *off += usize::from(!fits);
        }
        shown += usize::from(depth > 0.0);
    }
    assert!(shown > pixels / 4, "{what}: {shown} pixels show something");
    // At the rim of a splat alpha may pass 1/255.
    assert!(
        off.iter().all(|off| *off <= 6),
        "{what}: {off:?} of {shown} pixels"
    );
}
