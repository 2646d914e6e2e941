//! Scenes beyond what can be bound as one buffer and beyond what fits in a row of workgroups.

use std::time::Instant;

use crate::common;
use glam::DVec3;
use rara::scene::{Bounds, Kind, generate};
use rara::types::{Gaussian, Splat};
use rara::{Clip, ClipOp, FrameStats, Gaussians, Headless, Plane, Settings};

/// A picture for the reference, which evaluates every splat's pixels in double precision: hundreds of splats meet in
/// each.
const SMALL: (u32, u32) = (253, 190);

fn load(scene: &Gaussians) -> Headless {
    let mut headless = common::headless();
    headless.load(scene).expect("uploads");
    headless
}

fn report(what: &str, headless: &Headless, stats: &FrameStats, begin: Instant) {
    let passes = stats.passes.iter();
    let passes: Vec<_> = passes
        .map(|pass| format!("{} {:.0} ms", pass.name, pass.ms))
        .collect();
    eprintln!(
        "{what}: {:.1} s, {} MiB on the device, {:?}, {}",
        begin.elapsed().as_secs_f64(),
        headless.device_bytes() >> 20,
        stats.counts,
        passes.join(", ")
    );
}

/// Compares a small picture with the reference's.
fn agrees(
    what: &str,
    headless: &mut Headless,
    scene: &Gaussians,
    clip: &Clip,
    settings: &Settings,
) -> FrameStats {
    let begin = Instant::now();
    let camera = common::views(scene, 1, SMALL)[0];
    let stats = common::check(headless, what, scene, &camera, clip, settings);
    report(
        &format!("{what} and the reference"),
        headless,
        &stats,
        begin,
    );
    stats
}

#[test]
fn a_million_gaussians_render_and_agree() {
    let scene = generate(Kind::General, 1_000_000, 3);
    let mut headless = load(&scene);
    let clip = common::clip(&scene, 2, ClipOp::And);
    let settings = Settings::default();

    let begin = Instant::now();
    let camera = common::views(&scene, 1, (1024, 1024))[0];
    let stats = headless.render(&camera, &clip, &settings).expect("renders");
    let picture = headless.picture().expect("reads back");
    let counts = stats.counts;
    let total = counts.visible + counts.cutoff + counts.invisible + counts.culled;
    assert_eq!(total as usize, scene.len());
    assert!(counts.cutoff > 1000 && counts.invisible > 0);
    let values = || picture.pixels.iter().flatten();
    assert!(values().all(|value| value.is_finite()));
    let filled = picture.pixels.iter().filter(|pixel| pixel[3] > 0.9).count();
    assert!(filled > picture.pixels.len() / 20, "{filled} opaque pixels");
    report("a million at 1024 x 1024", &headless, &stats, begin);

    agrees("a million", &mut headless, &scene, &clip, &settings);
}

/// Every Gaussian gets a record in the cutoff buffer, so that all buffers are used to their ends.
#[test]
fn five_million_gaussians_exceed_bindings_and_rows_and_agree() {
    if common::scale() < 1.0 {
        eprintln!("SKIPPED: five million Gaussians on a slow driver");
        return;
    }
    let scene = generate(Kind::Layers, 5_000_000, 3);
    let mut headless = load(&scene);
    let bounds = Bounds::of(&scene);
    let normal = DVec3::new(0.9, 0.3, 0.2).normalize();
    let offset = 0.85 * bounds.radius() - normal.dot(bounds.centre());
    let clip = Clip::of(
        [Plane::new(normal, offset).expect("a proper plane")],
        ClipOp::And,
    );
    let settings = Settings::default().trace_all(true);

    let stats = agrees("five million", &mut headless, &scene, &clip, &settings);

    // The scene really exceeds the limits that this test is for: in every large buffer the least that a device can bind,
    // as lavapipe does, and in every indirect dispatch the least that a row can hold. A record has a header, a plane and
    // the eye.
    let (bound, row) = (128 << 20, 65_535);
    let cutoff = stats.counts.cutoff as usize;
    for size in [
        scene.len() * size_of::<Gaussian>(),
        cutoff * size_of::<Splat>(),
        cutoff * 5 * size_of::<[f32; 4]>(),
    ] {
        assert!(size > bound, "a buffer of {size} bytes can be bound");
    }
    assert!(cutoff.div_ceil(64) > row, "{cutoff} fit in a row");
}
