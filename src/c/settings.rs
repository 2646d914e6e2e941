//! A frame's settings.

use rara::ash::vk;
use rara::{
    ClipOp, Decay, ExactForm, MeshRule, Miss, Mode, PhiForm, Precision, Preset, Raster, Result,
    Settings, ShFormat, Show, SortBy,
};

use crate::boundary::{RaraResult, guard, invalid, read, versioned, write};

/// How a clip treats the Gaussians that it cuts.
pub type RaraMode = u32;
/// The clip has no effect.
pub const RARA_MODE_NONE: RaraMode = 0;
/// Each splat is kept or dropped as a whole, by its centre.
pub const RARA_MODE_HARD: RaraMode = 1;
/// The share is the paper's ratio of lengths along the ray of each pixel.
pub const RARA_MODE_RARA: RaraMode = 2;
/// The share is the exact one, with the low-pass of 3DGS. The default.
pub const RARA_MODE_EXACT: RaraMode = 3;

/// The quantity that the weight w of a cut splat scales.
pub type RaraDecay = u32;
/// The mode's own: linear for RARA_MODE_RARA, depth for RARA_MODE_EXACT. The default.
pub const RARA_DECAY_AUTO: RaraDecay = 0;
/// Scale alpha: alpha' = alpha w (the paper).
pub const RARA_DECAY_LINEAR: RaraDecay = 1;
/// Scale the optical depth: alpha' = 1 - (1 - alpha)^w. The two halves of a cut splat together give the whole splat.
pub const RARA_DECAY_DEPTH: RaraDecay = 2;

/// RARA_MODE_RARA only: what a cut splat keeps in a pixel whose ray misses the traced ellipsoid.
pub type RaraMiss = u32;
/// The splat keeps everything (the paper's text).
pub const RARA_MISS_KEEP: RaraMiss = 0;
/// The splat keeps nothing (the paper's released code).
pub const RARA_MISS_DROP: RaraMiss = 1;
/// The splat keeps everything if the clip keeps the densest point of the ray, else nothing. The default.
pub const RARA_MISS_PEAK: RaraMiss = 2;

/// RARA_MODE_EXACT only: the form of the weight.
pub type RaraExactForm = u32;
/// Small splats get the affine form, and large ones the form that is exact in perspective (beam_switch). The default.
pub const RARA_EXACT_FORM_AUTO: RaraExactForm = 0;
/// Every cut splat gets the form that is exact in perspective.
pub const RARA_EXACT_FORM_BEAM: RaraExactForm = 1;
/// Every cut splat gets the affine form: its weight is computed as if the rays of all its pixels were parallel.
pub const RARA_EXACT_FORM_AFFINE: RaraExactForm = 2;

/// How splats become pixels. All choices give the same picture.
pub type RaraRaster = u32;
/// The path that is faster on this device. The default.
pub const RARA_RASTER_AUTO: RaraRaster = 0;
/// Quads from mesh shaders (VK_EXT_mesh_shader).
pub const RARA_RASTER_MESH: RaraRaster = 1;
/// Quads by instancing.
pub const RARA_RASTER_QUAD: RaraRaster = 2;
/// A compute shader blends the splats of each tile of pixels.
pub const RARA_RASTER_TILES: RaraRaster = 3;

/// The quantity that a frame shows.
pub type RaraShow = u32;
/// The splats' colours. The default.
pub const RARA_SHOW_COLOUR: RaraShow = 0;
/// The weight of each splat, as a colour: blue for a splat that the clip leaves whole. A splat that the clip cuts goes from
/// red, where the pixel keeps nothing of it, to yellow, where it keeps all.
pub const RARA_SHOW_WEIGHT: RaraShow = 1;
/// The number of splats in the pixel, as red, green and blue. This needs tiles.
pub const RARA_SHOW_COUNT: RaraShow = 2;
/// The mean of the splats' colours, each weighted by its alpha; their order has no effect. This needs tiles.
pub const RARA_SHOW_MEAN: RaraShow = 3;

