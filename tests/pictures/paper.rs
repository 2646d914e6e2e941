//! The paper's ablation (Table 2): a plane at infinity must change nothing, and tracing everything must.

use crate::common;
use glam::DVec3;
use rara::gpu::DeviceShape;
use rara::{Camera, Clip, ClipOp, Gaussians, Headless, Miss, Mode, Picture, Plane, Settings};
use rara_lab::measure::differences;

const SIZE: (u32, u32) = (200, 150);

fn far_plane(scene: &Gaussians) -> Clip {
    let bounds = rara::scene::Bounds::of(scene);
    let normal = DVec3::new(0.4, -0.5, 0.7).normalize();
    let offset = 1e6 * bounds.radius() - normal.dot(bounds.centre());
    Clip::of(
        [Plane::new(normal, offset).expect("a proper plane")],
        ClipOp::And,
    )
}

/// Loads a scene; returns a view of it and its picture there.
fn whole(headless: &mut Headless, scene: &Gaussians) -> (Camera, Picture) {
    headless.load(scene).expect("uploads");
    let camera = common::views(scene, 1, common::scaled(SIZE))[0];
    let none = Settings::default().mode(Mode::None);
    let drawn = headless.render(&camera, &Clip::default(), &none);
    drawn.expect("renders");
    (camera, headless.picture().expect("reads back"))
}

/// Trained scenes carry strays far outside their bounds, so that only generated ones are wholly in front of the plane.
#[test]
fn a_plane_at_infinity_gives_the_bytes_of_none_in_every_mode() {
    let mut headless = common::headless();
    for (name, scene) in common::generated_scenes(3_000)
        .into_iter()
        .chain(common::trained_scenes())
    {
        let (camera, plain) = whole(&mut headless, &scene);
        for mode in [Mode::Hard, Mode::Rara, Mode::Exact] {
            let stats = headless
                .render(&camera, &far_plane(&scene), &Settings::default().mode(mode))
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
        let (camera, plain) = whole(&mut headless, &scene);
        // A GPU's compiler may fuse other products and sums in another pipeline.
        let is_cpus = headless.device().shape() == DeviceShape::Cpu;
        let fused = if is_cpus { 0.0 } else { 1e-6 };
        let mut error = |miss, sigma| {
            let settings = Settings::default()
                .mode(Mode::Rara)
                .trace_all(true)
                .miss(miss)
                .sigma(sigma);
            headless
                .render(&camera, &far_plane(&scene), &settings)
                .expect("renders");
            differences(&headless.picture().expect("reads back"), &plain)
                .expect("the same size")
                .l1
        };
        assert!(
            error(Miss::Keep, 1.0) <= fused,
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
