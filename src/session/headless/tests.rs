//! Tests that look inside, through seams that only they have.

mod failures;
mod tile_pictures;

use super::*;
use ash::vk;
use glam::{DVec3, Vec3};
use rara_base::limits;
use rara_gpu::{Bindings, faults};
use rara_scene::clip::{ClipOp, Plane};
use rara_scene::settings::{ExactForm, Mode, Raster, Show};
use rara_scene::{Bounds, Gaussians, Kind, Random, extent_along, generate};

fn headless() -> Headless {
    let desc = HeadlessDesc {
        device: std::env::var("RARA_TEST_DEVICE").ok(),
        validation: true,
        bindings: Some(Bindings::Mixed),
        ..HeadlessDesc::default()
    };
    Headless::new(&desc).expect("a device and the validation layer")
}

/// Without room for a list of each tile the lists are coarse, in cells of some tiles or of all, and the picture is the same.
#[test]
fn what_tiles_have_no_room_for_has_coarse_lists() {
    let scene = generate(Kind::General, 3_000, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (200, 150)).expect("a view");
    // The second and the third are reclipped frames, whose base has no room either.
    let clips = [0.0, 0.1, 0.2].map(|offset| {
        let plane = Plane::new(DVec3::X, offset).expect("a finite normal");
        Clip::of([plane], ClipOp::And)
    });
    let draw = |pairs| {
        let mut headless = headless();
        headless.load(&scene).expect("uploads");
        if let Some(pairs) = pairs {
            headless.session.renderer.limit_pairs(pairs);
        }
        let mut pictures = Vec::new();
        // What else tiles show has less to do with the clip, whose pipelines take a driver longest.
        let shown = [(Show::Colour, Mode::Exact), (Show::Count, Mode::Hard)];
        for (clip, (show, mode)) in clips.iter().flat_map(|clip| shown.map(|how| (clip, how))) {
            let settings = Settings::default()
                .raster(Raster::Tiles)
                .show(show)
                .mode(mode);
            let stats = headless.render(&camera, clip, &settings).expect("renders");
            let is_coarse = stats.raster.reason.contains("coarse");
            assert_eq!((stats.raster.path, is_coarse), ("tiles", pairs.is_some()));
            pictures.push(headless.picture().expect("reads back"));
        }
        pictures
    };
    let whole = draw(None);
    assert!(whole[0].pixels.iter().any(|pixel| pixel[3] > 0.5));
    for pairs in [1 << 12, 1] {
        for (at, (coarse, whole)) in draw(Some(pairs)).iter().zip(&whole).enumerate() {
            // Lists leave out what a cut leaves next to nothing of (TRIM_DEVIATIONS); a cell's need not.
            let worst = apart(coarse, whole);
            assert!(worst <= 1e-6, "{pairs} pairs, picture {at}: {worst}");
        }
    }
}

/// The same of splats as large as single precision has, and through a lens that puts centres far outside the picture.
#[test]
fn coarse_lists_hold_what_quads_cover_however_large() {
    let mut headless = headless();
    let mut scene = generate(Kind::General, 3_000, 1);
    for index in (0..scene.len()).step_by(300) {
        scene.scales_mut()[index] = match index / 300 {
            0..4 => Vec3::new(40.0, 0.01, 3.0),
            4..7 => Vec3::splat(1e9),
            _ => Vec3::splat(1e20),
        };
        scene.opacities_mut()[index] = 0.05;
    }
    headless.load(&scene).expect("uploads");
    headless.session.renderer.limit_pairs(1);
    for fov in [60.0, 0.5, 1e-5] {
        let camera = Camera::look_at(DVec3::splat(4.0), DVec3::ZERO, -DVec3::Y, fov, (200, 150));
        let camera = camera.expect("a view");
        let [tiles, quads] = [Raster::Tiles, Raster::Quad].map(|raster| {
            headless.forget();
            let settings = Settings::default().raster(raster);
            let stats = headless.render(&camera, &Clip::default(), &settings);
            stats.expect("renders");
            headless.picture().expect("reads back")
        });
        assert!(quads.pixels.iter().any(|pixel| pixel[3] > 0.01), "{fov}");
        assert!(apart(&tiles, &quads) <= 1e-5, "{fov}");
    }
}

