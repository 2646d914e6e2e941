//! The band in which a plane cuts: it is so wide that nothing outside of it shows, and hardly wider than the splats.

use crate::common;
use glam::{DQuat, DVec3, Quat, Vec3};
use proptest::prelude::*;
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Decay, ExactForm, Gaussians, Mode, Plane, Settings};
use rara_reference::{Footprint, Side, ViewTransform, classify, cutoff, splat};

/// The most that a pixel may change when a splat outside the band is treated as cut: half of an 8-bit level.
const HALF_LEVEL: f64 = 0.5 / 255.0;

fn view_from(distance: f64) -> Camera {
    let eye = DVec3::new(0.3, -0.2, -1.0).normalize() * distance;
    Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 40.0, (256, 256)).expect("a plain view")
}

fn one(scales: Vec3, rotation: Quat, opacity: f32) -> Gaussians {
    let mut one = Gaussians::default();
    one.push(Vec3::ZERO, scales, rotation, opacity, &[0.0; 3]);
    one
}

fn cut_by(normal: DVec3, offset: f64) -> Clip {
    Clip::of(
        [Plane::new(normal, offset).expect("a finite normal")],
        ClipOp::And,
    )
}

/// Standard deviation of a Gaussian along a direction, from its definition.
fn deviation(scene: &Gaussians, index: usize, normal: DVec3) -> f64 {
    let local = scene.rotations()[index].as_dquat().inverse() * normal;
    (local * scene.scales()[index].as_dvec3()).length()
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, 0.0..std::f64::consts::TAU).prop_map(|(z, turn)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    })
}

fn rotation() -> impl Strategy<Value = Quat> {
    (direction(), 0.0..std::f64::consts::TAU)
        .prop_map(|(axis, angle)| DQuat::from_axis_angle(axis, angle).as_quat())
}

fn scales() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-4.0..-0.5_f32)
        .prop_map(|logs| Vec3::from_array(logs.map(|l| 10.0_f32.powf(l))))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The theorem behind the band: outside of it alpha times weight is within half a level of all or nothing, in every
    /// pixel that counts. It is checked in the affine form, for which the footprint itself is the evidence, and along
    /// true rays, where the band is wider.
    #[test]
    fn outside_the_band_no_pixel_changes_by_half_a_level(
        form in prop::sample::select(vec![ExactForm::Affine, ExactForm::Beam]), distance in 0.5..4.0_f64,
        away in (-2.0..2.0_f64, -2.0..2.0_f64),
        scales in scales(), rotation in rotation(), opacity in 0.005..1.0_f32, normal in direction(),
        beyond in 1.0..1.3_f64, kept in prop::bool::ANY, aim in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 40),
    ) {
        let scene = one(scales, rotation, opacity);
        // Splats off the axis too, and beyond the picture's edge.
        let from = view_from(distance);
        let camera = from
.eye(from.eye + distance / 4.0 * DVec3::new(away.0, away.1, 0.0));
        let view = ViewTransform::<f64>::new(&camera);
        let Some(footprint) = Footprint::new(&scene, 0, &view) else { return Ok(()) };
        let mut reach = (2.0 * (255.0 * f64::from(opacity)).ln()).sqrt();
        if form == ExactForm::Beam {
            let rest = 1.0 - reach * footprint.stretch * footprint.rows[2].length() / footprint.view_centre.z;
            prop_assume!((rest - 0.05).abs() > 1e-6);
            reach = if rest > 0.05 {
                reach * footprint.stretch / rest
            } else {
                // Splats around the eye: by where the eye is in the splat.
                let turned = scene.rotations()[0].as_dquat().inverse() * camera.eye;
                (turned / scene.scales()[0].as_dvec3()).length() + 6.0
            };
        }
        let sign = if kept { 1.0 } else { -1.0 };
        let clip = cut_by(normal, sign * beyond * (1.0 + 1e-9) * reach * deviation(&scene, 0, normal));

        let settings = Settings::default()
.form(form);
        let side = classify::classify(&scene, &view, &clip, &settings)[0];
        prop_assert_eq!(side, if kept { Side::Visible } else { Side::Invisible });

        let traced = settings
.trace_all(true);
        let mut drawn = rara_reference::project::project(&scene, 0, &view, &settings).expect("it is in view");
        for (x, y) in aim {
            let (dx, dy) = (x * footprint.half_sides[0], y * footprint.half_sides[1]);
            drawn.cut = None;
            let whole = splat::alpha(&drawn, dx, dy, Decay::Linear).unwrap_or(0.0);
            drawn.cut = cutoff::cutoff(&scene, 0, &footprint, &view, &clip, &traced);
            let cut = splat::alpha(&drawn, dx, dy, Decay::Linear).unwrap_or(0.0);
            let change = (cut - if kept { whole } else { 0.0 }).abs();
            prop_assert!(change <= HALF_LEVEL * (1.0 + 1e-9), "{} levels", 255.0 * change);
        }
    }
}

