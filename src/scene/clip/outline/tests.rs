use super::*;
use crate::Random;
use crate::clip::placed::tests::shapes;
use crate::clip::{Shape, Solid};

fn cameras(random: &mut Random) -> [Camera; 2] {
    let mut point = || DVec3::from_array([(); 3].map(|()| random.range(-6.0, 6.0)));
    let (eye, target) = (point(), point());
    [
        Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (64, 64)).unwrap(),
        Camera::orthographic(eye, target, DVec3::NEG_Y, 3.0, (64, 64)).unwrap(),
    ]
}

/// True when a ball of this radius around a point has both points that are kept and points that are not.
fn is_on_surface(shape: &Shape, point: DVec3, within: f64, random: &mut Random) -> bool {
    let clip = shape.clip();
    let mut found = [false; 2];
    for _ in 0..2_000 {
        let direction = DVec3::from_array([(); 3].map(|()| random.range(-1.0, 1.0)));
        found[usize::from(clip.keeps(point + within * direction))] = true;
        if found == [true; 2] {
            return true;
        }
    }
    false
}

#[test]
fn the_ends_of_an_outline_lie_on_the_surface() {
    let mut random = Random::new(3);
    for _ in 0..12 {
        let cameras = cameras(&mut random);
        for shape in shapes(&mut random) {
            for camera in &cameras {
                let lines = shape.outline(camera, DVec3::ONE, 2.0);
                assert!(lines.len() >= 6, "{shape}: {} lines", lines.len());
                for point in lines.iter().flatten() {
                    let on = is_on_surface(&shape, *point, 1e-9, &mut random);
                    assert!(on, "{shape}: {point}");
                }
            }
        }
    }
}

#[test]
fn contours_are_where_sides_turn_away_from_the_eye() {
    let mut random = Random::new(4);
    let camera = |eye: DVec3| {
        let towards = eye + DVec3::new(0.1, 0.2, 1.0);
        Camera::look_at(eye, towards, DVec3::NEG_Y, 50.0, (64, 64)).unwrap()
    };
    let flat = |eye: DVec3| camera(eye).projection(Projection::Orthographic);
    let eye = DVec3::new(0.3, -0.4, -5.0);
    for camera in [camera(eye), flat(eye)] {
        for shape in shapes(&mut random) {
            let surfaces = shape.clip().all_surfaces();
            let curved: Vec<_> = surfaces.iter().filter(|s| s.as_plane().is_none()).collect();
            if curved.is_empty() {
                continue;
            }
            // The surface turns away where the line of sight is in its tangent plane.
            let grazes = |point: DVec3| {
                let sight = Sight(&camera).from(point).normalize();
                curved.iter().any(|surface| {
                    let step = |by: f64| surface.distance(point + by * sight);
                    let slope = (step(1e-5) - step(-1e-5)) / 2e-5;
                    surface.distance(point).abs() < 1e-9 && slope.abs() < 1e-6
                })
            };
            let lines = shape.outline(&camera, DVec3::ZERO, 1.0);
            let grazing = lines.iter().filter(|line| line.iter().all(|p| grazes(*p)));
            let least = match shape.solid() {
                Solid::Sphere { .. } | Solid::Ellipsoid { .. } => STRETCHES,
                _ => 2,
            };
            assert!(grazing.count() >= least, "{shape}");
        }
    }
}

#[test]
fn an_eye_within_still_sees_lines_and_all_are_numbers() {
    for text in [
        "sphere:0,0,0,1",
        "ellipsoid:0,0,0,1,2,3",
        "cylinder:0,0,-1,0,0,1,1",
        "capsule:0,0,-1,0,0,1,1",
        "cone:0,0,-1,0,0,1,1",
    ] {
        let shape: Shape = text.parse().unwrap();
        for eye in [DVec3::ZERO, DVec3::new(0.0, 0.0, -1.0), 5.0 * DVec3::Z] {
            let target = eye + DVec3::Z;
            let camera = Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (64, 64)).unwrap();
            for camera in [camera, camera.projection(Projection::Orthographic)] {
                let lines = shape.outline(&camera, DVec3::ZERO, 1.0);
                assert!(lines.len() > STRETCHES, "{text}");
                let finite = lines.iter().flatten().all(|p| p.is_finite());
                assert!(finite, "{text} from {eye}");
            }
        }
    }
}
