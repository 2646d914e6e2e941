//! The variants that are compared: modes and raster paths.

use rara::{Clip, Headless, Mode, Raster, Settings};

/// The modes, the simplest first, as tables and the CSV have them.
pub(crate) const MODES: [(&str, Mode); 4] = [
    ("none", Mode::None),
    ("hard", Mode::Hard),
    ("rara", Mode::Rara),
    ("exact", Mode::Exact),
];

/// The raster paths that a device has.
pub(crate) fn rasters(headless: &Headless) -> Vec<(&'static str, Raster)> {
    let mut rasters = vec![("tiles", Raster::Tiles), ("quad", Raster::Quad)];
    if headless.device().support().mesh_shader {
        rasters.push(("mesh", Raster::Mesh));
    }
    rasters
}

/// One way of drawing a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variant {
    pub(crate) mode: &'static str,
    pub(crate) raster: &'static str,
    pub(crate) settings: Settings,
}

impl Variant {
    pub(crate) fn new(
        (mode_name, mode): (&'static str, Mode),
        (raster_name, raster): (&'static str, Raster),
    ) -> Self {
        let settings = Settings::default().mode(mode).raster(raster);
        Self {
            mode: mode_name,
            raster: raster_name,
            settings,
        }
    }

    /// The path that a device gets by default.
    pub(crate) fn auto(mode: (&'static str, Mode)) -> Self {
        Self::new(mode, ("auto", Raster::Auto))
    }

    /// The name in the CSV.
    pub(crate) fn name(&self) -> String {
        format!("{} {}", self.mode, self.raster)
    }

    /// The clip where the mode has one.
    pub(crate) fn clip<'a>(&self, clip: &'a Clip, whole: &'a Clip) -> &'a Clip {
        if self.settings.mode == Mode::None {
            whole
        } else {
            clip
        }
    }
}
