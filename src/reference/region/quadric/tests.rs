use super::*;
use rara_scene::Random;

fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}

fn vector(random: &mut Random) -> Vec3<f64> {
    vec3(normal(random), normal(random), normal(random))
}

/// The least value of a surface's function in a ball, or close to it: by going downhill from many points.
fn least(surface: &UnitSurface<f64>, radius: f64, sign: f64, random: &mut Random) -> f64 {
    let into_ball = |u: Vec3<f64>| match u.length() > radius {
        true => u * (radius / u.length()),
        false => u,
    };
    let mut least = f64::INFINITY;
    for _ in 0..12 {
        let mut point = into_ball(vector(random) * radius);
        let step = 0.4 / (surface.bend.norm() + surface.half_space.normal.length() / radius);
        for _ in 0..60 {
            point = into_ball(point - surface.gradient(point) * (sign * step));
        }
        least = least.min(sign * surface.at(point));
    }
    least
}

#[test]
fn sides_are_conservative_and_tight() {
    let mut random = Random::new(31);
    let (mut cut, mut truly_cut) = (0, 0);
    for round in 0..6_000 {
        // Slopes of 1, and radii from a third of a deviation to hundreds.
        let bend = 1.5 * 0.5_f64.powi(round % 10);
        let squares = match round % 4 {
            0 => vec3(-1.0, -1.0, -1.0),
            1 => vec3(-1.0, -random.unit(), -0.01),
            2 => vec3(-1.0, -random.unit(), 0.0),
            _ => vector(&mut random),
        };
        let slope = vector(&mut random);
        let deviations = 1.0 + 2.3 * random.unit();
        let surface = UnitSurface {
            half_space: HalfSpace {
                normal: slope * (1.0 / slope.length()),
                offset: normal(&mut random) * 1.5 * deviations,
            },
            bend: Symmetric {
                diagonal: squares,
                across: vector(&mut random) * if round % 4 == 2 { 0.0 } else { 0.2 },
            }
            .scaled(bend),
        };
        let sign = if surface.half_space.offset < 0.0 {
            -1.0
        } else {
            1.0
        };
        let crosses = least(&surface, deviations, sign, &mut random) < 0.0;
        match gaussian_side(&surface, deviations) {
            Side::Cutoff => {
                cut += 1;
                truly_cut += u32::from(crosses);
            }
            side => {
                assert!(!crosses, "{side:?} of {surface:?} at {deviations}");
                assert_eq!(side == Side::Visible, sign > 0.0);
            }
        }
    }
    assert!(
        truly_cut > 1_000 && f64::from(cut) < 1.05 * f64::from(truly_cut),
        "{cut} {truly_cut}"
    );
}

/// Its matrix has no full rank, and rounding once made a bound of nothing. A tenth of the ball's surface is inside.
#[test]
fn a_cylinder_that_cuts_a_disc_from_its_side_is_not_beside_it() {
    let mut scene = rara_scene::Gaussians::default();
    let position = glam::Vec3::new(0.217_865_85, -0.212_699_22, 0.132_254_32);
    let scale = glam::Vec3::new(0.046_538_69, 0.081_522_67, 0.004_208_966);
    let turn = glam::Quat::from_xyzw(0.208_751_35, -0.504_046_74, 0.813_969_3, -0.199_534_07);
    scene.push(position, scale, turn, 0.919_330_36, &[0.0; 3]);
    let (from, to) = (DVec3::new(-0.4, -0.3, 0.0), DVec3::new(0.5, 0.4, 0.2));
    let quadric = Quadric::cylinder(from, to, 0.3).unwrap();
    let axes = crate::footprint::half_axes::<f64>(scene.scales()[0], scene.rotations()[0]);
    let surface = quadric.unit_surface(&Ellipsoid::new(&scene, 0, axes));
    let deviations = (2.0 * (255.0 * 0.919_330_36_f64).ln()).sqrt();
    assert_eq!(gaussian_side(&surface, deviations), Side::Cutoff);
}

#[test]
fn boxes_have_a_side_only_where_their_points_do() {
    let mut random = Random::new(7);
    let mut settled = 0;
    for _ in 0..2_000 {
        let v = |random: &mut Random| DVec3::from_array([(); 3].map(|()| normal(random)));
        let (from, to) = (v(&mut random), v(&mut random));
        let quadric = match random.unit() {
            x if x < 0.5 => Quadric::sphere(from, 0.5 + random.unit()),
            x if x < 0.8 => Quadric::cylinder(from, to, 0.5 + random.unit()),
            _ => Quadric::cone(from, to, 0.5 + random.unit()),
        };
        let quadric = quadric.unwrap();
        let (middle, half) = (v(&mut random), v(&mut random).abs() * 0.3);
        let side = quadric.box_side(middle, half, 0.05);
        settled += u32::from(side != Side::Cutoff);
        for _ in 0..50 {
            let at = DVec3::from_array([(); 3].map(|()| 2.0 * random.unit() - 1.0));
            let value = quadric.distance(middle + at * (half + 0.028));
            assert!(side != Side::Visible || value > 0.0);
            assert!(side != Side::Invisible || value < 0.0);
        }
    }
    assert!(settled > 500, "{settled}: boxes would be of no use");
}
