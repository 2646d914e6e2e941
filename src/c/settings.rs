//! A frame's settings.

use rara::ash::vk;
use rara::{
    Decay, ExactForm, Miss, Mode, PhiForm, Precision, Preset, Raster, Result, Settings, Show,
    SortBy,
};

use crate::boundary::{RaraResult, guard, invalid, read, versioned, write};

/// How a clip treats the Gaussians that it cuts.
pub type RaraMode = u32;
/// No clipping.
pub const RARA_MODE_NONE: RaraMode = 0;
/// Keep or drop by the centre.
pub const RARA_MODE_HARD: RaraMode = 1;
/// The paper's length ratio along each pixel's ray.
pub const RARA_MODE_RARA: RaraMode = 2;
/// The exact visible share of the splat, the low-pass of 3DGS included. The default.
pub const RARA_MODE_EXACT: RaraMode = 3;

/// The quantity that the weight w of a cut splat scales.
pub type RaraDecay = u32;
/// The mode's own: linear for RARA_MODE_RARA, depth for RARA_MODE_EXACT. The default.
pub const RARA_DECAY_AUTO: RaraDecay = 0;
/// Alpha: alpha' = alpha w (the paper).
pub const RARA_DECAY_LINEAR: RaraDecay = 1;
/// Optical depth: alpha' = 1 - (1 - alpha)^w. Complementary halves rebuild the whole.
pub const RARA_DECAY_DEPTH: RaraDecay = 2;

/// RARA_MODE_RARA only: what a cut splat keeps in a pixel whose ray misses the traced ellipsoid.
pub type RaraMiss = u32;
/// Everything (the paper's text).
pub const RARA_MISS_KEEP: RaraMiss = 0;
/// Nothing (the paper's released code).
pub const RARA_MISS_DROP: RaraMiss = 1;
/// All or nothing, by the side on which the ray's densest point lies. The default.
pub const RARA_MISS_PEAK: RaraMiss = 2;

/// RARA_MODE_EXACT only: the form of the weight.
pub type RaraExactForm = u32;
/// Affine in the pixel for small splats, perspective-exact for large ones (beam_switch). The default.
pub const RARA_EXACT_FORM_AUTO: RaraExactForm = 0;
/// Perspective-exact for every cut splat.
pub const RARA_EXACT_FORM_BEAM: RaraExactForm = 1;
/// Affine for every cut splat.
pub const RARA_EXACT_FORM_AFFINE: RaraExactForm = 2;

/// How splats become pixels. All give the same picture.
pub type RaraRaster = u32;
/// The faster way on the device at hand. The default.
pub const RARA_RASTER_AUTO: RaraRaster = 0;
/// VK_EXT_mesh_shader.
pub const RARA_RASTER_MESH: RaraRaster = 1;
/// Instanced quads.
pub const RARA_RASTER_QUAD: RaraRaster = 2;
/// Tiles of pixels in a compute shader.
pub const RARA_RASTER_TILES: RaraRaster = 3;

/// The quantity that a frame shows of its splats.
pub type RaraShow = u32;
/// Their colours. The default.
pub const RARA_SHOW_COLOUR: RaraShow = 0;
/// The effect of the clip on them: a splat that it leaves whole is blue; one that it cuts goes from red, where the
/// pixel keeps nothing, to yellow, where it keeps all.
pub const RARA_SHOW_WEIGHT: RaraShow = 1;
/// The number of splats that make the pixel: red, green and blue each. Only tiles count.
pub const RARA_SHOW_COUNT: RaraShow = 2;
/// The mean of the splats' colours, each weighted by its alpha, in no order. Only tiles make it.
pub const RARA_SHOW_MEAN: RaraShow = 3;

/// The order in which splats are blended.
pub type RaraSortBy = u32;
/// The order that all visible layers ask for (glTF by distance, other files by depth), or by depth where they differ. The default.
pub const RARA_SORT_BY_SCENE: RaraSortBy = 0;
/// The depth of their centres along the view axis orders them, as in 3DGS.
pub const RARA_SORT_BY_DEPTH: RaraSortBy = 1;
/// The distance of their centres from the eye orders them.
pub const RARA_SORT_BY_DISTANCE: RaraSortBy = 2;

