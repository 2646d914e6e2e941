//! Every choice of precision draws without a validation message and within its stated error.

use crate::common;
use glam::DVec3;
use rara::scene::Bounds;
use rara::{
    Camera, ClipOp, Gaussians, Headless, Mode, PhiForm, Precision, Preset, Settings, ShFormat,
    TargetFormat,
};
use rara_lab::measure::differences;

const SIZE: (u32, u32) = (203, 150);

/// Each choice by itself, and the presets.
fn choices() -> Vec<(&'static str, Precision)> {
    let base = Precision::default();
    let target = |target| base.target(target);
    let sh = |sh| base.sh(sh);
    let phi = |phi| base.phi(phi);
    let key_bits = |key_bits| base.key_bits(key_bits);
    let beam_switch = |beam_switch| base.beam_switch(beam_switch);
    let transmittance_min = |transmittance_min| base.transmittance_min(transmittance_min);
    vec![
        ("exact", Preset::Exact.precision()),
        ("balanced", Preset::Balanced.precision()),
        ("fast", Preset::Fast.precision()),
        ("target 16f", target(TargetFormat::Half)),
        ("target 8", target(TargetFormat::Unorm8)),
        ("sh 32f", sh(ShFormat::Float)),
        ("sh 16f", sh(ShFormat::Half)),
        ("sh 8", sh(ShFormat::Byte)),
        ("phi cubic", phi(PhiForm::Cubic)),
        ("phi logistic", phi(PhiForm::Logistic)),
        ("keys 24", key_bits(24)),
        ("keys 16", key_bits(16)),
        ("switch 0.05", beam_switch(0.05)),
        ("saturated 1e-4", transmittance_min(1e-4)),
        ("saturated 0", transmittance_min(0.0)),
    ]
}

/// The least PSNR of a scene in a precision, over some views.
fn psnr(headless: &mut Headless, scene: &Gaussians, views: &[Camera], precision: Precision) -> f64 {
    headless.load_as(scene, precision.sh).expect("uploads");
    let clip = common::clip(scene, 1, ClipOp::And);
    let settings = Settings::default().precision(precision);
    let view = |camera| {
        headless.render(camera, &clip, &settings).expect("renders");
        let picture = headless.picture().expect("reads back");
        let twin = common::truth(scene, camera, &clip, &settings);
        let measured = differences(&picture, &twin.picture);
        measured.expect("the same size").psnr
    };
    views.iter().map(view).fold(f64::INFINITY, f64::min)
}

#[test]
fn every_precision_is_within_its_stated_error() {
    let mut headless = common::headless();
    let mut scenes = common::generated_scenes(3_000);
    let generated = scenes.len();
    scenes.extend(common::trained_scenes());
    for (index, (name, scene)) in scenes.into_iter().enumerate() {
        // Trained scenes are large; each is seen from another side.
        let mut views = common::views(&scene, 3, SIZE);
        if index >= generated {
            views = vec![views[index % views.len()]];
        }
        for (what, precision) in choices() {
            let psnr = psnr(&mut headless, &scene, &views, precision);
            println!("{name}, {what}: {psnr:.1} dB");
            let least = precision.least_psnr();
            assert!(
                psnr >= least,
                "{name}, {what}: {psnr:.1} dB, less than {least}"
            );
        }
    }
}

/// Far from the origin, and through a long lens, no float holds the eye, or where a splat is before it, to a pixel.
#[test]
fn a_long_lens_far_from_the_origin_shows_what_the_reference_shows() {
    let mut scene = rara::scene::generate(rara::scene::Kind::General, 2_000, 5);
    let away = DVec3::new(2e4, -3e4, 1e4);
    // Without an origin, as files of single precision have them.
    for position in scene.positions_mut() {
        *position = (position.as_dvec3() + away).as_vec3();
    }
    let near = common::views(&scene, 1, common::scaled(SIZE))[0];
    let middle = Bounds::of(&scene).centre();
    let through = |times: f64| {
        let eye = middle + times * (near.eye - middle);
        near.eye(eye).fx(times * near.fx).fy(times * near.fy)
    };
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let clip = common::clip(&scene, 1, ClipOp::And);
    for settings in [Settings::default(), Settings::default().mode(Mode::None)] {
        for camera in [through(200.0), through(2e3)] {
            common::check(&mut headless, "far away", &scene, &camera, &clip, &settings);
        }
    }
}
