//! `--aov`: what a picture is made of, as channels beside its colours.

use clap::ValueEnum;
use glam::{DVec3, Quat, Vec3};
use rara::{
    Camera, Channel, Clip, Gaussians, Layer, Picture, Projection, Scene, Settings, ShFormat, Show,
};

use super::failure::Failure;
use super::session::Session;

/// A quantity that a pixel can have beside its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Aov {
    /// Channel Z: the mean depth of what is left, along the view axis, world units; 0 where nothing is
    Depth,
    /// Channels N.X, N.Y, N.Z: the mean direction of the splats' thinnest axes, turned to the eye, in the world, of length one;
    /// 0 where nothing is
    Normal,
    /// Channel weight: the mean share that the clip leaves of the splats, 1 where it cuts none; 0 where nothing is
    Weight,
}

/// Each splat counts by what it adds to alpha.
pub(super) fn channels(
    aovs: &[Aov],
    session: &mut Session,
    scene: &Scene<'_>,
    (camera, clip, settings): (&Camera, &Clip, &Settings),
    sh: ShFormat,
) -> Result<Vec<Channel>, Failure> {
    // A background would count as a splat.
    let settings = settings.background(None);
    let mut channels: Vec<Channel> = Vec::new();
    for (number, aov) in aovs.iter().enumerate() {
        if aovs[..number].contains(aov) {
            continue;
        }
        match aov {
            Aov::Depth => channels.push(Channel {
                name: "Z".into(),
                values: session.expected_depth(camera, clip, &settings)?,
            }),
            Aov::Weight => {
                let shown = settings.show(Show::Weight);
                let (picture, _) = session.picture(camera, clip, &shown)?;
                channels.push(Channel {
                    name: "weight".into(),
                    values: picture.pixels.iter().map(weight).collect(),
                });
            }
            Aov::Normal => {
                let painted = painted(scene, camera);
                let layers = scene.layers().iter().zip(&painted);
                let layers = layers.map(|(layer, painted)| {
                    let state = layer.state();
                    let of = Layer::new(layer.name(), painted).with(state);
                    match layer.clip() {
                        Some(clip) => of.clipped(clip.clone()),
                        None => of,
                    }
                });
                session.reload(&layers.collect(), ShFormat::Float)?;
                let shown = settings.show(Show::Colour);
                let (picture, _) = session.picture(camera, clip, &shown)?;
                session.reload(scene, sh)?;
                channels.extend(normals(&picture));
            }
        }
    }
    Ok(channels)
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

/// The Gaussians of each layer in colours that are their normals: 0 to 1 stand for -1 to 1.
fn painted(scene: &Scene<'_>, camera: &Camera) -> Vec<Gaussians> {
    /// The constant spherical harmonic.
    const SH_0: f32 = 0.282_094_8;
    let paint = |layer: &Layer<'_>| {
        let (from, placement) = (layer.gaussians(), layer.state().placement);
        let eye = placement.to_scene(camera.eye);
        let axis = placement.rotation().inverse() * (camera.rotation.transpose() * DVec3::Z);
        let mut painted = Gaussians::default();
        for index in 0..from.len() {
            let (position, scale) = (from.positions()[index], from.scales()[index]);
            let rotation = from.rotations()[index];
            let normal = thinnest(scale, rotation);
            let sight = match camera.projection {
                Projection::Orthographic => axis,
                _ => position.as_dvec3() - eye,
            };
            let away = normal.dot(sight) > 0.0;
            let normal = placement.rotation() * if away { -normal } else { normal };
            // The renderer adds one half.
            let colour = (normal.as_vec3() * (0.5 / SH_0)).to_array();
            painted.push(position, scale, rotation, from.opacities()[index], &colour);
        }
        painted
    };
    scene.layers().iter().map(paint).collect()
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
    [("N.X", 0), ("N.Y", 1), ("N.Z", 2)].map(|(name, at)| Channel {
        name: name.into(),
        values: normals.iter().map(|normal| normal[at]).collect(),
    })
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
            let painted = painted(&scene, &camera.expect("a view"));
            // The colour that such a splat is drawn in, with an alpha of 0.7.
            let colour = painted[0]
                .sh_of(0)
                .iter()
                .map(|v| 0.7 * (v * 0.282_094_8 + 0.5));
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