/// RARA_MODE_EXACT only: how the normal distribution's Phi is approximated, and the largest error.
pub type RaraPhiForm = u32;
/// 1.9e-5.
pub const RARA_PHI_FORM_QUINTIC: RaraPhiForm = 0;
/// 1.4e-4.
pub const RARA_PHI_FORM_CUBIC: RaraPhiForm = 1;
/// 9.5e-3, two levels of 255.
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
    /// How cut Gaussians are treated.
    pub mode: RaraMode,
    /// The quantity that the weight scales.
    pub decay: RaraDecay,
    /// RARA_MODE_RARA: the traced ellipsoid, in standard deviations. Default: 3.
    pub sigma: f32,
    /// RARA_MODE_RARA: what a missed pixel keeps.
    pub miss: RaraMiss,
    /// Ablation: treat every Gaussian as cut. Default: false.
    pub trace_all: vk::Bool32,
    /// RARA_MODE_EXACT: the form of the weight.
    pub form: RaraExactForm,
    /// Highest spherical-harmonics degree to evaluate; -1 is the scene's own, and the default.
    pub sh_degree: i32,
    /// How splats become pixels.
    pub raster: RaraRaster,
    /// Colours, or a debug view.
    pub show: RaraShow,
    /// RARA_MODE_EXACT: how Phi is approximated. The preset sets this and all fields below.
    pub phi: RaraPhiForm,
    /// How many bits of the depths the sort compares at most, 8 to 32.
    pub key_bits: u32,
    /// RARA_MODE_EXACT: a cut splat is perspective-exact where its largest deviation over its depth exceeds this. Zero
    /// makes all of them exact.
    pub beam_switch: f32,
    /// Tiles only: a pixel with less transmittance than this is saturated. Zero blends everything.
    pub transmittance_min: f32,
    /// The order of the splats.
    pub sort_by: RaraSortBy,
}

versioned!(RaraSettings);

const MODES: [(RaraMode, Mode); 4] = [
    (RARA_MODE_NONE, Mode::None),
    (RARA_MODE_HARD, Mode::Hard),
    (RARA_MODE_RARA, Mode::Rara),
    (RARA_MODE_EXACT, Mode::Exact),
];
const DECAYS: [(RaraDecay, Option<Decay>); 3] = [
    (RARA_DECAY_AUTO, None),
    (RARA_DECAY_LINEAR, Some(Decay::Linear)),
    (RARA_DECAY_DEPTH, Some(Decay::Depth)),
];
const MISSES: [(RaraMiss, Miss); 3] = [
    (RARA_MISS_KEEP, Miss::Keep),
    (RARA_MISS_DROP, Miss::Drop),
    (RARA_MISS_PEAK, Miss::Peak),
];
const FORMS: [(RaraExactForm, ExactForm); 3] = [
    (RARA_EXACT_FORM_AUTO, ExactForm::Auto),
    (RARA_EXACT_FORM_BEAM, ExactForm::Beam),
    (RARA_EXACT_FORM_AFFINE, ExactForm::Affine),
];
const RASTERS: [(RaraRaster, Raster); 4] = [
    (RARA_RASTER_AUTO, Raster::Auto),
    (RARA_RASTER_MESH, Raster::Mesh),
    (RARA_RASTER_QUAD, Raster::Quad),
    (RARA_RASTER_TILES, Raster::Tiles),
];
const SHOWS: [(RaraShow, Show); 4] = [
    (RARA_SHOW_COLOUR, Show::Colour),
    (RARA_SHOW_WEIGHT, Show::Weight),
    (RARA_SHOW_COUNT, Show::Count),
    (RARA_SHOW_MEAN, Show::Mean),
];
const ORDERS: [(RaraSortBy, Option<SortBy>); 3] = [
    (RARA_SORT_BY_SCENE, None),
    (RARA_SORT_BY_DEPTH, Some(SortBy::Depth)),
    (RARA_SORT_BY_DISTANCE, Some(SortBy::Distance)),
];
const PHI_FORMS: [(RaraPhiForm, PhiForm); 3] = [
    (RARA_PHI_FORM_QUINTIC, PhiForm::Quintic),
    (RARA_PHI_FORM_CUBIC, PhiForm::Cubic),
    (RARA_PHI_FORM_LOGISTIC, PhiForm::Logistic),
];
const PRESETS: [(RaraPreset, Preset); 3] = [
    (RARA_PRESET_EXACT, Preset::Exact),
    (RARA_PRESET_BALANCED, Preset::Balanced),
    (RARA_PRESET_FAST, Preset::Fast),
];

