//! The settings of a frame, apart from scene, camera and clip.

use crate::camera::{Camera, Projection};
use crate::precision::Precision;
use crate::training::{SortBy, Training};
use rara_base::setters;

/// How a clip treats the Gaussians that it cuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Mode {
    /// No clipping.
    None,
    /// Keep or drop by the centre.
    Hard,
    /// The paper's length ratio along each pixel's ray.
    Rara,
    /// The exact visible share of the splat, the low-pass of 3DGS included.
    #[default]
    Exact,
}

/// The quantity that the weight w of a cut splat scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Decay {
    /// Alpha: `alpha' = alpha w` (the paper).
    Linear,
    /// Optical depth: `alpha' = 1 - (1 - alpha)^w`. Complementary halves rebuild the whole.
    Depth,
}

/// [`Mode::Rara`] only: what a cutoff splat keeps in a pixel whose ray misses the traced ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Miss {
    /// Everything (the paper's text).
    Keep,
    /// Nothing (the paper's released code).
    Drop,
    /// All or nothing, by the side on which the ray's densest point lies: the limit of the ratio.
    #[default]
    Peak,
}

/// How splats become pixels. All give the same picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Raster {
    /// The faster path on the device at hand.
    #[default]
    Auto,
    /// Mesh shaders (VK_EXT_mesh_shader).
    Mesh,
    /// Instanced quads.
    Quad,
    /// Tiles of pixels, each an ordered list of its splats, in a compute shader; front to back, until a tile is
    /// saturated.
    Tiles,
}

/// The quantity that a frame shows of its splats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Show {
    /// The splats' colours.
    #[default]
    Colour,
    /// The effect of the clip on them: a splat that it leaves whole is blue; one that it cuts goes from red, where the
    /// pixel keeps nothing, to yellow, where it keeps all. Blended like colours.
    Weight,
    /// The number of splats that make the pixel: red, green and blue each, while alpha is as ever. A splat counts of
    /// which the clip leaves an alpha of 1/255 or more, and that comes before the pixel is saturated. Only tiles count.
    Count,
    /// The mean of the splats' colours, each weighted by its alpha, in no order, while alpha is as ever: the colours that lie
    /// on a plane where the splats are cross-sections, as scene::cross_section makes them. Only tiles make it.
    Mean,
    /// The splat that adds most to the pixel's alpha: red and 65536 times green are its Gaussian's number in the scene, blue is
    /// its layer's, and alpha is what it adds; all are 0 where there is none. Only tiles make it, and only pictures of 32-bit
    /// floats hold it, without a background. `Picker` reads it.
    #[cfg_attr(feature = "clap", value(skip))]
    Strongest,
}

impl Show {
    /// True for what no draw of quads shows.
    #[doc(hidden)]
    pub fn needs_tiles(self) -> bool {
        matches!(self, Self::Count | Self::Mean | Self::Strongest)
    }
}

/// Which form of the exact weight a cut splat gets.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ExactForm {
    /// Affine in the pixel for small splats, perspective-exact for large ones ([`Precision::beam_switch`]).
    #[default]
    Auto,
    /// Perspective-exact for every cut splat: the truth that errors are measured against.
    Beam,
    /// Affine for every cut splat.
    Affine,
}

setters! {
    /// The options of a frame: start from the defaults and set what differs.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Mode, Settings};
    /// let settings = Settings::default().mode(Mode::Hard).trace_all(true);
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct Settings {
        /// How cut Gaussians are treated.
        pub mode: Mode,
        /// The quantity that the weight scales; `None` is the mode's own (linear for `rara`, depth for `exact`).
        pub decay: Option<Decay>,
        /// [`Mode::Rara`]: the traced ellipsoid, in standard deviations.
        pub sigma: f32,
        /// [`Mode::Rara`]: what a missed pixel keeps.
        pub miss: Miss,
        /// Ablation: treat every Gaussian as cutoff.
        pub trace_all: bool,
        /// [`Mode::Exact`]: the form of the weight.
        pub form: ExactForm,
        /// Opaque background colour; `None` is transparent.
        pub background: Option<[f32; 3]>,
        /// Highest spherical-harmonics degree to evaluate; `None` is the scene's own.
        pub sh_degree: Option<u32>,
        /// How splats become pixels.
        pub raster: Raster,
        /// Colours, or a debug view.
        pub show: Show,
        /// The order of the splats; `None` is what all visible layers [ask for](crate::Training::sort_by), or by depth where
        /// they differ.
        pub sort_by: Option<SortBy>,
        /// How precise the frame is.
        pub precision: Precision,
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            decay: None,
            sigma: 3.0,
            miss: Miss::default(),
            trace_all: false,
            form: ExactForm::default(),
            background: None,
            sh_degree: None,
            raster: Raster::default(),
            show: Show::default(),
            sort_by: None,
            precision: Precision::default(),
        }
    }
}

impl Settings {
    /// The order in force, for layers that were trained like this.
    #[doc(hidden)]
    pub fn order_of(&self, camera: &Camera, visible: impl IntoIterator<Item = Training>) -> SortBy {
        let asked = || {
            let mut all = visible.into_iter().map(|training| training.sort_by);
            let first = all.next()?;
            all.all(|other| other == first).then_some(first)
        };
        match camera.projection {
            Projection::Perspective => self.sort_by.or_else(asked).unwrap_or_default(),
            Projection::Orthographic => SortBy::Depth,
        }
    }

    /// The decay law in force: the one asked for, or the mode's own.
    pub fn decay_law(&self) -> Decay {
        self.decay.unwrap_or(match self.mode {
            Mode::Rara => Decay::Linear,
            Mode::None | Mode::Hard | Mode::Exact => Decay::Depth,
        })
    }
}
