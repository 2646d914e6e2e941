//! Channels beside the colours of a picture: what its pixels are made of.

use glam::{DVec3, Quat, Vec3};

use super::Headless;
use crate::passes::SceneBuffers;
use rara_base::error::Result;
use rara_scene::camera::{Camera, Projection};
use rara_scene::clip::Clip;
use rara_scene::picture::{Aov, Channel, Picture};
use rara_scene::placement::Placement;
use rara_scene::precision::{ShFormat, TargetFormat};
use rara_scene::settings::{Settings, Show};
use rara_scene::{Gaussians, Layer, Scene};

/// The constant spherical harmonic.
const SH_0: f32 = 0.282_094_8;

impl Headless {
    /// Draws what a frame's pixels are made of, as channels for [`Picture::save_with`], each named once and in this order. A
    /// splat counts by what it adds to alpha.
    ///
    /// `scene` is the one that is loaded, with its layers' states and clips. Each channel takes a frame or more of its own;
    /// those of normals and layers upload the scene in other colours, and then as it was.
    ///
    /// # Errors
    /// As [`render`](Self::render) and [`load_as`](Self::load_as).
    pub fn channels(
        &mut self,
        aovs: &[Aov],
        scene: &Scene<'_>,
        (camera, clip, settings): (&Camera, &Clip, &Settings),
    ) -> Result<Vec<Channel>> {
        // A background would count as a splat, and what these frames show is counted and divided: a picture of few bits rounds
        // it, and holds no count above one.
        let precision = settings.precision.target(TargetFormat::Float);
        let settings = settings.background(None).precision(precision);
        let mut channels: Vec<Channel> = Vec::new();
        for (number, aov) in aovs.iter().enumerate() {
            if aovs[..number].contains(aov) {
                continue;
            }
            let frame = (camera, clip, &settings);
            match aov {
                Aov::Depth => {
                    channels.push(channel("Z", self.expected_depth(camera, clip, &settings)?));
                }
                Aov::Weight => {
                    let picture = self.shown(Show::Weight, frame)?;
                    channels.push(channel(
                        "weight",
                        picture.pixels.iter().map(weight).collect(),
                    ));
                }
                Aov::Count => {
                    let picture = self.shown(Show::Count, frame)?;
                    let counts = picture.pixels.iter().map(|pixel| pixel[0]);
                    channels.push(channel("count", counts.collect()));
                }
                Aov::Normal => {
                    let world = *self.session.renderer.placement();
                    let painted: Vec<_> = scene
                        .layers()
                        .iter()
                        .map(|layer| in_normals(layer, camera, &world))
                        .collect();
                    let picture = self.painted(scene, &painted, frame)?;
                    channels.extend(normals(&picture));
                }
                Aov::Layer => channels.push(channel("layer", self.layer_numbers(scene, frame)?)),
            }
        }
        Ok(channels)
    }

    /// A frame of its own that shows something else.
    fn shown(
        &mut self,
        show: Show,
        (camera, clip, settings): (&Camera, &Clip, &Settings),
    ) -> Result<Picture> {
        let settings = settings.show(show);
        let settings = match show.needs_tiles() {
            true => settings.raster(rara_scene::settings::Raster::Auto),
            false => settings,
        };
        self.render(camera, clip, &settings)?;
        self.picture()
    }

    /// A frame of the scene in other Gaussians, a set for each layer.
    fn painted(
        &mut self,
        scene: &Scene<'_>,
        painted: &[Gaussians],
        frame: (&Camera, &Clip, &Settings),
    ) -> Result<Picture> {
        let format = self
            .session
            .scene
            .as_ref()
            .map(|scene: &SceneBuffers| scene.sh_format);
        let layers = scene.layers().iter().zip(painted);
        let layers: Scene<'_> = layers.map(|(layer, painted)| layer.of(painted)).collect();
        self.load_as(layers, ShFormat::Float)?;
        let picture = self.shown(Show::Colour, frame);
        self.load_as(scene.clone(), format.unwrap_or_default())?;
        picture
    }

    /// For each pixel the layer that adds most to it. A frame tells three layers apart, by its three colours.
    fn layer_numbers(
        &mut self,
        scene: &Scene<'_>,
        frame: (&Camera, &Clip, &Settings),
    ) -> Result<Vec<f32>> {
        let (width, height) = (frame.0.width as usize, frame.0.height as usize);
        let mut most = vec![(0.0_f32, -1.0_f32); width * height];
        for first in (0..scene.layers().len()).step_by(3) {
            let painted: Vec<_> = scene
                .layers()
                .iter()
                .enumerate()
                .map(|(number, layer)| {
                    let colour = std::array::from_fn(|c| f32::from(u8::from(number == first + c)));
                    in_colours(layer.gaussians(), |_| Vec3::from_array(colour))
                })
                .collect();
            let picture = self.painted(scene, &painted, frame)?;
            for (most, pixel) in most.iter_mut().zip(&picture.pixels) {
                for (number, share) in pixel[..3].iter().enumerate() {
                    if *share > most.0 {
                        *most = (*share, (first + number) as f32);
                    }
                }
            }
        }
        Ok(most.into_iter().map(|(_, number)| number).collect())
    }
}