/// The most that a channel differs.
fn apart(a: &Picture, b: &Picture) -> f32 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Scenes of many blocks: neighbours alike, ones that leave their block to be looked at, and blocks whose Gaussians are
/// one and the same, so that their bounds are no wider than they.
fn scenes_of_blocks() -> impl Iterator<Item = Gaussians> {
    let general = generate(Kind::General, 5_000, 3);
    let mut small = general.clone();
    for scale in small.scales_mut() {
        *scale *= 0.02;
    }
    for opacity in small.opacities_mut() {
        *opacity = opacity.max(0.01);
    }
    let mut odd = general.clone();
    for index in 0..odd.len() {
        odd.scales_mut()[index] = match index {
            _ if index % 7 == 0 => Vec3::ZERO,
            _ if index % 301 == 0 => Vec3::splat(50.0),
            _ if index % 2003 == 0 => Vec3::splat(1e36),
            _ => odd.scales()[index],
        };
        if index % 5 == 0 {
            odd.opacities_mut()[index] = limits::ALPHA_MIN * (1.0 + 1e-5 * (index as f32 - 2500.0));
        }
        if index % 1999 == 0 {
            odd.positions_mut()[index] = Vec3::splat(1e36);
        }
    }
    let mut tight = general.clone();
    for index in 0..tight.len() {
        let first = index / limits::BLOCK_SIZE as usize * limits::BLOCK_SIZE as usize;
        tight.positions_mut()[index] = general.positions()[first];
        tight.scales_mut()[index] =
            Vec3::splat([0.0005, 0.05][first / limits::BLOCK_SIZE as usize % 2]);
        tight.opacities_mut()[index] = 0.9;
    }
    let antialiased = [&general, &odd, &tight].map(|scene| {
        let mut scene = scene.clone();
        scene.set_antialiased(true);
        scene
    });
    [general, small, odd, tight].into_iter().chain(antialiased)
}

/// Views from outside, from within and with a long lens, aside and askew.
fn views_of_blocks(bounds: &Bounds) -> Vec<Camera> {
    let centre = bounds.centre();
    let beside = |way: DVec3, size| {
        let eye = centre + 2.2 * bounds.radius() * way.normalize();
        Camera::look_at(eye, centre, -DVec3::Y, 50.0, size).expect("a view from outside")
    };
    let first = beside(DVec3::new(1.0, -0.3, 0.4), (125, 95));
    let second = beside(DVec3::new(-0.2, 0.5, -1.0), (64, 48));
    let changed = |change: fn(&mut Camera)| {
        let mut camera = first;
        change(&mut camera);
        camera
    };
    let mut within = second;
    within.eye = centre;
    vec![
        first,
        second,
        within,
        changed(|c| (c.fx, c.fy) = (300.0 * c.fx, 300.0 * c.fy)),
        changed(|c| (c.fx, c.fy) = (0.02 * c.fx, 0.1 * c.fy)),
        changed(|c| (c.fx, c.cx, c.cy) = (4.0 * c.fx, -400.0, 150.0)),
        changed(|c| (c.fx, c.fy, c.cx) = (1e5, 30.0, 1e5)),
    ]
}

/// The same view with a point this many pixels right of the picture's left edge, where blocks come into view.
fn at_the_edge(camera: Camera, point: Vec3, pixels: f64) -> Camera {
    let seen = camera.rotation * (point.as_dvec3() - camera.eye);
    camera.cx(pixels - camera.fx * seen.x / seen.z)
}

