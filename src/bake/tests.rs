//! The moments against quadratures of their definitions, and what becomes of Gaussians.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::child::Part;
use super::half_line::HalfLine;
use super::rays::Rays;
use super::*;
use rara_reference::{Side, clip};
use rara_scene::clip::{ClipOp, Plane, Shape};
use rara_scene::placement::Placement;
use rara_scene::{Kind, LayerState, Random, generate};

/// The largest difference of a number of two parts.
fn apart(a: &Part, b: &Part) -> f64 {
    let cells = (a.covariance - b.covariance).to_cols_array();
    let largest = cells.into_iter().map(f64::abs).fold(0.0, f64::max);
    largest
        .max((a.mass - b.mass).abs())
        .max((a.mean - b.mean).abs().max_element())
}

/// The moments of the kept part, summed over a grid of points: slow, and nothing but the definition.
fn summed(kept: impl Fn(DVec3) -> bool) -> Part {
    const HALF: i32 = 60;
    let at = |i: i32| f64::from(i) * 0.1 + 0.05;
    let (mut total, mut mass, mut mean, mut second) = (0.0, 0.0, DVec3::ZERO, DMat3::ZERO);
    for i in -HALF..HALF {
        for j in -HALF..HALF {
            for k in -HALF..HALF {
                let u = DVec3::new(at(i), at(j), at(k));
                let weight = (-0.5 * u.length_squared()).exp();
                total += weight;
                if kept(u) {
                    mass += weight;
                    mean += u * weight;
                    second += DMat3::from_cols(u * u.x, u * u.y, u * u.z) * weight;
                }
            }
        }
    }
    let mean = mean / mass;
    Part {
        mass: mass / total,
        mean,
        covariance: second * (1.0 / mass)
            - DMat3::from_cols(mean * mean.x, mean * mean.y, mean * mean.z),
    }
}

#[test]
fn one_planes_moments_are_those_of_the_definition() {
    // The planes lie between two layers of the grid, where the sum is the midpoint rule.
    for (beta, normal) in [
        (-2.0, DVec3::X),
        (0.0, -DVec3::Y),
        (0.7, DVec3::Z),
        (2.5, DVec3::X),
    ] {
        let closed = HalfLine::new(normal, beta).parts(1)[0];
        let expected = summed(|u| u.dot(normal) >= beta);
        // The rule's own error: a 24th of the square of the spacing times the density's slope, twice over.
        let error = closed.mass * apart(&closed, &expected);
        assert!(error < 5e-4, "{beta}: {closed:?}, {expected:?}");
    }
    // The values of the text books at zero.
    let half = HalfLine::new(DVec3::X, 0.0).parts(1)[0];
    assert!((half.mean.x - (2.0 / std::f64::consts::PI).sqrt()).abs() < 1e-15);
    assert!((half.covariance.x_axis.x - (1.0 - 2.0 / std::f64::consts::PI)).abs() < 1e-15);
}

#[test]
fn the_quadrature_along_rays_agrees_with_the_closed_form() {
    let mut random = Random::new(5);
    let mut worst = 0.0_f64;
    for _ in 0..300 {
        let normal = random.direction();
        let beta = random.range(-3.0, 2.0);
        let closed = HalfLine::new(normal, beta).parts(1)[0];
        let rays = Rays::through(|u| u.dot(normal) >= beta).parts(1)[0];
        // What is wrong with a part shows in as far as there is such a part.
        worst = worst.max(closed.mass * apart(&closed, &rays));
    }
    // A cap of the sphere has a ray or two too many or too few of 1024, and a second moment of 3 along each.
    assert!(worst < 8e-3, "{worst}");
}

#[test]
fn the_quadrature_serves_regions_of_several_surfaces() {
    type Region = fn(DVec3) -> bool;
    let regions: [Region; 4] = [
        |u| u.x >= 0.2 && u.y <= 0.4 && u.z >= -0.6,
        |u| u.x >= 0.2 || u.y <= -0.4,
        |u| (u - DVec3::new(0.5, 0.3, 0.0)).length() <= 1.3,
        |u| u.x.abs() >= 0.5,
    ];
    for (number, region) in regions.into_iter().enumerate() {
        let (rays, expected) = (Rays::through(region).parts(1)[0], summed(region));
        // Rays and sum are each as far off, the sum because its points are 0.1 apart.
        let error = expected.mass * apart(&rays, &expected);
        println!("{number} {error}");
        assert!(error < 4e-3, "{number}: {error}, {rays:?}, {expected:?}");
    }
}

