use super::*;
use glam::{DVec3, Quat, Vec3Swizzles};
use rara_reference::{Footprint, ViewTransform};
use rara_scene::{Camera, GaussianArrays};

fn scene(count: usize) -> Gaussians {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let arrays = GaussianArrays {
        origin: DVec3::ZERO,
        positions: (0..count)
            .map(|_| Vec3::new(next(), next(), next()))
            .collect(),
        scales: (0..count)
            .map(|_| Vec3::splat(0.1 * next().powi(8)))
            .collect(),
        rotations: vec![Quat::IDENTITY; count],
        opacities: (0..count).map(|_| next()).collect(),
        sh_degree: 0,
        sh: vec![0.0; 3 * count],
        training: Training::default(),
    };
    Gaussians::new(arrays).expect("arrays that fit")
}

#[test]
fn an_order_holds_every_gaussian_once() {
    let mut order = order(&scene(5000));
    assert!(!order.is_sorted());
    order.sort_unstable();
    assert!(order.iter().copied().eq(0..5000));
}

#[test]
fn bounds_hold_every_gaussian_and_are_small() {
    let scene = scene(100_000);
    let order = order(&scene);
    let blocks = blocks(&scene, &order);
    let mut volume = 0.0;
    for (block, numbers) in blocks.iter().zip(order.chunks(limits::BLOCK_SIZE as usize)) {
        let [low @ .., reach] = block.low_reach;
        let [high @ .., sigma] = block.high_sigma;
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        for index in numbers.iter().map(|&n| n as usize) {
            if scene.opacities()[index] < limits::ALPHA_MIN {
                assert!(sigma < 0.0, "not all of them span a pixel");
                continue;
            }
            let (x, s) = (scene.positions()[index], scene.scales()[index].x);
            assert!(low.cmple(x).all() && x.cmple(high).all());
            let extent = (2.0 * (255.0 * scene.opacities()[index]).ln()).sqrt();
            assert!(s <= sigma.abs() && s * extent <= reach);
        }
        volume += f64::from((high - low).max(Vec3::ZERO).element_product());
    }
    // Each kind covers the cube once; without a curve every block would be as large as the cube.
    assert!(volume < 20.0, "{volume} times the scene's volume");
}

#[test]
fn one_that_is_no_number_leaves_its_block_undecided_and_bounded() {
    let mut scene = scene(10);
    scene.positions_mut()[3].y = f32::NAN;
    let block = blocks(&scene, &order(&scene))[0];
    assert_eq!(block.low_reach[3], f32::INFINITY);
    assert!(block.high_sigma[3] < 0.0);
    assert!(block.low_reach[..3].iter().all(|x| x.is_finite()));
}

#[test]
fn faint_ones_are_a_block_that_nothing_sees() {
    let mut scene = scene(10);
    scene.opacities_mut().fill(0.001);
    assert!(blocks(&scene, &order(&scene))[0].low_reach[3] < 0.0);
}

/// From the scale on, no direction of sight makes a splat too faint; a tenth below, some do.
#[test]
fn antialiased_splats_span_a_pixel_from_a_scale_on() {
    let mut scene = scene(500);
    let count = scene.len();
    let mut state = 7_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let centre = DVec3::new(0.25, 0.5, -0.125);
    for index in 0..count {
        scene.positions_mut()[index] = centre.as_vec3();
        scene.scales_mut()[index] = Vec3::from_array([0; 3].map(|_| 0.1 * next().powi(4)));
        scene.opacities_mut()[index] = 0.01 + 0.99 * next();
    }
    let mut fainter = 0;
    for index in 0..count {
        let low_pass = [0.3, 0.1, 2.0][index % 3];
        let training = Training::default().antialiased(true).low_pass(low_pass);
        scene.set_training(training).expect("can be drawn");
        let scale = f64::from(Splat::of(&scene, index as u32).spanning_scale());
        for (axis, share) in [0, 1, 2]
            .into_iter()
            .flat_map(|axis| [(axis, 1.0), (axis, 0.9)])
        {
            let way = [DVec3::X, DVec3::Y, DVec3::Z][axis];
            let camera = Camera::look_at(centre - way, centre, way.zxy(), 40.0, (64, 64));
            let camera = camera.expect("a view").fx(share * scale).fy(share * scale);
            let view = ViewTransform::<f64>::new(&camera);
            let opacity = Footprint::new(&scene, index, &view).map_or(0.0, |f| f.opacity);
            let spans = opacity >= f64::from(opacity_spanning(scene.training()));
            assert!(
                spans || share < 1.0,
                "{index}: {opacity} at {scale} px a unit"
            );
            fainter += u32::from(!spans);
        }
    }
    assert!(fainter > 300, "{fainter}: less would do");
}

#[test]
fn bits_of_a_place_alternate() {
    assert_eq!(morton(0x3ff, 0, 0), 0x0924_9249);
    assert_eq!(morton(0, 1, 0), 2);
    assert_eq!(morton(0, 0, 2), 32);
    assert_eq!(morton(0x3ff, 0x3ff, 0x3ff), 0x3fff_ffff);
}
