//! The settings of a frame, apart from scene, camera and clip.

use crate::camera::{Camera, Projection};
use crate::precision::Precision;
use crate::setting::settings;
use crate::training::{SortBy, Training};
use rara_base::error::{Error, Result, shortened};
use rara_base::named;

named! {
    /// How a clip treats the Gaussians that it cuts.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Mode {
        /// The clip has no effect.
        None = "none",
        /// Each splat is kept or dropped as a whole, by its centre.
        Hard = "hard",
        /// In each pixel, a cut splat keeps the visible share of the ray's length inside its ellipsoid (RaRa Clipper paper).
        Rara = "rara",
        /// In each pixel, a cut splat keeps the visible share of its mass along the ray, with the low-pass of 3DGS.
        #[default]
        Exact = "exact",
    }
}

named! {
    /// How the weight w of a cut splat changes its alpha.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Decay {
        /// The splat's alpha becomes alpha * w, as in the RaRa Clipper paper.
        Linear = "linear",
        /// The splat's alpha becomes 1 - (1 - alpha)^w. The two halves of a cut splat together then give the whole splat.
        Depth = "depth",
    }
}

named! {
    /// [`Mode::Rara`] only: what a cutoff splat keeps in a pixel whose ray misses the traced ellipsoid.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Miss {
        /// The whole splat stays, as in the text of the RaRa Clipper paper.
        Keep = "keep",
        /// Nothing of the splat stays, as in the code that was released with the paper.
        Drop = "drop",
        /// The whole splat stays if the clip keeps the point of the ray at which the splat is densest; otherwise nothing of it stays.
        /// Towards the edge of the ellipsoid, the share of the rays that meet it becomes the same.
        #[default]
        Peak = "peak",
    }
}

named! {
    /// How splats are rasterised. All choices give the same picture.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Raster {
        /// The path that is faster on this device.
        #[default]
        Auto = "auto",
        /// Quads from mesh shaders (VK_EXT_mesh_shader).
        Mesh = "mesh",
        /// Quads by instancing.
        Quad = "quad",
        /// A compute shader blends the splats of each tile of pixels, front to back, until the tile is saturated.
        Tiles = "tiles",
    }
}

named! {
    /// The quantity that a frame shows.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum Show {
        /// The splats' colours.
        #[default]
        Colour = "colour",
        /// The weight of each splat, as a colour. A splat that the clip leaves whole is blue. A splat that the clip cuts is red where
        /// the pixel keeps nothing of it and yellow where the pixel keeps all of it. These colours are blended as usual.
        Weight = "weight",
        /// The number of splats in the pixel, in red, green and blue alike; alpha is as usual. A splat counts if its alpha after the
        /// clip is at least 1/255 and the pixel is not yet saturated. This needs tiles.
        Count = "count",
        /// The mean of the splats' colours, each weighted by its alpha; alpha is as usual. The order of the splats has no effect. If
        /// the splats are cross-sections of a scene (scene::cross_section), the picture shows the colours on the plane of the
        /// section. This needs tiles.
        Mean = "mean",
        /// The splat that adds most to the pixel's alpha. The number of its Gaussian in the scene is red plus 65536 times green, blue
        /// is the number of its layer, and alpha is what the splat adds. All are 0 in an empty pixel. This needs tiles, a picture of
        /// 32-bit floats, and no background. `Picker` reads it.
        Strongest,
    }
}

impl Show {
    /// Returns true for a quantity that quads cannot show.
    #[doc(hidden)]
    pub fn needs_tiles(self) -> bool {
        matches!(self, Self::Count | Self::Mean | Self::Strongest)
    }
}

named! {
    /// The form of the exact weight of a cut splat.
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub enum ExactForm {
        /// Small splats get the affine form, and large ones the form that is exact in perspective ([`Precision::beam_switch`]).
        #[default]
        Auto = "auto",
        /// Every cut splat gets the form that is exact in perspective. Errors are measured against it.
        Beam = "beam",
        /// Every cut splat gets the affine form: its weight is computed as if the rays of all its pixels were parallel.
        Affine = "affine",
    }
}