/// Needles a thousand times as long as thick, all in view, and a plane through their middle.
fn needles(count: usize) -> (Gaussians, Camera, Plane) {
    let mut scene = generate(Kind::Strands, count, 3);
    for scale in scene.scales_mut() {
        *scale = Vec3::new(0.2, 2e-4, 2e-4);
    }
    let plane = Plane::new(DVec3::new(0.7, 0.5, -0.4), 0.01).expect("a finite normal");
    (scene, view_from(12.0), plane)
}

/// Says whether the plane separates points of the splat's contour at alpha = 1/255, found from points of it, without a
/// formula.
fn truly_cut(scene: &Gaussians, index: usize, plane: &Plane, sphere: &[DVec3]) -> bool {
    let reach = (2.0 * (255.0 * f64::from(scene.opacities()[index])).max(1.0).ln()).sqrt();
    let (rotation, scales) = (
        scene.rotations()[index].as_dquat(),
        scene.scales()[index].as_dvec3(),
    );
    let centre = scene.positions()[index].as_dvec3();
    let kept = |u: &DVec3| plane.distance(centre + rotation * (*u * reach * scales)) >= 0.0;
    let first = kept(&sphere[0]);
    sphere.iter().any(|u| kept(u) != first)
}

#[test]
fn hardly_more_needles_are_called_cut_than_are() {
    let (scene, camera, plane) = needles(20_000);
    // Points of the unit sphere by the golden angle, and the axes' ends.
    let golden = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 400.0;
        let turn = f64::from(i) * 2.399_963;
        DVec3::new(
            z,
            (1.0 - z * z).sqrt() * turn.cos(),
            (1.0 - z * z).sqrt() * turn.sin(),
        )
    };
    let sphere: Vec<_> = (0..400).map(golden).chain([DVec3::X, -DVec3::X]).collect();
    let all = 0..scene.len();
    let truth = all
        .clone()
        .filter(|&i| truly_cut(&scene, i, &plane, &sphere))
        .count();
    let paper = all
        .filter(|&i| {
            plane.distance(scene.positions()[i].as_dvec3()).abs()
                < 3.0 * f64::from(scene.scales()[i].max_element())
        })
        .count();

    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let clip = Clip::of([plane], ClipOp::And);
    let counts = headless
        .render(&camera, &clip, &Settings::default())
        .expect("renders")
        .counts;
    assert_eq!(counts.culled, 0, "all are in view");
    let ours = counts.cutoff as usize;
    println!("needles: {ours} called cut, {truth} are, the paper's band holds {paper}");
    assert!(ours >= truth, "{ours} called cut, {truth} are");
    assert!(
        ours as f64 <= 1.05 * truth as f64,
        "{ours} called cut, {truth} are"
    );
    assert!(
        paper as f64 > 1.8 * ours as f64,
        "the paper's band holds {paper}, ours {ours}"
    );
}