/// Blocks that are settled as a whole give the same counts and the same bytes as their Gaussians looked at one by one.
#[test]
fn blocks_change_nothing() {
    /// SIDE_CULLED of glsl/region/sides.glsl.
    const CULLED: u32 = 0;
    let mut random = Random::new(5);
    let mut pick = |count: usize| random.range(0.0, count as f64) as usize;
    let (mut settles, mut looks) = (headless(), headless());
    let (mut settled, mut antialiased_in_view) = (0, 0);
    for scene in scenes_of_blocks() {
        settles.load(&scene).expect("uploads");
        looks.load(&scene).expect("uploads");
        let buffers = looks.session.scene.as_ref().expect("loaded");
        buffers.undecide(&looks.session.device).expect("uploads");
        let views = views_of_blocks(&Bounds::of(&scene));
        for step in 0..if faults::is_slow() { 8 } else { 16 } {
            let camera = match views.get(step) {
                Some(camera) => *camera,
                None => {
                    let point = scene.positions()[pick(scene.len())];
                    at_the_edge(views[pick(2)], point, -2.0 + 0.5 * pick(9) as f64)
                }
            };
            let mut settings = Settings::default()
                .mode([Mode::Hard, Mode::Rara, Mode::Exact, Mode::Exact][pick(4)])
                .form([ExactForm::Auto, ExactForm::Beam, ExactForm::Affine][pick(3)])
                .raster([Raster::Tiles, Raster::Quad][pick(2)])
                .trace_all(pick(8) == 0);
            settings.precision.beam_switch = [0.0, 0.005, 0.05][pick(3)];
            let normals = [
                DVec3::X,
                DVec3::new(0.1, 0.9, -0.3),
                DVec3::new(-0.4, -0.2, 0.7),
            ];
            let (planes, op) = (pick(4), [ClipOp::And, ClipOp::Or][pick(2)]);
            // The second and the third are reclipped frames.
            for share in [0.02, 0.5, 0.8].map(|share| share + 0.01 * pick(10) as f64) {
                let plane = |&normal: &DVec3| {
                    let (low, high) = extent_along(&scene, normal);
                    Plane::new(normal, -(low + share * (high - low))).expect("a finite normal")
                };
                let clip = Clip::of(normals[..planes].iter().map(plane), op);
                let draw = |headless: &mut Headless| {
                    let stats = headless.render(&camera, &clip, &settings).expect("renders");
                    let picture = headless.picture().expect("reads back");
                    (
                        stats.counts,
                        picture,
                        headless.session.renderer.block_sides(),
                    )
                };
                let (counts, picture, sides) = draw(&mut settles);
                let (each, truth, unsettled) = draw(&mut looks);
                let bits =
                    |picture: &Picture| bytemuck::cast_slice::<_, u32>(&picture.pixels).to_vec();
                let same = counts == each && bits(&picture) == bits(&truth);
                assert!(
                    same,
                    "step {step}: {counts:?}, {each:?}: {camera:?} {clip:?} {settings:?}"
                );
                assert!(unsettled.iter().all(|side| *side == unsettled[0]));
                let count = |is: fn(u32) -> bool| {
                    let settled = sides.iter().filter(|side| **side != unsettled[0]);
                    settled.filter(|side| is(**side)).count()
                };
                settled += count(|_| true);
                if scene.is_antialiased() {
                    antialiased_in_view += count(|side| side != CULLED);
                }
                looks.forget();
            }
        }
    }
    assert!(
        settled > 1000 && antialiased_in_view > 100,
        "only {settled} blocks were settled as a whole, {antialiased_in_view} of them antialiased and in view"
    );
}