#[test]
fn parts_add_up_to_the_whole() {
    let rays = Rays::through(|u| u.x >= -0.3 && u.y >= 0.1);
    for count in [2, 3] {
        let line = HalfLine::new(DVec3::Z, 0.4);
        for (parts, whole) in [
            (line.parts(count), line.parts(1)[0]),
            (rays.parts(count), rays.parts(1)[0]),
        ] {
            assert_eq!(parts.len(), count);
            let share = whole.mass / count as f64;
            assert!(
                parts.iter().all(|p| (p.mass - share).abs() < 1e-5),
                "{parts:?}"
            );
            let mean = parts.iter().map(|p| p.mean * p.mass).sum::<DVec3>() / whole.mass;
            assert!(mean.distance(whole.mean) < 1e-9);
        }
    }
}

#[test]
fn regions_that_keep_all_or_nothing_have_their_moments() {
    let all = Rays::through(|_| true).parts(1)[0];
    let normal = Part {
        mass: 1.0,
        mean: DVec3::ZERO,
        covariance: DMat3::IDENTITY,
    };
    // The lattice's own second moment, of which a child would be as little off.
    assert!(apart(&all, &normal) < 2e-3, "{all:?}");
    for count in 1..=3 {
        let none = Rays::through(|_| false).parts(count);
        assert!(none.iter().all(|part| *part == Part::default()));
    }
}

fn plane(normal: DVec3, offset: f64) -> Clip {
    Clip::of([Plane::new(normal, offset).expect("a normal")], ClipOp::And)
}

fn shaped(texts: &[&str], op: ClipOp) -> Clip {
    let shapes: Vec<Shape> = texts.iter().map(|t| t.parse().expect("a shape")).collect();
    Clip::of_shapes(&shapes, op)
}

fn baked(gaussians: &Gaussians, clip: &Clip) -> BakedGaussians {
    bake(gaussians, clip, &BakeSettings::default()).expect("it can be baked")
}

#[test]
fn counts_are_those_of_stage_clip_and_what_is_whole_stays_to_the_bit() {
    let scene = generate(Kind::General, 4000, 3);
    for clip in [
        plane(DVec3::new(1.0, 0.5, -0.2), 0.1),
        shaped(&["box:0,0,0,1,0.7,0.9,0.9,0.1,0.3,0.2"], ClipOp::And),
        shaped(&["!box:0,0,0,1,0.7,0.9,0.9,0.1,0.3,0.2"], ClipOp::Or),
    ] {
        for mode in [Mode::None, Mode::Hard, Mode::Rara, Mode::Exact] {
            let settings = BakeSettings::default().mode(mode);
            let baked = bake(&scene, &clip, &settings).expect("it can be baked");
            let sides = clip::clip::<f64>(&scene, &clip, &Settings::default().mode(mode));
            let count = |side| sides.iter().filter(|s| **s == side).count() as u64;
            let counts = baked.counts;
            assert_eq!(counts.visible, count(Side::Visible), "{mode:?}");
            assert_eq!(counts.cutoff, count(Side::Cutoff), "{mode:?}");
            assert_eq!(counts.invisible, count(Side::Invisible), "{mode:?}");
            let written = counts.visible + counts.left + counts.children;
            assert_eq!(written, baked.gaussians.len() as u64);
            assert_eq!(counts.cutoff, counts.left + counts.faint + counts.children);
            assert!(baked.sources.is_sorted());
            for (index, &source) in baked.sources.iter().enumerate() {
                let source = source as usize;
                assert_eq!(baked.gaussians.sh_of(index), scene.sh_of(source));
                if sides[source] == Side::Visible {
                    let (child, whole) = (
                        Child::whole(&baked.gaussians, index),
                        Child::whole(&scene, source),
                    );
                    assert_eq!(child, whole);
                }
                assert_ne!(sides[source], Side::Invisible);
            }
        }
    }
}