#[test]
fn on_the_device_nothing_shows_of_a_splat_outside_the_band() {
    let mut headless = common::headless();
    let camera = view_from(4.0);
    let mut worst = 0.0_f64;
    for (index, opacity) in [0.01_f32, 0.1, 0.5, 0.9, 0.99, 1.0].into_iter().enumerate() {
        let turn =
            Quat::from_rotation_y(0.7 + index as f32) * Quat::from_rotation_x(1.1 * index as f32);
        for scales in [
            Vec3::new(0.3, 0.003, 0.003),
            Vec3::new(0.2, 0.2, 0.001),
            Vec3::splat(0.1),
        ] {
            let scene = one(scales, turn, opacity);
            headless.load(&scene).expect("uploads");
            for normal in [DVec3::X, DVec3::new(0.3, 0.5, -0.8).normalize()] {
                let reach = (2.0 * (255.0 * f64::from(opacity)).ln()).sqrt();
                let edge = 1.001 * reach * deviation(&scene, 0, normal);
                // Along true rays the band is wider by at most what perspective adds, a share of the depth of 4.
                let wider = edge / (1.0 - 1.001 * reach * f64::from(scales.max_element()) / 4.0);
                for (form, offset, side) in [
                    (ExactForm::Affine, edge, 1.0),
                    (ExactForm::Affine, -edge, 0.0),
                    (ExactForm::Auto, wider, 1.0),
                    (ExactForm::Auto, -wider, 0.0),
                ] {
                    let clip = cut_by(normal, offset);
                    let settings = Settings::default().decay(Some(Decay::Linear)).form(form);
                    let mut draw = |settings: &Settings| {
                        let counts = headless
                            .render(&camera, &clip, settings)
                            .expect("renders")
                            .counts;
                        (counts, headless.picture().expect("reads back"))
                    };
                    let (counts, whole) = draw(&settings);
                    assert_eq!(f64::from(counts.visible), side, "{counts:?}");
                    assert_eq!(counts.cutoff, 0);
                    let (_, traced) = draw(&settings.trace_all(true));
                    for (a, b) in whole.pixels.iter().zip(&traced.pixels) {
                        worst = worst.max(f64::from((a[3] - b[3]).abs()));
                    }
                }
            }
        }
    }
    println!("largest change on the device: {:.3} levels", 255.0 * worst);
    assert!(worst <= HALF_LEVEL + 2e-5, "{:.3} levels", 255.0 * worst);
    assert!(
        worst > 0.8 * HALF_LEVEL,
        "the bound is tight: {:.3} levels",
        255.0 * worst
    );
}

#[test]
fn fewer_are_cut_than_by_the_paper_in_trained_scenes() {
    for (name, scene) in common::trained_scenes() {
        let bands = classify::bands(&scene);
        println!(
            "{name}: {:.2} % cut, {:.2} % in the paper's band",
            100.0 * bands.ours,
            100.0 * bands.paper
        );
        assert!(bands.ours < bands.paper, "{name}: {bands:?}");
    }
}

#[test]
fn modes_without_a_band_call_nothing_cut() {
    let (scene, camera, plane) = needles(500);
    let view = ViewTransform::<f64>::new(&camera);
    let clip = Clip::of([plane], ClipOp::And);
    for mode in [Mode::None, Mode::Hard] {
        let settings = Settings::default().mode(mode);
        let sides = classify::classify(&scene, &view, &clip, &settings);
        assert!(!sides.contains(&Side::Cutoff));
    }
}

/// A disc without thickness that lies in the plane of a cut is halved like one of any other thickness, and not kept by both sides.
#[test]
fn a_disc_in_the_plane_of_the_cut_is_halved() {
    let mut headless = common::headless();
    let camera = view_from(6.0);
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.2, 0.9);
    let mut draw = |thickness: f32, clip: &Clip| {
        let disc = one(Vec3::new(0.5, 0.7, thickness), turn.as_quat(), 0.9);
        headless.load(&disc).expect("uploads");
        headless
            .render(&camera, clip, &Settings::default())
            .expect("renders");
        headless.picture().expect("reads back").at(128, 128)[3]
    };
    for normal in [DVec3::Z, turn * DVec3::Z] {
        let clip = cut_by(normal, 0.0);
        let [kept, rest] = [&clip, &clip.complement()].map(|clip| draw(0.0, clip));
        let like = draw(1e-5, &clip);
        let whole = draw(0.0, &Clip::default());
        assert!(
            (kept - like).abs() < 1e-4,
            "{normal}: {kept}, with a thickness {like}"
        );
        let both = 1.0 - (1.0 - kept) * (1.0 - rest);
        assert!(
            (both - whole).abs() < 1e-4,
            "{normal}: halves of {both}, the whole is {whole}"
        );
    }
}