/// The value that a code stands for; `what` has it and its C type, for the message.
fn value<T: Copy>(table: &[(u32, T)], code: u32, what: (&str, &str)) -> Result<T> {
    match table.iter().find(|row| row.0 == code) {
        Some(&(_, value)) => Ok(value),
        None => invalid(format!("{} {code} is no {}", what.0, what.1)),
    }
}

/// The code of a value, or 0 where C has none for it.
fn code<T: PartialEq>(table: &[(u32, T)], value: T) -> u32 {
    let row = table.iter().find(|row| row.1 == value);
    row.map_or(0, |row| row.0)
}

impl RaraSettings {
    pub(crate) fn new(preset: Preset) -> Self {
        let settings = Settings::default().precision(preset.precision());
        // A host has a background of its own.
        let (
            mode,
            decay,
            sigma,
            miss,
            trace_all,
            form,
            _background,
            sh_degree,
            raster,
            show,
            sort_by,
            precision,
        ) = settings.fields();
        // The first two belong to the target and the scene.
        let (_target, _sh, phi, key_bits, beam_switch, transmittance_min) = precision.fields();
        Self {
            struct_size: size_of::<Self>(),
            mode: mode_code(mode),
            decay: code(&DECAYS, decay),
            sigma,
            miss: code(&MISSES, miss),
            trace_all: trace_all.into(),
            form: code(&FORMS, form),
            sh_degree: sh_degree.map_or(-1, |degree| degree as i32),
            raster: code(&RASTERS, raster),
            show: code(&SHOWS, show),
            phi: code(&PHI_FORMS, phi),
            key_bits,
            beam_switch,
            transmittance_min,
            sort_by: code(&ORDERS, sort_by),
        }
    }

    pub(crate) fn settings(&self) -> Result<Settings> {
        let Self {
            struct_size: _,
            mode: mode_code,
            decay,
            sigma,
            miss,
            trace_all,
            form,
            sh_degree,
            raster,
            show,
            phi,
            key_bits,
            beam_switch,
            transmittance_min,
            sort_by,
        } = *self;
        // What belongs to the scene and the target, not to a frame, keeps its default.
        let precision = Precision::default()
            .phi(value(&PHI_FORMS, phi, ("settings->phi", "RaraPhiForm"))?)
            .key_bits(key_bits)
            .beam_switch(beam_switch)
            .transmittance_min(transmittance_min);
        Ok(Settings::default()
            .mode(mode(mode_code)?)
            .decay(value(&DECAYS, decay, ("settings->decay", "RaraDecay"))?)
            .sigma(sigma)
            .miss(value(&MISSES, miss, ("settings->miss", "RaraMiss"))?)
            .trace_all(trace_all != 0)
            .form(value(&FORMS, form, ("settings->form", "RaraExactForm"))?)
            .sh_degree(u32::try_from(sh_degree).ok())
            .raster(value(&RASTERS, raster, ("settings->raster", "RaraRaster"))?)
            .show(value(&SHOWS, show, ("settings->show", "RaraShow"))?)
            .sort_by(value(
                &ORDERS,
                sort_by,
                ("settings->sort_by", "RaraSortBy"),
            )?)
            .precision(precision))
    }
}

pub(crate) fn mode(code: RaraMode) -> Result<Mode> {
    value(&MODES, code, ("settings->mode", "RaraMode"))
}

pub(crate) fn mode_code(mode: Mode) -> RaraMode {
    code(&MODES, mode)
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
        let preset = value(&PRESETS, preset, ("preset", "RaraPreset"))?;
        let default = RaraSettings::new(preset);
        write(settings, settings_size, &default, "settings")
    })
}
