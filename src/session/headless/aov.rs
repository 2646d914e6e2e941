//! Channels beside the colours of a picture: what its pixels are made of.

use glam::Vec3;

use super::Headless;
use crate::passes::SplatColours;
use crate::renderer::Kept;
use rara_base::error::Result;
use rara_scene::camera::Camera;
use rara_scene::picture::{Aov, Channel, Picture};
use rara_scene::precision::TargetFormat;
use rara_scene::settings::{Settings, Show};

impl Headless {
    /// Draws what a frame's pixels are made of, as channels for [`Picture::save_with`], each named once and in this order. A
    /// splat counts by what it adds to alpha.
    ///
    /// Each channel takes a frame of its own; that of layers one for every three of them.
    ///
    /// # Errors
    /// The errors of [`render`](Self::render).
    pub fn channels<'a>(
        &mut self,
        aovs: &[Aov],
        (camera, kept, settings): (&Camera, impl Into<Kept<'a>>, &Settings),
    ) -> Result<Vec<Channel>> {
        let kept = kept.into();
        // A background would count as a splat, and what these frames show is counted and divided: a picture of few bits rounds
        // it, and holds no count above one.
        let precision = settings.precision.target(TargetFormat::Float);
        let settings = settings.background(None).precision(precision);
        let mut channels: Vec<Channel> = Vec::new();
        for (number, aov) in aovs.iter().enumerate() {
            if aovs[..number].contains(aov) {
                continue;
            }
            let frame = (camera, kept, &settings);
            match aov {
                Aov::Depth => {
                    channels.push(channel("Z", self.expected_depth(camera, kept, &settings)?));
                }
                Aov::Weight => {
                    let picture = self.shown(Show::Weight, SplatColours::Scene, frame)?;
                    channels.push(channel(
                        "weight",
                        picture.pixels.iter().map(weight).collect(),
                    ));
                }
                Aov::Count => {
                    let picture = self.shown(Show::Count, SplatColours::Scene, frame)?;
                    let counts = picture.pixels.iter().map(|pixel| pixel[0]);
                    channels.push(channel("count", counts.collect()));
                }
                Aov::Normal => {
                    let picture = self.shown(Show::Colour, SplatColours::Normals, frame)?;
                    channels.extend(normals(&picture, camera));
                }
                Aov::Layer => channels.push(channel("layer", self.layer_numbers(frame)?)),
            }
        }
        Ok(channels)
    }

    /// A frame of its own that shows something else, of splats in these colours.
    fn shown(
        &mut self,
        show: Show,
        colours: SplatColours,
        (camera, kept, settings): (&Camera, Kept<'_>, &Settings),
    ) -> Result<Picture> {
        let settings = settings.show(show);
        let settings = match show.needs_tiles() {
            true => settings.raster(rara_scene::settings::Raster::Auto),
            false => settings,
        };
        self.render_in(colours, camera, kept, &settings)?;
        self.picture()
    }

    /// For each pixel the layer that adds most to it. A frame tells three layers apart, by its three colours.
    fn layer_numbers(&mut self, frame: (&Camera, Kept<'_>, &Settings)) -> Result<Vec<f32>> {
        let (width, height) = (frame.0.width as usize, frame.0.height as usize);
        let mut most = vec![(0.0_f32, -1.0_f32); width * height];
        let layers = self.layers().len();
        for first in (0..layers).step_by(3) {
            let colours = SplatColours::Layers(first as u32);
            let picture = self.shown(Show::Colour, colours, frame)?;
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

/// The normals in the world of a picture of splats in theirs, which are in the camera's frame.
fn normals(picture: &Picture, camera: &Camera) -> [Channel; 3] {
    let to_world = camera.rotation.transpose().as_mat3();
    let normal = |&[x, y, z, _]: &[f32; 4]| (to_world * Vec3::new(x, y, z)).normalize_or_zero();
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
}
