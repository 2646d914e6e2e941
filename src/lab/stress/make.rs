//! How cases are made: splats strewn over a surface so that it cuts all of them, apart from each other or in a crowd.

use glam::{DMat3, DQuat, DVec3, Quat};

use super::Case;
use rara::{Camera, Clip, ClipOp, Gaussians, Plane, Projection};
use rara_reference::{Footprint, ViewTransform};
use rara_scene::Random;

/// The viewing geometry of a case.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setup {
    /// The point that the camera looks at, world units.
    pub(super) centre: DVec3,
    /// How far it stands from there.
    pub(super) distance: f64,
    pub(super) projection: Projection,
    /// Focal length of the view in perspective, px; an orthographic one shows the plane through the centre at the same scale.
    pub(super) focal: f64,
    /// Picture size, px.
    pub(super) size: (u32, u32),
}

/// A view of 36 degrees from five units away.
pub(super) const PLAIN: Setup = Setup {
    centre: DVec3::ZERO,
    distance: 5.0,
    projection: Projection::Perspective,
    focal: 300.0,
    size: (192, 192),
};

impl Setup {
    pub(super) fn camera(&self, random: &mut Random) -> Camera {
        let eye = self.centre - random.direction() * self.distance;
        let fov = 2.0 * (f64::from(self.size.1) / 2.0 / self.focal).atan();
        let up = random.direction();
        let camera = Camera::look_at(eye, self.centre, up, fov.to_degrees(), self.size)
            .expect("two random directions are not parallel");
        match self.projection {
            Projection::Perspective => camera,
            _ => {
                let scale = self.focal / self.distance;
                camera.projection(self.projection).fx(scale).fy(scale)
            }
        }
    }

    /// Radius of the picture at that distance, world units.
    pub(super) fn radius(&self) -> f64 {
        0.6 * f64::from(self.size.0.max(self.size.1)) * self.distance / self.focal
    }
}

/// The camera's right, down and forward axes in the world.
pub(super) fn axes(camera: &Camera) -> DMat3 {
    camera.rotation.transpose()
}

/// Standard deviations of a splat, given the world size of a pixel where it stands.
pub(super) type Deviations<'a> = &'a dyn Fn(&mut Random, f64) -> DVec3;
/// The normal of the plane through the centre of the setup.
pub(super) type Normal<'a> = &'a dyn Fn(&mut Random, &Camera) -> DVec3;

/// A normal that has nothing to do with the view.
pub(super) fn any_normal(random: &mut Random, _: &Camera) -> DVec3 {
    random.direction()
}

/// A number from `low` to `high`, every factor as likely as the next.
pub(super) fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.unit())
}

/// Three such numbers.
pub(super) fn three_between(random: &mut Random, low: f64, high: f64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| between(random, low, high)))
}

/// An orientation, every one as likely.
pub(super) fn orientation(random: &mut Random) -> Quat {
    let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, std::f64::consts::TAU));
    (turn * DQuat::from_rotation_arc(DVec3::Z, random.direction()))
        .normalize()
        .as_quat()
}

/// Four cases of single splats and one crowd: what a regime of one plane consists of.
pub(super) fn cases(
    seed: u64,
    stage: Setup,
    normal: Normal<'_>,
    shape: Deviations<'_>,
) -> Vec<Case> {
    let mut random = Random::new(seed);
    let mut single = |_| strewn(&mut random, stage, normal, shape, 40, true);
    let mut cases: Vec<_> = (0..4).map(&mut single).collect();
    cases.push(strewn(&mut random, stage, normal, shape, 100, false));
    cases
}