fn channel(name: &str, values: Vec<f32>) -> Channel {
    Channel {
        name: name.into(),
        values,
    }
}

/// The mean weight of a pixel of the view of weights. There a splat that is not cut is (0.25, 0.45, 0.9), and one that is cut
/// is (1, weight, 0).
fn weight(&[_, green, blue, alpha]: &[f32; 4]) -> f32 {
    if alpha <= 0.0 {
        return 0.0;
    }
    let whole = blue / 0.9;
    let cut = green - 0.45 * whole;
    ((whole + cut) / alpha).clamp(0.0, 1.0)
}

/// Gaussians that are seen in the same colour from everywhere.
fn in_colours(from: &Gaussians, colour: impl Fn(usize) -> Vec3) -> Gaussians {
    let mut painted = Gaussians::default();
    painted.set_antialiased(from.is_antialiased());
    for index in 0..from.len() {
        // The renderer adds one half.
        let sh = ((colour(index) - 0.5) / SH_0).to_array();
        let (position, scale) = (from.positions()[index], from.scales()[index]);
        painted.push(
            position,
            scale,
            from.rotations()[index],
            from.opacities()[index],
            &sh,
        );
    }
    painted
}

/// The Gaussians of a layer in colours that are their normals in a world where the scene is placed: 0 to 1 stand for -1 to 1.
fn in_normals(layer: &Layer<'_>, camera: &Camera, world: &Placement) -> Gaussians {
    let (from, placement) = (layer.gaussians(), layer.state().placement);
    let camera = camera.in_scene(world);
    let turn = world.rotation() * placement.rotation();
    let eye = placement.to_scene(camera.eye);
    let axis = placement.rotation().inverse() * (camera.rotation.transpose() * DVec3::Z);
    in_colours(from, |index| {
        let normal = thinnest(from.scales()[index], from.rotations()[index]);
        let sight = match camera.projection {
            Projection::Orthographic => axis,
            Projection::Perspective => from.positions()[index].as_dvec3() - eye,
        };
        let away = normal.dot(sight) > 0.0;
        let normal = turn * if away { -normal } else { normal };
        0.5 + 0.5 * normal.as_vec3()
    })
}

/// The direction of the thinnest axis; of equal ones the first.
fn thinnest(scale: Vec3, rotation: Quat) -> DVec3 {
    let axis = match scale.to_array() {
        [x, y, z] if x <= y && x <= z => DVec3::X,
        [_, y, z] if y <= z => DVec3::Y,
        _ => DVec3::Z,
    };
    (rotation.as_dquat() * axis).normalize()
}

/// The normals of a picture of Gaussians that are painted in theirs.
fn normals(picture: &Picture) -> [Channel; 3] {
    let normal = |&[r, g, b, alpha]: &[f32; 4]| {
        (Vec3::new(r, g, b) - 0.5 * Vec3::splat(alpha)).normalize_or_zero()
    };
    let normals: Vec<Vec3> = picture.pixels.iter().map(normal).collect();
    [("N.X", 0), ("N.Y", 1), ("N.Z", 2)]
        .map(|(name, at)| channel(name, normals.iter().map(|normal| normal[at]).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_weights_come_back_from_the_view_of_weights() {
        // Half of the alpha is of whole splats, a quarter of cut ones that keep all, and a quarter of some that keep 0.2.
        let over = |a: f32, [r, g, b]: [f32; 3]| [a * r, a * g, a * b, a];
        let parts = [
            over(0.4, [0.25, 0.45, 0.9]),
            over(0.2, [1.0, 1.0, 0.0]),
            over(0.2, [1.0, 0.2, 0.0]),
        ];
        let pixel = std::array::from_fn(|at| parts.iter().map(|part| part[at]).sum());
        assert!((weight(&pixel) - 0.8).abs() < 1e-6);
        assert_eq!(weight(&[0.0; 4]), 0.0);
    }

    #[test]
    fn a_disc_is_painted_in_the_normal_that_the_eye_sees() {
        let tilted = Quat::from_rotation_y(0.4);
        let disc = Vec3::new(1.0, 1.0, 0.01);
        let mut discs = Gaussians::default();
        discs.push(Vec3::ZERO, disc, tilted, 0.9, &[0.0; 3]);
        let scene = Scene::from(&discs);
        for eye in [DVec3::Z * 5.0, DVec3::Z * -5.0] {
            let camera = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 40.0, (8, 8));
            let (camera, world) = (camera.expect("a view"), Placement::IDENTITY);
            let painted = in_normals(&scene.layers()[0], &camera, &world);
            // The colour that such a splat is drawn in, with an alpha of 0.7.
            let colour = painted.sh_of(0).iter().map(|v| 0.7 * (v * SH_0 + 0.5));
            let colour: Vec<f32> = colour.collect();
            let picture = Picture::filled(1, 1, [colour[0], colour[1], colour[2], 0.7]);
            let found = normals(&picture).map(|channel| channel.values[0]);
            let expected = tilted * Vec3::Z * eye.z.signum() as f32;
            assert!(
                Vec3::from_array(found).distance(expected) < 1e-5,
                "{found:?}"
            );
        }
    }
}