#[test]
fn a_child_has_the_mean_and_the_covariance_of_what_is_left() {
    let mut scene = Gaussians::default();
    let turn = Quat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize();
    let scale = Vec3::new(2.0, 0.5, 0.01);
    scene.push(Vec3::new(1.0, 2.0, 3.0), scale, turn, 0.9, &[0.25; 3]);
    let normal = DVec3::new(0.4, -0.7, 0.2).normalize();
    let child = baked(
        &scene,
        &plane(normal, -normal.dot(DVec3::new(1.0, 2.0, 3.0))),
    )
    .gaussians;
    let axes = DMat3::from_quat(turn.as_dquat()) * DMat3::from_diagonal(scale.as_dvec3());
    let covariance = axes * axes.transpose();
    let (vn, h) = (
        covariance * normal,
        (normal.dot(covariance * normal)).sqrt(),
    );
    let mean = DVec3::new(1.0, 2.0, 3.0) + vn / h * (2.0 / std::f64::consts::PI).sqrt();
    assert!(child.positions()[0].as_dvec3().distance(mean) < 1e-6);
    let less =
        DMat3::from_cols(vn * vn.x, vn * vn.y, vn * vn.z) * (2.0 / std::f64::consts::PI / (h * h));
    let axes = DMat3::from_quat(child.rotations()[0].as_dquat())
        * DMat3::from_diagonal(child.scales()[0].as_dvec3());
    let error = (axes * axes.transpose() - (covariance - less)).to_cols_array();
    assert!(error.iter().all(|e| e.abs() < 2e-6), "{error:?}");
    // Half of the mass, with a deviation of 0.603.
    let left = (1.0 - 2.0 / std::f64::consts::PI).sqrt();
    let opacity = f64::from(child.opacities()[0]);
    assert!(
        (opacity - 0.9 * 0.5 / left.sqrt()).abs() < 1e-6,
        "{opacity}"
    );
    // The thin axis is as thin as before, to the last digits, although its square is a 40000th of the longest one's.
    let volume = child.scales()[0].as_dvec3();
    let expected = scale.as_dvec3().element_product() * left;
    assert!((volume.element_product() / expected - 1.0).abs() < 1e-6);
}

#[test]
fn baking_a_convex_clip_twice_is_baking_it_once() {
    for kind in [Kind::General, Kind::Strands, Kind::Layers] {
        let scene = generate(kind, 3000, 9);
        for clip in [
            plane(DVec3::new(-0.3, 0.5, 1.0), 0.05),
            shaped(&["box:0,0,0,0.8,0.6,0.7,0.9,0.1,0.3,0.2"], ClipOp::And),
        ] {
            for children in 1..=3 {
                let settings = BakeSettings::default().children(children);
                let once = bake(&scene, &clip, &settings).expect("it can be baked");
                assert!(once.counts.children > 0);
                let twice = bake(&once.gaussians, &clip, &settings).expect("it can be baked");
                if children == 1 {
                    assert_eq!(twice.gaussians, once.gaussians, "{kind:?}");
                }
            }
        }
    }
}

#[test]
fn scenes_wholly_inside_stay_and_wholly_outside_go() {
    let scene = generate(Kind::General, 500, 4);
    let inside = baked(&scene, &plane(DVec3::X, 1e6));
    assert_eq!((&inside.gaussians, inside.counts.visible), (&scene, 500));
    let outside = baked(&scene, &plane(DVec3::X, -1e6));
    assert!(outside.gaussians.is_empty() && outside.counts.invisible == 500);
    assert_eq!(outside.gaussians.sh_degree(), scene.sh_degree());
    assert_eq!(baked(&scene, &Clip::default()).gaussians, scene);
    assert_eq!(
        baked(&outside.gaussians, &plane(DVec3::X, 0.0)).counts,
        BakeCounts::default()
    );
}

#[test]
fn layers_are_baked_where_they_stand_and_by_their_own_clip() {
    let scene = generate(Kind::General, 1500, 6);
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9);
    let placement = Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("finite");
    let clip = plane(DVec3::new(0.2, 1.0, 0.1), -0.05);
    let layer = Layer::new("one", &scene).with(LayerState::default().placement(placement));
    let settings = BakeSettings::default();
    let placed = bake_layer(&layer, &clip, &settings).expect("it can be baked");
    assert_eq!(placed, baked(&scene, &clip.in_scene(&placement)));
    assert!(placed.counts.cutoff > 0 && placed.counts.invisible > 0);
    let own = layer.clone().clipped(Clip::default());
    let whole = bake_layer(&own, &clip, &settings).expect("it can be baked");
    assert_eq!(whole.gaussians, scene);
    // What a faded layer no longer shows is not cut.
    let faded = LayerState::default().placement(placement).opacity(0.1);
    let faded = bake_layer(&layer.with(faded), &clip, &settings).expect("it can be baked");
    assert!(faded.counts.cutoff < placed.counts.cutoff);
}

