//! What is looked at: a scene, as a host with y up, reversed and infinite depth sees it, and the host's own things in it.

use rara::glam::{DMat4, DVec3, dcamera::rh};
use rara::scene::Bounds;
use rara::{Camera, Clip, ClipOp, Gaussians, Ndc, Plane, Settings};

use crate::Failure;
use crate::meshes::Wall;
use crate::splats::View;

/// The host's near plane, world units; there is no far one.
const NEAR: f64 = 0.1;

/// The background behind the host's things: opaque, and exact in halves.
pub(crate) const BACKGROUND: [f64; 4] = [0.125, 0.25, 0.375, 1.0];

pub(crate) struct World {
    pub(crate) scene: Gaussians,
    pub(crate) size: (u32, u32),
    pub(crate) view: View,
    /// A wall amid the scene, and its place in the picture: left, top, right and bottom, px.
    pub(crate) wall: Wall,
    pub(crate) wall_area: [u32; 4],
    projection: DMat4,
}

impl World {
    pub(crate) fn new(scene: Gaussians, size: (u32, u32)) -> Result<Self, Failure> {
        let bounds = Bounds::of(&scene);
        // The scene's y points down, as that of most that are captured, and the host's up: a half turn leads from one to the
        // other.
        let model = DMat4::from_rotation_x(std::f64::consts::PI);
        let centre = model.transform_point3(bounds.centre());
        let eye = centre + bounds.radius() * DVec3::new(0.9, 0.7, 1.6);
        let view = rh::view::look_at_mat4(eye, centre, DVec3::Y);
        let aspect = f64::from(size.0) / f64::from(size.1);
        let projection = rh::proj::directx::perspective_infinite_reverse(0.9, aspect, NEAR);
        let (camera, depth) = Camera::of_projection(view * model, projection, Ndc::DIRECT3D, size)?;
        let cut = Plane::new(DVec3::NEG_X, bounds.centre().x)?;

        let wall_area = [size.0 / 8, size.1 / 4, size.0 / 2, size.1 * 3 / 4];
        let [left, top, right, bottom] = wall_area.map(f64::from);
        let across = |x: f64| 2.0 * x / f64::from(size.0) - 1.0;
        let up = |y: f64| 1.0 - 2.0 * y / f64::from(size.1);
        Ok(Self {
            wall: Wall {
                low: [across(left), up(bottom)],
                high: [across(right), up(top)],
                depth: middle_depth(&scene, &camera),
                color: [0.75, 0.5, 0.25, 1.0],
            },
            wall_area,
            size,
            view: View {
                camera,
                depth,
                clip: Clip::of([cut], ClipOp::And),
                settings: Settings::default(),
            },
            projection,
            scene,
        })
    }

    /// Two eyes about the camera's place.
    pub(crate) fn eyes(&self) -> [Camera; 2] {
        let camera = self.view.camera;
        let aside =
            camera.rotation.transpose() * DVec3::X * 0.02 * Bounds::of(&self.scene).radius();
        [-1.0, 1.0].map(|side| camera.eye(camera.eye + side * aside))
    }

    /// A background, the wall, and how both are seen.
    pub(crate) fn furniture(&self) -> (wgpu::Color, &[Wall], DMat4) {
        let [r, g, b, a] = BACKGROUND;
        let wall = std::slice::from_ref(&self.wall);
        (wgpu::Color { r, g, b, a }, wall, self.projection)
    }

    /// Nothing but a transparent background.
    pub(crate) fn nothing(&self) -> (wgpu::Color, &[Wall], DMat4) {
        (wgpu::Color::TRANSPARENT, &[], self.projection)
    }

    /// The Gaussians before the wall, which it does not hide where it stands.
    pub(crate) fn before_wall(&self) -> Gaussians {
        let scene = &self.scene;
        let mut before = Gaussians::default();
        before.set_sh_degree(scene.sh_degree());
        for index in 0..scene.len() {
            if depth_of(scene, &self.view.camera, index) < self.wall.depth {
                before.push(
                    scene.positions()[index],
                    scene.scales()[index],
                    scene.rotations()[index],
                    scene.opacities()[index],
                    scene.sh_of(index),
                );
            }
        }
        before
    }
}

fn depth_of(scene: &Gaussians, camera: &Camera, index: usize) -> f64 {
    let relative = scene.positions()[index].as_dvec3() - camera.eye;
    (camera.rotation * relative).z
}

/// A depth between those of the scene's two middle Gaussians.
fn middle_depth(scene: &Gaussians, camera: &Camera) -> f64 {
    let depth = |index| depth_of(scene, camera, index);
    let mut depths: Vec<f64> = (0..scene.len()).map(depth).collect();
    depths.sort_by(f64::total_cmp);
    let middle = depths.len() / 2;
    (depths[middle - 1] + depths[middle]) / 2.0
}