/// Up to `count` splats on one plane through the centre of the setup. There are fewer where they do not fit beside each
/// other or the plane is hardly in view.
pub(super) fn strewn(
    random: &mut Random,
    stage: Setup,
    normal: Normal<'_>,
    shape: Deviations<'_>,
    count: usize,
    apart: bool,
) -> Case {
    let camera = stage.camera(random);
    let normal = normal(random, &camera);
    let plane = Plane::new(normal, -normal.dot(stage.centre)).expect("a finite normal");
    let scene = on_plane(random, stage, &camera, &plane, shape, count, apart);
    let clip = Clip::of([plane], ClipOp::And);
    Case {
        scene,
        camera,
        clip,
        apart,
    }
}

/// The splats of [`strewn`].
pub(super) fn on_plane(
    random: &mut Random,
    stage: Setup,
    camera: &Camera,
    plane: &Plane,
    shape: Deviations<'_>,
    count: usize,
    apart: bool,
) -> Gaussians {
    let normal = plane.normal();
    let (across, along) = normal.any_orthonormal_pair();
    let place = |random: &mut Random| {
        let (u, v) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        let point = stage.centre + (across * u + along * v) * stage.radius();
        (point, normal)
    };
    on_surface(random, camera, &place, shape, count, apart)
}

pub(super) type PlaceFn<'a> = &'a dyn Fn(&mut Random) -> (DVec3, DVec3);

/// Up to `count` splats that a surface cuts.
pub(super) fn on_surface(
    random: &mut Random,
    camera: &Camera,
    place: PlaceFn<'_>,
    shape: Deviations<'_>,
    count: usize,
    apart: bool,
) -> Gaussians {
    let view = ViewTransform::<f64>::new(camera);
    let mut scene = Gaussians::default();
    let mut boxes: Vec<[f64; 4]> = Vec::new();
    for _ in 0..100 * count {
        if scene.len() == count {
            break;
        }
        let (point, normal) = place(random);
        let depth = (camera.rotation * (point - camera.eye)).z.max(1e-3);
        let pixel = match camera.projection {
            Projection::Perspective => depth / camera.fx,
            _ => 1.0 / camera.fx,
        };
        let rotation = orientation(random);
        let scales = shape(random, pixel);
        // The standard deviation along the normal: the surface passes within two of them from the centre.
        let deviation = (rotation.as_dquat().inverse() * normal * scales).length();
        // A point is not cut, but kept or dropped; it then stands within two pixels of the surface.
        let near = if deviation > 0.0 { deviation } else { pixel };
        let position = (point + normal * near * random.range(-2.0, 2.0)).as_vec3();
        if normal.dot(position.as_dvec3() - point).abs() > 2.5 * near {
            continue; // the nearest single-precision position is elsewhere
        }
        let opacity = random.range(0.3, 1.0) as f32;
        push(&mut scene, position, scales, rotation, opacity);
        set_colour(&mut scene, random);
        let taken = Footprint::new(&scene, scene.len() - 1, &view).map(|f| {
            let at = |i: usize, sign: f64| f.screen_centre[i] + sign * (f.half_sides[i] + 1.0);
            [at(0, -1.0), at(1, -1.0), at(0, 1.0), at(1, 1.0)]
        });
        let apart_from =
            |a: &[f64; 4], b: &[f64; 4]| a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1];
        match taken {
            Some(taken) if !apart || boxes.iter().all(|other| apart_from(other, &taken)) => {
                boxes.push(taken);
            }
            _ => pop(&mut scene),
        }
    }
    scene
}

pub(super) fn push(
    scene: &mut Gaussians,
    position: glam::Vec3,
    scales: DVec3,
    rotation: Quat,
    opacity: f32,
) {
    scene.push(position, scales.as_vec3(), rotation, opacity, &[0.0; 3]);
}

pub(super) fn set_colour(scene: &mut Gaussians, random: &mut Random) {
    let at = scene.sh().len() - 3;
    for value in &mut scene.sh_mut()[at..] {
        *value = random.range(-1.7, 1.7) as f32; // 0.5 + 0.28 of it is a colour from 0 to 1
    }
}

pub(super) fn pop(scene: &mut Gaussians) {
    scene.truncate(scene.len().saturating_sub(1));
}