#[test]
fn an_empty_scene_after_another_shows_nothing() {
    let mut headless = headless();
    let scene = generate(Kind::General, 500, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (40, 30)).expect("a view");
    let mut draw = |scene: &Gaussians| {
        headless.load(scene).expect("uploads");
        let mut stats = Vec::new();
        for _ in 0..2 {
            let drawn = headless.render(&camera, &Clip::default(), &Settings::default());
            stats.push(drawn.expect("renders"));
        }
        (headless.picture().expect("reads back"), stats)
    };
    let (picture, _) = draw(&scene);
    assert!(picture.pixels.iter().any(|pixel| pixel[3] > 0.5));
    let (picture, stats) = draw(&Gaussians::default());
    assert!(picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
    assert!(
        stats
            .iter()
            .all(|stats| stats.gpu_ms.is_some_and(f64::is_sign_positive))
    );
    assert!(stats[1].skipped.contains(&"splat"), "nothing has changed");
    assert_eq!(draw(&scene).1.len(), 2);
}

#[test]
fn what_is_left_alive_is_reported_at_the_end() {
    let headless = headless();
    // SAFETY: the device is alive; that the fence is never destroyed is what is tested.
    let fence = unsafe {
        let info = vk::FenceCreateInfo::default();
        headless.device().raw().create_fence(&info, None)
    };
    fence.expect("a fence");
    match headless.close() {
        Err(Error::Validation(messages)) => assert!(!messages.is_empty()),
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_error_comes_behind_what_the_layer_has_said() {
    let lost = || Error::DeviceLost {
        call: "vkQueueSubmit2",
    };
    assert!(matches!(lost().after(Vec::new()), Error::DeviceLost { .. }));
    match lost().after(vec!["a hazard".into()]) {
        Error::Validation(messages) => {
            assert!(messages[0] == "a hazard" && messages[1].contains("device was lost"));
        }
        other => panic!("{other}"),
    }
}

/// Tiles that end beyond the picture, in more than one strip; every way to weigh, and reclipped frames.
#[test]
fn subgroups_that_load_splats_together_change_nothing() {
    let mut scene = generate(Kind::General, 3_000, 1);
    // Splats that cover many tiles are cut in few of them: each way decides by itself where to weigh pixels.
    for scale in scene.scales_mut().iter_mut().step_by(7) {
        *scale *= 8.0;
    }
    let outside = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (157, 77)).expect("a view");
    let mut inside = outside;
    inside.eye = scene.positions()[0].as_dvec3(); // of one of the large splats
    let draw = |pretence| {
        let device = faults::device(pretence).expect("a device");
        if pretence.is_some() {
            assert_eq!(device.support().subgroup_size, 0);
        } else if device.support().subgroup_size == 0 {
            eprintln!(
                "SKIPPED: this device has no subgroups that shuffle, so one way is compared with itself"
            );
        }
        let mut headless =
            Headless::on(device.clone(), &HeadlessDesc::default()).expect("a renderer");
        headless.load(&scene).expect("uploads");
        let mut pictures = Vec::new();
        for (camera, mode, show, planes, op) in [
            (&outside, Mode::None, Show::Colour, 1, ClipOp::And),
            (&outside, Mode::Hard, Show::Colour, 1, ClipOp::And),
            (&outside, Mode::Rara, Show::Colour, 1, ClipOp::And),
            (&outside, Mode::Rara, Show::Colour, 3, ClipOp::Or),
            (&inside, Mode::Rara, Show::Colour, 1, ClipOp::And),
            (&outside, Mode::Exact, Show::Colour, 1, ClipOp::And),
            (&outside, Mode::Exact, Show::Colour, 2, ClipOp::Or),
            (&outside, Mode::Exact, Show::Colour, 4, ClipOp::And),
            (&outside, Mode::Exact, Show::Weight, 2, ClipOp::And),
            (&inside, Mode::Exact, Show::Colour, 1, ClipOp::And),
            (&inside, Mode::Exact, Show::Colour, 3, ClipOp::Or),
        ] {
            headless.forget();
            // All but the first of each row take over what is in view.
            for d in [0.0, 0.1, 0.2] {
                let normals = [
                    DVec3::X,
                    DVec3::new(0.3, 1.0, 0.2),
                    DVec3::new(-0.2, 0.1, 1.0),
                    DVec3::new(-1.0, 0.2, 0.3),
                ];
                let planes = normals.iter().take(planes);
                let clip = Clip::of(
                    planes.map(|&n| Plane::new(n, d).expect("a finite normal")),
                    op,
                );
                let settings = Settings::default()
                    .mode(mode)
                    .show(show)
                    .raster(Raster::Tiles);
                headless.render(camera, &clip, &settings).expect("renders");
                pictures.push(headless.picture().expect("reads back"));
            }
        }
        drop(headless);
        assert_eq!(device.close(), Vec::<String>::new());
        pictures
    };
    let together = draw(None);
    let apart = draw(Some(faults::Pretence::WithoutSubgroups));
    assert_eq!(together.len(), apart.len());
    let others = 5 * 3; // before mode `exact`
    assert!(together[..others] == apart[..others], "to the bit");
    // Where the eye is in a splat, a tile takes shares of less than 6e-6 for none.
    let values = |pictures: &[Picture]| -> Vec<f32> {
        let pixels = pictures.iter().flat_map(|picture| &picture.pixels);
        pixels.flatten().copied().collect()
    };
    let [a, b] = [&together, &apart].map(|pictures| values(&pictures[others..]));
    let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    let worst = worst.fold(0.0, f32::max);
    assert!(worst <= 1e-5, "{worst}");
    let last = together.last().expect("many");
    assert!(together[0] != *last, "pictures of different things");
}
