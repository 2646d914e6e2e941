//! The paper's ablation (Table 2): a plane at infinity must change nothing, and tracing everything must.

use crate::common;
use glam::DVec3;
use rara::measure::compare;
use rara::{Clip, ClipOp, Miss, Mode, Plane, Settings};

const SIZE: (u32, u32) = (200, 150);

fn far_plane(scene: &rara::Gaussians) -> Clip {
    let bounds = rara::scene::Bounds::of(scene);
    let normal = DVec3::new(0.4, -0.5, 0.7).normalize();
    let offset = 1e6 * bounds.radius() - normal.dot(bounds.centre());
    Clip::of(
        [Plane::new(normal, offset).expect("a proper plane")],
        ClipOp::And,
    )
}

/// Trained scenes carry strays far outside their bounds, so that only generated ones are wholly in front of the plane.
#[test]
fn a_plane_at_infinity_gives_the_bytes_of_none_in_every_mode() {
    let mut headless = common::headless();
    for (name, scene) in common::generated_scenes(3_000)
        .into_iter()
        .chain(common::trained_scenes())
    {
        headless.load(&scene).expect("uploads");
        let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
        let none = Settings::default().mode(Mode::None);
        headless
            .render(&camera, &Clip::default(), &none)
            .expect("renders");
        let plain = headless.picture().expect("reads back");
        for mode in [Mode::Hard, Mode::Rara, Mode::Exact] {
            let stats = headless
                .render(&camera, &far_plane(&scene), &none.mode(mode))
                .expect("renders");
            assert_eq!(stats.counts.cutoff, 0, "{name}, {mode:?}");
            assert!(
                headless.picture().expect("reads back") == plain,
                "{name}, {mode:?}: not the bytes of none"
            );
        }
    }
}

/// "wo RaRa": with every Gaussian traced, the readings that punish a miss degrade the picture, as the paper reports; the
/// reading of its text (a miss keeps everything) does not.
#[test]
fn tracing_every_gaussian_degrades_the_picture_as_the_paper_reports() {
    let mut headless = common::headless();
    for (name, scene) in common::generated_scenes(3_000).into_iter().take(2) {
        headless.load(&scene).expect("uploads");
        let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
        let none = Settings::default().mode(Mode::None);
        headless
            .render(&camera, &Clip::default(), &none)
            .expect("renders");
        let plain = headless.picture().expect("reads back");
        let mut error = |miss, sigma| {
            let settings = none
                .mode(Mode::Rara)
                .trace_all(true)
                .miss(miss)
                .sigma(sigma);
            headless
                .render(&camera, &far_plane(&scene), &settings)
                .expect("renders");
            compare(&headless.picture().expect("reads back"), &plain)
                .expect("the same size")
                .l1
        };
        assert_eq!(
            error(Miss::Keep, 1.0),
            0.0,
            "{name}: a miss that keeps everything changes nothing"
        );
        assert!(
            error(Miss::Drop, 1.0) > 1.0,
            "{name}: a miss that drops everything must show"
        );
        assert!(
            error(Miss::Drop, 3.0) < error(Miss::Drop, 1.0),
            "{name}: a larger ellipsoid is missed less"
        );
    }
}