settings! {
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
        /// How Gaussians that the clip cuts are drawn.
        pub mode: Mode as "mode"(Cut, "MODE"),
        /// Scale the alpha (linear) or the optical depth (depth) of a cut splat by its weight.
        ///
        /// The weight w of a cut splat is the share of it that the clip keeps in a pixel. If this is not given, mode rara uses linear,
        /// and mode exact uses depth.
        pub decay: Option<Decay> as "decay"(Cut, "LAW"),
        /// Mode rara: the radius of a splat's ellipsoid, in standard deviations.
        pub sigma: f32 as "sigma"(Cut, "K", |x| *x > 0.0 && x.is_finite(), "a finite number above zero"),
        /// Mode rara: how much of a cut splat stays in a pixel whose ray misses its ellipsoid.
        ///
        /// Mode rara draws the visible share of the ray's length inside the ellipsoid. A splat also covers pixels around its
        /// ellipsoid, in which this length is zero and has no share.
        pub miss: Miss as "miss"(Cut, "WHAT"),
        /// For ablation studies: treat every Gaussian as if the clip cut it.
        pub trace_all: bool as "trace-all"(Cut, ""),
        /// Mode exact: the form in which the weight of a cut splat is computed.
        pub form: ExactForm as "form"(Measure, "FORM"),
        /// The colour behind the picture, which is otherwise transparent.
        ///
        /// The colour is three numbers from 0 to 1, as in 1,0.5,0, or #rrggbb, or a name that CSS has for it, such as white or
        /// orange. green is 0,1,0 and grey is 0.5,0.5,0.5.
        pub background: Option<[f32; 3]> as "background"(Look, "COLOUR"),
        /// The highest degree of spherical harmonics that is drawn; by default, that of the scene.
        pub sh_degree: Option<u32> as "sh-degree"(Look, "N", |n| *n <= Some(3), "a number from 0 to 3"),
        /// How splats are rasterised; all choices draw the same picture.
        pub raster: Raster as "raster"(Look, "HOW"),
        /// What pixels show: colours, clip weights, counts or mean colours.
        pub show: Show as "show"(Look, "WHAT"),
        /// The order in which splats are blended; by default, that of the scene.
        ///
        /// glTF scenes ask for distance, and all others for depth, as in 3DGS, unless their files say otherwise. If the visible layers
        /// ask for different orders, depth is used.
        pub sort_by: Option<SortBy> as "sort"(Look, "BY"),
        ;
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
    /// Sets the field of a name, one of [`Settings::ALL`] or [`Precision::ALL`], to the value of a text.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// let mut settings = rara::Settings::default();
    /// settings.set("mode", "hard")?;
    /// settings.set("key-bits", "24")?;
    /// assert!(settings.set("mode", "soft").is_err());
    /// # Ok::<(), rara_base::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] for a name that no field has, and as [`Setting::read`](crate::Setting::read).
    pub fn set(&mut self, name: &str, text: &str) -> Result<()> {
        if let Some(setting) = Self::ALL.iter().find(|setting| setting.name == name) {
            return setting.read(self, text);
        }
        match Precision::ALL.iter().find(|setting| setting.name == name) {
            Some(setting) => setting.read(&mut self.precision, text),
            None => Err(Error::Invalid(format!(
                "there is no setting '{}'; the settings are {}",
                shortened(name),
                names().collect::<Vec<_>>().join(", ")
            ))),
        }
    }

    /// Returns the order in force for layers of this training.
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

    /// Returns the decay law in force: the chosen one, or the mode's own.
    pub fn decay_law(&self) -> Decay {
        self.decay.unwrap_or(match self.mode {
            Mode::Rara => Decay::Linear,
            Mode::None | Mode::Hard | Mode::Exact => Decay::Depth,
        })
    }
}

/// The names of all settings.
fn names() -> impl Iterator<Item = &'static str> {
    let own = Settings::ALL.iter().map(|setting| setting.name);
    own.chain(Precision::ALL.iter().map(|setting| setting.name))
}
