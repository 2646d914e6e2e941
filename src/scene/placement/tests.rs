use super::*;
use crate::{Camera, Plane, Projection, Quadric};

fn placement() -> Placement {
    let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.9);
    Placement::new(DVec3::new(4.0, -1.0, 2.5), turn, 0.35).expect("finite numbers")
}

#[test]
fn points_planes_and_views_agree() {
    let placement = placement();
    let plane = Plane::new(DVec3::new(1.0, 2.0, -0.5), 0.7).expect("a normal");
    let eye = DVec3::new(-3.0, -2.0, 9.0);
    let camera = Camera::look_at(eye, DVec3::ONE, DVec3::NEG_Y, 40.0, (90, 60));
    let camera = camera.expect("a view");
    let flat = camera.projection(Projection::Orthographic);
    assert_eq!(flat.in_scene(&placement).fx, camera.fx * placement.scale());
    let (inside, near) = (camera.in_scene(&placement), plane.in_scene(&placement));
    for point in [DVec3::ZERO, DVec3::new(1.5, -0.3, 0.8), DVec3::splat(-2.0)] {
        let world = placement.to_world(point);
        assert!(placement.to_scene(world).distance(point) < 1e-13);
        let distance = plane.distance(world) / placement.scale();
        assert!((near.distance(point) - distance).abs() < 1e-13);
        let (sphere, scale) = (Quadric::sphere(DVec3::ONE, 2.5), placement.scale());
        let sphere = sphere.expect("a radius");
        let distance = sphere.distance(world) / scale;
        assert!((sphere.in_scene(&placement).distance(point) - distance).abs() < 1e-12);
        let seen = camera.world_to_camera().transform_point3(world) / placement.scale();
        assert!(
            inside
                .world_to_camera()
                .transform_point3(point)
                .distance(seen)
                < 1e-12
        );
    }
}

#[test]
fn what_is_no_placement_is_refused() {
    for (position, rotation, scale) in [
        (DVec3::ZERO, DQuat::IDENTITY, 0.0),
        (DVec3::ZERO, DQuat::IDENTITY, -1.0),
        (DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), 1.0),
        (DVec3::NAN, DQuat::IDENTITY, 1.0),
    ] {
        assert!(Placement::new(position, rotation, scale).is_err());
    }
}
