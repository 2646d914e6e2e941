//! The weights of mode `exact` against numerical integration of the truncated Gaussian.

use super::quadrature::{Bundle, PixelRays};
use super::*;
use glam::DVec2;
use rara_scene::settings::ExactForm;

/// The result of a comparison of many pixels.
#[derive(Debug, Default)]
pub(super) struct Errors {
    /// Sum of alpha |w - truth| over the sum of alpha.
    pub(super) mean: f64,
    /// Largest alpha |w - truth|.
    pub(super) max: f64,
    /// Pixels compared.
    pub(super) count: usize,
    /// Pixels of which the truth is between 1 and 99 percent.
    pub(super) partial: usize,
}

impl Errors {
    /// Fails unless more than so many pixels are cut partly, since the test would say nothing otherwise.
    #[track_caller]
    pub(super) fn assert_partial(&self, pixels: usize) {
        assert!(
            self.partial > pixels,
            "the test would say nothing: {self:?}"
        );
    }

    /// Fails unless the mean and the largest error are below these; `about` names the case.
    #[track_caller]
    pub(super) fn assert_within(&self, mean: f64, max: f64, about: impl std::fmt::Display) {
        assert!(self.mean < mean && self.max < max, "{about}: {self:?}");
    }
}

/// The splats and pixels to be compared.
pub(super) struct Study {
    /// Largest deviation of the splats, pixels: from and to.
    pub(super) pixels: [f64; 2],
    pub(super) aspect: f64,
    pub(super) planes: usize,
    pub(super) op: ClipOp,
    pub(super) form: ExactForm,
    pub(super) bundle: Bundle,
    pub(super) projection: Projection,
    /// X/Z of the splat's centre, if it is not to be in the picture.
    pub(super) aside: Option<[f64; 2]>,
    /// Depth of the splat's centre in deviations of its depth, for an eye within it.
    pub(super) inside: Option<[f64; 2]>,
    pub(super) cases: usize,
    pub(super) steps: u32,
}

pub(super) const STUDY: Study = Study {
    pixels: [0.02, 0.2],
    aspect: 10.0,
    planes: 1,
    op: ClipOp::And,
    form: ExactForm::Beam,
    bundle: Bundle::Parallel,
    projection: Projection::Perspective,
    aside: None,
    inside: None,
    cases: 60,
    steps: 64,
};

impl Study {
    pub(super) fn run(&self) -> Errors {
        let mut dice = Dice(77);
        // Splats are three to six units deep, so that either picture shows about as much of the world.
        let focal = match self.projection {
            Projection::Perspective => 500.0,
            Projection::Orthographic => 100.0,
        };
        let camera = camera(640, 480, focal).projection(self.projection);
        let view = ViewTransform::<f64>::new(&camera);
        let mut errors = Errors::default();
        let mut mass = 0.0;
        while errors.count < self.cases {
            let pixels = self.pixels[0] * (self.pixels[1] / self.pixels[0]).powf(dice.next());
            let mut one = dice.one(1.0, self.aspect);
            let units = match self.projection {
                Projection::Perspective => f64::from(one.position[2]) / focal,
                Projection::Orthographic => 1.0 / focal,
            };
            let size = pixels * units / f64::from(one.scale.into_iter().fold(0.0, f32::max));
            one.scale = one.scale.map(|s| (f64::from(s) * size) as f32);
            if let Some([low, high]) = self.aside {
                one.position[0] = (dice.between(low, high) * f64::from(one.position[2])) as f32;
            }
            if let Some([low, high]) = self.inside {
                let down = one.rotation.as_dquat().inverse()
                    * DVec3::Z
                    * Point::from(one.scale).as_dvec3();
                let factor = dice.between(low, high) * down.length() / f64::from(one.position[2]);
                one.position = one.position.map(|p| (f64::from(p) * factor) as f32);
            }
            let scene = scene(&[one]);
            let Some(footprint) = Footprint::new(&scene, 0, &view) else {
                continue;
            };
            let planes: Vec<_> = (0..self.planes)
                .map(|_| {
                    let normal = dice.direction();
                    plane_through(&one, normal, dice.normal())
                })
                .collect();
            let clip = clip(self.op, &planes);
            let settings = mode(Mode::Exact).form(self.form).trace_all(true);
            let record = cutoff::cutoff(&scene, 0, &footprint, &view, &clip, &settings).unwrap();
            // A pixel of the footprint, by its density.
            let [k0, k1, k2] = footprint.conic;
            let dx = dice.normal() / k0;
            let dy = (dice.normal() - k1 * dx) / k2;
            let position = DVec2::new(
                footprint.screen_centre[0] + dx,
                footprint.screen_centre[1] + dy,
            );
            let rays = PixelRays {
                bundle: self.bundle,
                ..PixelRays::parallel(&camera, &clip, position, self.steps)
            };
            let truth = rays.share(&scene, 0);
            if truth.is_nan() {
                continue;
            }
            let alpha = f64::from(one.opacity) * (-0.5 * footprint.power(dx, dy)).exp();
            let error = alpha * (record.weight(dx, dy) - truth).abs();
            errors.mean += error;
            errors.max = errors.max.max(error);
            errors.count += 1;
            errors.partial += usize::from((0.01..0.99).contains(&truth));
            mass += alpha;
        }
        errors.mean /= mass;
        errors
    }
}

