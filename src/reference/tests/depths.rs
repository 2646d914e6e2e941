//! Mean depths of truncated splats by brute numerical integration.

use glam::DVec2;

use super::*;
use crate::depth::SplatDepth;
use crate::exact::AffinePlane;
use crate::quadrature::PixelRays;

/// Random splats, planes and a pixel within a footprint: how far the mean depth is from the integrated one, in deviations of
/// the splat's depth, at worst, and by how much the planes move it.
fn errors(sigma: f64, op: ClipOp, planes: usize, slab: bool) -> (f64, f64) {
    errors_in(&camera(64, 64, 100.0), sigma, (op, planes, slab))
}

/// The same in any view that shows what is three to six units deep.
fn errors_in(view: &Camera, sigma: f64, (op, planes, slab): (ClipOp, usize, bool)) -> (f64, f64) {
    let mut dice = Dice(23);
    let (mut worst, mut moved) = (0.0_f64, 0.0_f64);
    for _ in 0..60 {
        let one = dice.one(sigma, 8.0);
        let normal = dice.direction();
        let cutters: Vec<_> = (0..planes)
            .map(|i| {
                let turned = if slab && i == 1 {
                    -normal
                } else if slab {
                    normal
                } else {
                    dice.direction()
                };
                plane_through(&one, turned, dice.between(-0.5, 1.5))
            })
            .collect();
        let clip = clip(op, &cutters);
        let settings = mode(Mode::Exact).trace_all(true);
        let scene = scene(&[one]);
        let footprint =
            Footprint::<f64>::new(&scene, 0, &ViewTransform::new(view)).expect("in view");
        let depth = SplatDepth::new(&scene, 0, &footprint, &clip, &settings);
        let whole = SplatDepth::new(&scene, 0, &footprint, &NO_CLIP, &settings);
        let [k0, k1, k2] = footprint.conic;
        // A point within two deviations of the footprint.
        let (u, v) = (dice.between(-1.4, 1.4), dice.between(-1.4, 1.4));
        let dx = u / k0;
        let dy = (v - k1 * dx) / k2;
        let cut = cutoff::cutoff(
            &scene,
            0,
            &footprint,
            &ViewTransform::new(view),
            &clip,
            &settings,
        );
        let cut = cut.expect("traced");
        // A plane counts as absent that is eight deviations away where the splat's centre is seen, even if it is so steep
        // that it cuts elsewhere: one along the line of sight through a splat of many pixels.
        let is_absent = |plane: &AffinePlane<f64>| plane.z[0] > 8.0;
        let has_absent =
            matches!(&cut, SplatCut::Affine { planes, .. } if planes.iter().any(is_absent));
        if has_absent || cut.weight(dx, dy) < 1e-3 {
            continue;
        }
        let at = DVec2::new(
            footprint.screen_centre[0] + dx,
            footprint.screen_centre[1] + dy,
        );
        let rays = PixelRays::parallel(view, &clip, at, 200);
        let truth = rays.mean_depth(&scene, 0);
        let deviation = footprint.rows[2].length();
        worst = worst.max((depth.mean(dx, dy) - truth).abs() / deviation);
        moved = moved.max((depth.mean(dx, dy) - whole.mean(dx, dy)).abs() / deviation);
    }
    (worst, moved)
}

#[test]
fn one_plane_moves_the_mean_depth_as_integration_says() {
    // The rest grows with the splat: the form is of first order in sigma over depth.
    for (sigma, most) in [(0.0002, 0.001), (0.002, 0.005), (0.02, 0.015), (0.1, 0.1)] {
        let (worst, moved) = errors(sigma, ClipOp::And, 1, false);
        assert!(worst < most && moved > 0.5, "{sigma}: {worst}");
    }
}

/// Where lines of sight are parallel nothing is of first order only, for splats of a fortieth of a pixel to two pictures.
#[test]
fn orthographic_mean_depths_are_the_integral_for_splats_of_every_size() {
    let view = camera(64, 64, 12.0).projection(Projection::Orthographic);
    for sigma in [0.002, 0.02, 0.1, 1.0, 10.0] {
        for (planes, slab) in [(1, false), (2, true)] {
            let (worst, moved) = errors_in(&view, sigma, (ClipOp::And, planes, slab));
            assert!(
                worst < 2e-3 && moved > 0.5,
                "{sigma}, {planes}: {worst}, {moved}"
            );
        }
    }
}

#[test]
fn slabs_and_what_they_leave_out_move_it_likewise() {
    for (op, least) in [(ClipOp::And, 0.5), (ClipOp::Or, 0.1)] {
        for (sigma, most) in [(0.02, 0.02), (0.1, 0.05)] {
            let (worst, moved) = errors(sigma, op, 2, true);
            assert!(worst < most && moved > least, "{op:?} {sigma}: {worst}");
        }
    }
}

/// Of planes that keep the same side only the strictest at the centre counts.
#[test]
fn several_oblique_planes_move_it_about_as_far() {
    for op in [ClipOp::And, ClipOp::Or] {
        let (worst, _) = errors(0.05, op, 2, false);
        assert!(worst < 1.5, "{op:?}: {worst}");
    }
}
