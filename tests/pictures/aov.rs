//! What a headless renderer says of a pixel beside its colour.

use crate::common;
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Mode, Raster, Settings, Show, reference};

#[test]
fn headless_expected_depths_are_the_references() {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 3, common::scaled((160, 120)))[1];
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    for (mode, planes) in [(Mode::None, 0), (Mode::Exact, 1), (Mode::Hard, 1)] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let settings = Settings::default().mode(mode);
        headless.render(&camera, &clip, &settings).expect("renders");
        let before = headless.picture().expect("reads back");
        let depths = headless.expected_depth(&camera, &clip, &settings);
        let depths = depths.expect("draws depths");
        let truth = reference::depth::expected::<f64>(&scene, &camera, &clip, &settings);
        assert_eq!(depths.len(), truth.len());
        let mut errors: Vec<f64> = depths
            .iter()
            .zip(&truth)
            .filter(|(_, truth)| truth[1] > 0.02)
            .map(|(ours, truth)| (f64::from(*ours) / (truth[0] / truth[1]) - 1.0).abs())
            .collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors.len() > 1_000, "{} pixels", errors.len());
        // As a host's depths are held to the reference: a splat at its threshold is in a pixel or is not.
        let (most, worst) = (errors[errors.len() * 998 / 1000], errors[errors.len() - 1]);
        assert!(
            most < 2e-4 && worst < 0.02,
            "{mode:?}: {most:.1e}, {worst:.1e}"
        );
        // What a picture shows is no matter, also where that is made by tiles alone.
        for show in [Show::Weight, Show::Count, Show::Mean] {
            let again = headless.expected_depth(&camera, &clip, &settings.show(show));
            assert!(again.expect("draws depths") == depths, "{show:?}");
        }
        // The picture stays.
        assert_eq!(headless.picture().expect("reads back"), before);
        headless.render(&camera, &clip, &settings).expect("renders");
        assert_eq!(headless.picture().expect("reads back"), before);
    }
    let tiles = Settings::default().raster(Raster::Tiles);
    let nothing = common::clip(&scene, 1, ClipOp::And);
    let away = common::moved(nothing, -1e6);
    let depths = headless.expected_depth(&camera, &away, &tiles);
    assert!(
        depths
            .expect("draws nothing")
            .iter()
            .all(|depth| *depth == 0.0)
    );
    headless.close().expect("nothing to validate");
}

#[test]
fn depths_need_a_scene() {
    let camera = Camera::look_at(
        glam::DVec3::Z,
        glam::DVec3::ZERO,
        -glam::DVec3::Y,
        40.0,
        (8, 8),
    );
    let error = common::headless()
        .expected_depth(
            &camera.expect("a view"),
            &Clip::default(),
            &Settings::default(),
        )
        .expect_err("there is no scene");
    assert!(error.to_string().contains("load one first"), "{error}");
}