/// The order in which splats are blended.
pub type RaraSortBy = u32;
/// The order that the visible layers ask for (glTF by distance, other files by depth), or by depth if they ask for different
/// orders. The default.
pub const RARA_SORT_BY_SCENE: RaraSortBy = 0;
/// Splats are sorted by the depths of their centres along the view axis, as in 3DGS.
pub const RARA_SORT_BY_DEPTH: RaraSortBy = 1;
/// Splats are sorted by the distances of their centres from the eye.
pub const RARA_SORT_BY_DISTANCE: RaraSortBy = 2;

/// RARA_MODE_EXACT only: the approximation of the normal distribution function Phi.
pub type RaraPhiForm = u32;
/// A logistic function of an odd quintic. The largest error is 1.9e-5.
pub const RARA_PHI_FORM_QUINTIC: RaraPhiForm = 0;
/// A logistic function of an odd cubic. The largest error is 1.4e-4.
pub const RARA_PHI_FORM_CUBIC: RaraPhiForm = 1;
/// A logistic function. The largest error is 9.5e-3, which is more than two of 255 levels.
pub const RARA_PHI_FORM_LOGISTIC: RaraPhiForm = 2;

/// A choice of all settings that give up exactness for time: phi, key_bits, beam_switch and transmittance_min.
pub type RaraPreset = u32;
/// Nothing is approximated. It goes with scenes in RARA_SH_FORMAT_FLOAT.
pub const RARA_PRESET_EXACT: RaraPreset = 0;
/// Only approximations that no picture shows: the usual choice. It goes with scenes in RARA_SH_FORMAT_PACKED.
pub const RARA_PRESET_BALANCED: RaraPreset = 1;
/// Only approximations that pictures hardly show. It goes with scenes in RARA_SH_FORMAT_PACKED.
pub const RARA_PRESET_FAST: RaraPreset = 2;

/// The options of a frame, apart from scene, camera and clip.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraSettings {
    /// Set by rara_settings_default.
    pub struct_size: usize,
    /// How the clip treats the Gaussians that it cuts.
    pub mode: RaraMode,
    /// The quantity that the weight scales.
    pub decay: RaraDecay,
    /// RARA_MODE_RARA: the radius of the traced ellipsoid, in standard deviations. Default: 3.
    pub sigma: f32,
    /// RARA_MODE_RARA: what a cut splat keeps in a pixel whose ray misses the ellipsoid.
    pub miss: RaraMiss,
    /// True treats every Gaussian as cut. This is for the paper's ablation. Default: false.
    pub trace_all: vk::Bool32,
    /// RARA_MODE_EXACT: the form of the weight.
    pub form: RaraExactForm,
    /// The highest degree of spherical harmonics to evaluate. -1, the default, is the scene's own.
    pub sh_degree: i32,
    /// How splats become pixels.
    pub raster: RaraRaster,
    /// Colours, or a debug view.
    pub show: RaraShow,
    /// RARA_MODE_EXACT: how Phi is approximated. The preset sets this and all fields below.
    pub phi: RaraPhiForm,
    /// The largest number of bits of the depths that the sort compares, 8 to 32.
    pub key_bits: u32,
    /// RARA_MODE_EXACT: a cut splat gets the form that is exact in perspective if its largest deviation divided by its depth
    /// exceeds this. With 0, all of them do.
    pub beam_switch: f32,
    /// Tiles only: a pixel whose transmittance is below this is saturated. With 0, everything is blended.
    pub transmittance_min: f32,
    /// The order of the splats.
    pub sort_by: RaraSortBy,
}

versioned!(RaraSettings);

/// A choice whose code in C is its place among all; where none may be chosen, 0 is none.
pub(crate) trait Coded: Sized {
    /// Its type in C.
    const NAME: &'static str;

    fn from_code(code: u32) -> Option<Self>;
    fn code(self) -> u32;
}

