//! Slices: what lies on a plane, as on the faces that a clip cuts.

use rara::scene::cross_section;
use rara::{
    Camera, Clip, ClipOp, Gaussians, Headless, Layer, Picture, Plane, Projection, Raster, Result,
    Scene, Settings, Show,
};

/// The usual width of a line around cut faces, in pixels.
pub const OUTLINE_WIDTH: f32 = 2.0;
/// The usual width of the tint along their edges, in pixels.
pub const RIM_WIDTH: f32 = 24.0;

/// A face that a clip cuts into a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// The plane of the face, which keeps what is behind the face.
    pub plane: Plane,
    /// The region that bounds the face on its plane: what else clips.
    pub rest: Clip,
}

/// Returns the faces that a clip cuts and a camera sees; none for an empty clip. The clip consists of planes, and so of slabs and
/// boxes, that cut together; for another clip the result is `None`.
pub fn faces(clip: &Clip, camera: &Camera) -> Option<Vec<Face>> {
    let planes = clip.surfaces.iter().map(|surface| surface.as_plane());
    let planes: Vec<Plane> = planes.collect::<Option<_>>()?;
    if !clip.parts.is_empty() || clip.op != ClipOp::And && planes.len() != 1 {
        return None;
    }
    let faces_us = |plane: &Plane| match camera.projection {
        Projection::Perspective => plane.distance(camera.eye) < 0.0,
        Projection::Orthographic => plane.normal().dot(camera.rotation.row(2)) > 0.0,
    };
    let face = |(at, plane): (usize, &Plane)| {
        let mut others = planes.clone();
        others.remove(at);
        Face {
            plane: *plane,
            rest: Clip::of(others, ClipOp::And),
        }
    };
    let seen = planes.iter().enumerate();
    let seen = seen.filter(|(_, plane)| faces_us(plane));
    Some(seen.map(face).collect())
}

/// The same scene, of which the layers are hidden that have clips of their own: the clip of a frame cuts no face into them.
pub fn cut_by_frame<'s>(scene: &Scene<'s>) -> Scene<'s> {
    let layers = scene.layers().iter().map(|layer| {
        let state = layer.state();
        let is_cut = state.visible && layer.clip().is_none();
        layer.clone().with(state.visible(is_cut))
    });
    layers.collect()
}

/// The cross-sections of a scene's Gaussians by a plane, which are flat Gaussians on the plane. Draw them by tiles with
/// [`Show::Mean`](rara::Show::Mean), as [`picture`](Self::picture) does: a pixel then has the mean of their colours, each weighted
/// by its opacity there.
#[derive(Debug)]
pub struct Slice<'s> {
    scene: Scene<'s>,
    flat: Vec<Gaussians>,
}

impl<'s> Slice<'s> {
    /// Makes the cross-sections of all layers of a scene, including hidden ones.
    pub fn new(scene: &Scene<'s>, plane: &Plane) -> Self {
        let layers = scene.layers().iter();
        let section = |layer: &Layer<'_>| {
            cross_section(layer.gaussians(), &plane.in_scene(&layer.placement()))
        };
        Self {
            flat: layers.map(section).collect(),
            scene: scene.clone(),
        }
    }

    /// Returns the scene of the cross-sections. Its layers have the names, states and clips of the original layers.
    pub fn scene(&self) -> Scene<'_> {
        let layers = self.scene.layers().iter().zip(&self.flat);
        let layers = layers.map(|(layer, flat)| {
            let made = Layer::new(layer.name(), flat).with(layer.state());
            match layer.clip() {
                Some(clip) => made.clipped(clip.clone()),
                None => made,
            }
        });
        layers.collect()
    }

    /// Uploads the cross-sections in place of the scene of a renderer, for [`picture`](Self::picture).
    ///
    /// # Errors
    /// The errors of [`Headless::load_as`].
    pub fn load(&self, headless: &mut Headless, settings: &Settings) -> Result<()> {
        headless.load_as(self.scene(), settings.precision.sh)
    }

    /// Draws the slice of all layers, or of those of a name, without a background: what has no splat is transparent. `rest` bounds
    /// the slice, and the settings may show anything and draw it in any way.
    ///
    /// # Errors
    /// The errors of [`Headless::render`], and [`Error::Invalid`](rara::Error::Invalid) for a renderer into which the slice was
    /// not [loaded](Self::load).
    pub fn picture(
        &self,
        headless: &mut Headless,
        (camera, rest, settings): (&Camera, &Clip, &Settings),
        of: Option<&str>,
    ) -> Result<Picture> {
        for (index, layer) in self.scene.layers().iter().enumerate() {
            let state = layer.state();
            let is_meant = of.is_none_or(|name| layer.name() == name);
            headless.set_layer_state(index, state.visible(state.visible && is_meant))?;
        }
        // Slices are made by tiles alone.
        let settings = settings
            .show(Show::Mean)
            .raster(Raster::Auto)
            .background(None);
        headless.render(camera, rest, &settings)?;
        headless.picture()
    }
}

#[cfg(test)]
mod tests;