#[test]
#[ignore = "prints the errors of all forms; the other tests hold them to limits"]
fn table() {
    for bundle in [Bundle::Parallel, Bundle::Diverging] {
        for form in [ExactForm::Beam, ExactForm::Affine, ExactForm::Auto] {
            for (pixels, aspect) in [
                ([0.02, 0.2], 10.0),
                ([0.2, 1.0], 10.0),
                ([1.0, 5.0], 30.0),
                ([1.0, 5.0], 1000.0),
                ([5.0, 30.0], 30.0),
                ([30.0, 100.0], 30.0),
                ([100.0, 300.0], 30.0),
            ] {
                let errors = Study {
                    pixels,
                    aspect,
                    form,
                    bundle,
                    cases: 200,
                    steps: 128,
                    ..STUDY
                }
                .run();
                println!("{bundle:?} {form:?} {pixels:?} px, aspect {aspect}: {errors:?}");
            }
        }
    }
    for op in [ClipOp::And, ClipOp::Or] {
        for planes in [2, 3] {
            for pixels in [[0.02, 0.2], [1.0, 5.0], [5.0, 30.0], [30.0, 300.0]] {
                let errors = Study {
                    pixels,
                    planes,
                    op,
                    cases: 200,
                    ..STUDY
                }
                .run();
                println!("{planes} planes, {op:?}, {pixels:?} px: {errors:?}");
            }
        }
    }
    for op in [ClipOp::And, ClipOp::Or] {
        for planes in [1, 2] {
            for inside in [[0.1, 1.0], [1.0, 2.0], [2.0, 3.0]] {
                for bundle in [Bundle::Parallel, Bundle::Diverging] {
                    let errors = Study {
                        pixels: [300.0, 3000.0],
                        inside: Some(inside),
                        planes,
                        op,
                        bundle,
                        cases: 200,
                        ..STUDY
                    }
                    .run();
                    println!(
                        "eye inside, {planes} planes, {op:?}, {inside:?} deviations, {bundle:?}: {errors:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_perspective_form_is_the_integral_over_the_parallel_bundle() {
    for (pixels, aspect) in [
        ([0.02, 0.2], 10.0),
        ([0.2, 5.0], 30.0),
        ([5.0, 100.0], 30.0),
    ] {
        let errors = Study {
            pixels,
            aspect,
            steps: 128,
            ..STUDY
        }
        .run();
        errors.assert_partial(15);
        errors.assert_within(1e-4, 5e-4, format_args!("{pixels:?}"));
    }
}

#[test]
fn the_perspective_form_is_close_to_the_blurred_picture_of_the_cut_gaussian() {
    for pixels in [[0.02, 0.2], [0.2, 5.0], [5.0, 300.0]] {
        let errors = Study {
            pixels,
            bundle: Bundle::Diverging,
            ..STUDY
        }
        .run();
        errors.assert_within(5e-4, 3e-3, format_args!("{pixels:?}"));
    }
}

#[test]
fn the_affine_form_is_close_for_small_splats_and_auto_for_all() {
    for (form, pixels, limit) in [
        (ExactForm::Affine, [0.02, 0.2], 1e-4),
        (ExactForm::Affine, [0.2, 1.0], 5e-4),
        (ExactForm::Affine, [1.0, 5.0], 1e-3),
        (ExactForm::Auto, [5.0, 30.0], 1e-3),
        (ExactForm::Auto, [30.0, 300.0], 1e-4),
    ] {
        let errors = Study {
            pixels,
            form,
            ..STUDY
        }
        .run();
        assert!(errors.mean < limit, "{form:?} {pixels:?}: {errors:?}");
    }
}

#[test]
fn several_oblique_planes_are_as_exact_as_one() {
    for op in [ClipOp::And, ClipOp::Or] {
        for (planes, limits) in [(2, [1e-4; 3]), (3, [1e-4; 3]), (5, [2e-4, 1e-4, 1e-4])] {
            for (pixels, limit) in [[0.02, 0.2], [1.0, 5.0], [30.0, 300.0]]
                .into_iter()
                .zip(limits)
            {
                let errors = Study {
                    pixels,
                    planes,
                    op,
                    cases: 80,
                    steps: 112,
                    ..STUDY
                }
                .run();
                println!("{op:?} {planes} {pixels:?}: {errors:?}");
                assert!(
                    errors.mean < limit,
                    "{op:?} {planes} {pixels:?}: {errors:?}"
                );
            }
        }
    }
}

#[test]
fn an_eye_within_the_splat_sees_its_front_part_only() {
    for op in [ClipOp::And, ClipOp::Or] {
        for planes in [1, 2] {
            for inside in [[0.1, 1.0], [1.0, 2.5]] {
                let pixels = [300.0, 3000.0];
                let errors = Study {
                    pixels,
                    inside: Some(inside),
                    op,
                    planes,
                    steps: 48,
                    ..STUDY
                }
                .run();
                errors.assert_partial(10);
                errors.assert_within(1e-4, 1e-3, format_args!("{op:?} {planes} {inside:?}"));
            }
        }
    }
}

/// Seen from within a splat, towards its back: there is hardly any of it in front of the eye, and that little is cut.
#[test]
fn the_last_of_a_splat_in_front_of_the_eye_is_cut_like_the_rest() {
    let camera = camera(481, 381, 100.0);
    let one = One {
        position: [0.0753, -0.045, 3.5259],
        scale: [0.3065, 1.35, 6.193],
        rotation: glam::Quat::from_xyzw(0.28725, -0.29058, 0.1869, -0.89338).normalize(),
        opacity: 0.573,
        ..One::default()
    };
    let scene = scene(&[one]);
    let view = ViewTransform::<f64>::new(&camera);
    let footprint = Footprint::new(&scene, 0, &view).expect("in view");
    let clip = clip(
        ClipOp::And,
        &[plane([0.91813, -0.38106, -0.10876], 3.48262)],
    );
    let settings = mode(Mode::Exact);
    let cut = cutoff::cutoff(&scene, 0, &footprint, &view, &clip, &settings).expect("cut");
    let mut last: Option<f64> = None;
    for x in (10..480).step_by(5) {
        let position = DVec2::new(f64::from(x) + 0.5, 264.5);
        let [dx, dy] = [
            position.x - footprint.screen_centre[0],
            position.y - footprint.screen_centre[1],
        ];
        let weight = cut.weight(dx, dy);
        let rays = PixelRays::parallel(&camera, &clip, position, 64);
        let truth = rays.share(&scene, 0);
        // Behind the eye's tail quadrature has nothing to sum up.
        if truth.is_finite() {
            assert!((weight - truth).abs() < 2e-3, "{x}: {weight}, {truth}");
        }
        if let Some(last) = last {
            assert!(
                (weight - last).abs() < 0.1,
                "a seam at {x}: {last}, {weight}"
            );
        }
        last = Some(weight);
    }
}

#[test]
fn a_centre_far_outside_the_picture_gets_the_perspective_form() {
    // The picture ends at X/Z = 0.64 and the clamp at 0.83.
    let errors = Study {
        pixels: [60.0, 600.0],
        aside: Some([0.9, 1.5]),
        form: ExactForm::Auto,
        steps: 48,
        ..STUDY
    }
    .run();
    errors.assert_partial(15);
    errors.assert_within(1e-4, 1e-3, "");
}