macro_rules! coded {
    ($($of:ident)+) => {
        $(impl Coded for $of {
            const NAME: &'static str = concat!("Rara", stringify!($of));

            fn from_code(code: u32) -> Option<Self> {
                Self::ALL.get(code as usize).copied()
            }

            fn code(self) -> u32 {
                let place = Self::ALL.iter().position(|value| *value == self);
                place.map_or(0, |place| place as u32) // C has no code for what has no name
            }
        })+

        /// The values that the constants of rara.h have, by their types and their names in Rust.
        #[cfg(test)]
        pub(crate) fn codes() -> Vec<(&'static str, String, u32)> {
            let mut all = Vec::new();
            $(all.extend($of::ALL.iter().map(|value| ($of::NAME, format!("{value:?}"), value.code())));)+
            all
        }
    };
}

coded! { Mode Decay Miss ExactForm Raster Show SortBy PhiForm Preset ShFormat ClipOp MeshRule }

impl<T: Coded> Coded for Option<T> {
    const NAME: &'static str = T::NAME;

    fn from_code(code: u32) -> Option<Self> {
        match code.checked_sub(1) {
            Some(code) => T::from_code(code).map(Some),
            None => Some(None),
        }
    }

    fn code(self) -> u32 {
        self.map_or(0, |value| 1 + value.code())
    }
}

/// The choice that a code stands for; `name` is for the message.
pub(crate) fn choice<T: Coded>(code: u32, name: &str) -> Result<T> {
    match T::from_code(code) {
        Some(value) => Ok(value),
        None => invalid(format!("{name} {code} is no {}", T::NAME)),
    }
}

/// A field's value in C.
macro_rules! to_c {
    (choice $value:expr) => {
        $value.code()
    };
    (number $value:expr) => {
        $value
    };
    (switch $value:expr) => {
        $value.into()
    };
    (degree $value:expr) => {
        $value.map_or(-1, |degree| degree as i32)
    };
}

/// The value of a field in C.
macro_rules! from_c {
    (choice $value:expr, $name:ident) => {
        choice($value, concat!("settings->", stringify!($name)))?
    };
    (number $value:expr, $name:ident) => {
        $value
    };
    (switch $value:expr, $name:ident) => {
        $value != 0
    };
    (degree $value:expr, $name:ident) => {
        u32::try_from($value).ok()
    };
}

/// Carries the fields of settings and of their precision to C and back.
macro_rules! fields {
    ($($field:ident as $kind:ident,)+ ; $($precise:ident as $precise_kind:ident,)+) => {
        impl RaraSettings {
            pub(crate) fn new(preset: Preset) -> Self {
                let settings = Settings::default().precision(preset.precision());
                Self {
                    struct_size: size_of::<Self>(),
                    $($field: to_c!($kind settings.$field),)+
                    $($precise: to_c!($precise_kind settings.precision.$precise),)+
                }
            }

            pub(crate) fn settings(&self) -> Result<Settings> {
                let precision = Precision::default()
                    $(.$precise(from_c!($precise_kind self.$precise, $precise)))+;
                Ok(Settings::default()
                    $(.$field(from_c!($kind self.$field, $field)))+
                    .precision(precision))
            }
        }

        /// How many fields of the library's settings and of their precision C has.
        #[cfg(test)]
        pub(crate) const FIELDS: [usize; 2] =
            [[$(stringify!($field)),+].len(), [$(stringify!($precise)),+].len()];
    };
}

fields! {
    mode as choice,
    decay as choice,
    sigma as number,
    miss as choice,
    trace_all as switch,
    form as choice,
    sh_degree as degree,
    raster as choice,
    show as choice,
    sort_by as choice,
    ;
    phi as choice,
    key_bits as number,
    beam_switch as number,
    transmittance_min as number,
}

/// Reads a host's settings; null stands for the defaults.
pub(crate) unsafe fn settings(settings: *const RaraSettings) -> Result<Settings> {
    let default = RaraSettings::new(Preset::default());
    if settings.is_null() {
        return default.settings();
    }
    read(settings, default, "settings")?.settings()
}

/// The default settings with a preset's precision. `settings_size` is sizeof *settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_settings_default(
    settings: *mut RaraSettings,
    settings_size: usize,
    preset: RaraPreset,
) -> RaraResult {
    guard(|| {
        let default = RaraSettings::new(choice(preset, "preset")?);
        write(settings, settings_size, &default, "settings")
    })
}