#[test]
fn whatever_is_cut_the_children_can_be_drawn() {
    let mut random = Random::new(77);
    let mut scene = Gaussians::default();
    for _ in 0..3000 {
        let long = 10.0_f64.powf(random.range(-6.0, 4.0));
        let mut thin = || (long * 10.0_f64.powf(random.range(-4.0, 0.0))) as f32;
        let scale = Vec3::new(thin(), long as f32, thin());
        let turn = random
            .direction()
            .extend(random.normal(0.0, 1.0))
            .normalize();
        let near = random.direction() * long * random.range(0.0, 3.0);
        let opacity = [0.004, 0.02, 0.5, 0.99, 1.0][random.range(0.0, 5.0) as usize];
        let turn = DQuat::from_vec4(turn).as_quat();
        scene.push(near.as_vec3(), scale, turn, opacity, &[0.5; 3]);
    }
    // Flat ones, points, and the largest that there are.
    for scale in [
        Vec3::ZERO,
        Vec3::X,
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::splat(3e38),
        Vec3::splat(1e-40),
    ] {
        scene.push(Vec3::ZERO, scale, Quat::IDENTITY, 1.0, &[0.5; 3]);
    }
    for clip in [
        plane(DVec3::new(0.3, 0.8, -0.4), 1e-9),
        shaped(&["box:0,0,0,0.1,2,0.01"], ClipOp::And),
        shaped(&["!box:0,0,0,0.1,2,0.01"], ClipOp::Or),
    ] {
        for children in 1..=3 {
            let settings = BakeSettings::default().children(children);
            let baked = bake(&scene, &clip, &settings).expect("it can be baked");
            assert!(baked.counts.children > 200, "{:?}", baked.counts);
            // This refuses all that is not finite, no unit quaternion or no opacity.
            Gaussians::new(baked.gaussians.into_arrays()).expect("they can be drawn");
        }
    }
}

#[test]
fn a_union_is_asked_point_by_point() {
    let union = shaped(&["plane:1,0,0,0", "plane:0,1,0,0"], ClipOp::Or);
    assert!(union.keeps(DVec3::X) && union.keeps(DVec3::Y - DVec3::X));
    assert!(!union.keeps(-DVec3::ONE) && Clip::default().keeps(DVec3::ZERO));
    // Of a round Gaussian in the edge three quarters are kept.
    let mut scene = Gaussians::default();
    scene.push(Vec3::ZERO, Vec3::ONE, Quat::IDENTITY, 0.8, &[0.0; 3]);
    let child = baked(&scene, &union).gaussians;
    assert_eq!(child.len(), 1);
    let centre = child.positions()[0];
    // Its mean is minus a third of that of the quarter that is missing, sqrt(2 / pi) along both axes.
    let expected = (2.0 / std::f32::consts::PI).sqrt() / 3.0;
    assert!(
        (centre - Vec3::new(expected, expected, 0.0))
            .abs()
            .max_element()
            < 5e-3,
        "{centre}"
    );
}

#[test]
fn settings_that_make_no_sense_are_refused() {
    let (scene, clip) = (Gaussians::default(), Clip::default());
    for (settings, says) in [
        (BakeSettings::default().children(0), "1 to 3"),
        (BakeSettings::default().children(4), "4 children"),
        (BakeSettings::default().sigma(0.0), "above zero"),
        (BakeSettings::default().sigma(f32::NAN), "above zero"),
        (BakeSettings::default().leave(-0.5), "zero or more"),
        (BakeSettings::default().leave(f32::NAN), "zero or more"),
    ] {
        let error = bake(&scene, &clip, &settings).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

/// Parts that would show nowhere, as their layer fades, are dropped and counted, and no others.
#[test]
fn parts_that_are_too_faint_for_their_layer_are_dropped_and_counted() {
    let mut scene = generate(Kind::General, 3000, 6);
    for (index, opacity) in scene.opacities_mut().iter_mut().enumerate() {
        *opacity *= 0.02 * (index % 50) as f32;
    }
    let clip = plane(DVec3::new(1.0, 0.5, -0.2), 0.1);
    // None stays whole, so that the child of each opaque one shows the factor of its opacity.
    let settings = BakeSettings::default().leave(10.0);
    let mut opaque = scene.clone();
    opaque.opacities_mut().fill(1.0);
    let opaque = bake(&opaque, &clip, &settings).expect("it can be baked");
    for fade in [1.0, 0.5, 0.05] {
        let state = LayerState::default().opacity(fade);
        let layer = Layer::new("faded", &scene).with(state);
        let baked = bake_layer(&layer, &clip, &settings).expect("it can be baked");
        let mut faded = scene.clone();
        faded
            .opacities_mut()
            .iter_mut()
            .for_each(|own| *own *= fade);
        let sides = clip::clip::<f64>(&faded, &clip, &Settings::default());
        let is_kept = |&index: &u32| match sides[index as usize] {
            Side::Cutoff => {
                let child = opaque.sources.binary_search(&index);
                let factor = child.map_or(0.0, |child| opaque.gaussians.opacities()[child]);
                scene.opacities()[index as usize] * factor * fade * 255.0 >= 1.0
            }
            side => side != Side::Invisible,
        };
        let kept: Vec<u32> = (0..scene.len() as u32).filter(is_kept).collect();
        assert_eq!(baked.sources, kept, "{fade}");
        let dropped = baked.counts.visible + baked.counts.cutoff - kept.len() as u64;
        assert_eq!(baked.counts.faint, dropped, "{fade}");
        assert!(
            dropped > 10 && baked.counts.children > 100,
            "{:?}",
            baked.counts
        );
    }
}
