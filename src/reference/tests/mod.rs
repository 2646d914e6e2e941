//! Tests of the reference by closed forms: nothing in here repeats a formula of the renderer.

mod combined;
mod depths;
mod invariance;
mod laws;
mod orthographic;
mod pictures;
mod properties;
mod shares;
mod single;
mod truth;
mod weights;

use glam::{DMat3, DVec3, Quat, Vec3 as Point};

use super::*;
use rara_scene::Gaussians;
use rara_scene::camera::Projection;
use rara_scene::clip::{ClipOp, Plane};
use rara_scene::settings::Mode;

/// Y_00, the constant of the harmonics' first band.
const Y00: f64 = 0.282_094_791_773_878_14;

const NO_CLIP: Clip = Clip {
    surfaces: Vec::new(),
    op: ClipOp::And,
    parts: Vec::new(),
};

/// A scene's picture without a clip.
fn whole(scene: &Gaussians, camera: &Camera) -> Picture {
    render::<f64>(scene, camera, &NO_CLIP, &Settings::default()).picture
}

/// A camera at the origin that looks along +z, with its principal point in the middle.
fn camera(width: u32, height: u32, focal: f64) -> Camera {
    let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 90.0, (width, height));
    let camera = camera.expect("a camera").rotation(DMat3::IDENTITY);
    camera.fx(focal).fy(focal)
}

/// A test's description of one Gaussian.
#[derive(Debug, Clone, Copy)]
struct One {
    position: [f32; 3],
    scale: [f32; 3],
    rotation: Quat,
    opacity: f32,
    colour: [f32; 3],
}

impl Default for One {
    fn default() -> Self {
        Self {
            position: [0.0, 0.0, 4.0],
            scale: [0.1; 3],
            rotation: Quat::IDENTITY,
            opacity: 0.75,
            colour: [1.0; 3],
        }
    }
}

/// A scene of single-coloured Gaussians.
fn scene(ones: &[One]) -> Gaussians {
    let mut scene = Gaussians::default();
    for one in ones {
        scene.push(
            Point::from(one.position),
            Point::from(one.scale),
            one.rotation,
            one.opacity,
            &one.colour.map(|c| ((f64::from(c) - 0.5) / Y00) as f32),
        );
    }
    scene
}

fn plane(normal: [f64; 3], offset: f64) -> Plane {
    Plane::new(DVec3::from(normal), offset).unwrap()
}

fn clip(op: ClipOp, planes: &[Plane]) -> Clip {
    Clip::of(planes.iter().copied(), op)
}

/// The plane whose visible side is the other one.
fn opposite(plane: &Plane) -> Plane {
    Plane::new(-plane.normal(), -plane.offset()).unwrap()
}

fn mode(mode: Mode) -> Settings {
    Settings::default().mode(mode)
}

/// The cut record of a scene's only Gaussian.
fn cut(
    scene: &Gaussians,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Option<SplatCut<f64>> {
    let view = ViewTransform::new(camera);
    let footprint = Footprint::new(scene, 0, &view).expect("the Gaussian is in view");
    cutoff::cutoff(scene, 0, &footprint, &view, clip, settings)
}

/// Numbers that look random and never change: uniform in [0, 1).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        // SplitMix64: a counter, hashed.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn normal(&mut self) -> f64 {
        let (radius, angle) = (1.0 - self.next(), self.next());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    }

    fn direction(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal()).normalize()
    }

    fn rotation(&mut self) -> Quat {
        let [x, y, z, w] = [0; 4].map(|_| self.normal() as f32);
        Quat::from_xyzw(x, y, z, w).normalize()
    }

    /// A Gaussian about the axis, a few units away, its largest deviation about `sigma` and its aspect up to `aspect`.
    fn one(&mut self, sigma: f64, aspect: f64) -> One {
        let depth = self.between(3.0, 6.0);
        One {
            position: [
                self.between(-0.3, 0.3) * depth,
                self.between(-0.3, 0.3) * depth,
                depth,
            ]
            .map(|v| v as f32),
            scale: [0; 3].map(|_| (sigma * aspect.powf(-self.next())) as f32),
            rotation: self.rotation(),
            opacity: self.between(0.2, 1.0) as f32,
            ..One::default()
        }
    }
}

/// A plane through the Gaussian at `deviations` of its own extent along a random normal.
fn plane_through(one: &One, normal: DVec3, deviations: f64) -> Plane {
    let centre = Point::from(one.position).as_dvec3();
    let scale = Point::from(one.scale).as_dvec3();
    let extent = (one.rotation.as_dquat().inverse() * normal * scale).length();
    Plane::new(normal, deviations * extent - normal.dot(centre)).unwrap()
}
