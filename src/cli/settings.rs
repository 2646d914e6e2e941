//! The flags that say how a frame is drawn, and on which device.

use clap::Args;
use rara::{
    Decay, Headless, HeadlessDesc, Miss, Mode, PipelineCache, Raster, Settings, Show, SortBy,
};

use super::failure::Failure;
use super::precision::PrecisionArgs;
#[cfg(feature = "view")]
use super::values::{flag, name, text};
use super::{output, process, values};

/// How to draw.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub(super) struct SettingsArgs {
    /// How Gaussians that the clip cuts are drawn
    #[arg(long, default_value = "exact")]
    pub(super) mode: Mode,
    /// What a cut splat's visible share scales
    ///
    /// By default linear for rara, and depth for exact.
    #[arg(long, value_name = "LAW")]
    decay: Option<Decay>,
    /// Mode rara: deviations of the ellipsoid that is traced [default: 3]
    #[arg(long, value_name = "K", value_parser = values::positive, allow_hyphen_values = true)]
    sigma: Option<f32>,
    /// Mode rara: what is kept where a ray misses [default: peak]
    ///
    /// A pixel's ray may miss the ellipsoid of a splat that the clip cuts.
    #[arg(long, value_name = "WHAT")]
    miss: Option<Miss>,
    /// Ablation: treat every Gaussian as cut
    #[arg(long)]
    trace_all: bool,
    #[command(flatten)]
    look: LookArgs,
}

/// The settings that have nothing to do with clipping.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub(super) struct LookArgs {
    /// Three numbers from 0 to 1, #rrggbb or white [default: transparent]
    #[arg(long, value_name = "COLOUR", value_parser = values::colour, allow_hyphen_values = true)]
    background: Option<[f32; 3]>,
    /// Highest degree of spherical harmonics [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=3))]
    sh_degree: Option<u32>,
    /// How splats become pixels; the picture is the same
    #[arg(long, value_name = "HOW", default_value = "auto")]
    raster: Raster,
    /// What is shown: colours, or what the clip does to each splat
    #[arg(long, value_name = "WHAT", default_value = "colour")]
    show: Show,
    /// The order in which splats are blended [default: the scene's]
    ///
    /// glTF asks for distance, other files for depth, as 3DGS does; layers that differ are sorted by depth.
    #[arg(long, value_name = "BY")]
    sort: Option<SortBy>,
    #[command(flatten)]
    precision: PrecisionArgs,
}

/// Which device, and how closely it is watched.
#[derive(Debug, Args)]
#[command(next_help_heading = "Device")]
pub(super) struct DeviceArgs {
    /// Number or part of the name of the device, as rara devices lists them
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// Load the Vulkan validation layer; any message is an error
    ///
    /// The Khronos layer also checks synchronisation.
    #[arg(long)]
    validation: bool,
    /// Compile everything anew, and keep nothing for the next run
    ///
    /// A driver may still keep something itself. By default what is compiled is kept in the folder RARA_CACHE (if
    /// that is empty, nowhere), else in the user's cache folder.
    #[arg(long)]
    no_pipeline_cache: bool,
}

/// The flags of the settings that are not the default, as a user would type them; the mode always, the precision never.
#[cfg(feature = "view")]
pub(super) fn flags(own: &Settings) -> impl Iterator<Item = String> {
    let usual = Settings::default();
    // No flag has the form, and `precision::differences` the precision.
    let (
        mode,
        decay,
        sigma,
        miss,
        trace_all,
        _form,
        background,
        sh_degree,
        raster,
        show,
        sort_by,
        _precision,
    ) = own.fields();
    let colour = |[r, g, b]: [f32; 3]| format!("--background {r},{g},{b}");
    let flags = [
        Some(format!("--mode {}", name(mode))),
        decay.map(|decay| format!("--decay {}", name(decay))),
        flag("sigma", sigma, usual.sigma, text),
        flag("miss", miss, usual.miss, name),
        trace_all.then(|| "--trace-all".into()),
        background.map(colour),
        sh_degree.map(|degree| format!("--sh-degree {degree}")),
        flag("raster", raster, usual.raster, name),
        flag("show", show, usual.show, name),
        sort_by.map(|sort_by| format!("--sort {}", name(sort_by))),
    ];
    flags.into_iter().flatten()
}

impl SettingsArgs {
    pub(super) fn meant(&self) -> Result<Settings, Failure> {
        let defaults = self.look.meant()?;
        Ok(defaults
            .mode(self.mode)
            .decay(self.decay)
            .sigma(self.sigma.unwrap_or(defaults.sigma))
            .miss(self.miss.unwrap_or(defaults.miss))
            .trace_all(self.trace_all))
    }
}

impl LookArgs {
    pub(super) fn meant(&self) -> Result<Settings, Failure> {
        Ok(Settings::default()
            .background(self.background)
            .sh_degree(self.sh_degree)
            .raster(self.raster)
            .show(self.show)
            .sort_by(self.sort)
            .precision(self.precision.meant()))
    }
}

impl DeviceArgs {
    pub(super) fn headless(&self) -> rara::Result<Headless> {
        process::make_drivers_folder();
        Headless::new(&self.meant())
    }

    pub(super) fn meant(&self) -> HeadlessDesc {
        HeadlessDesc::default()
            .device(self.device.clone())
            .validation(self.validation)
            .on_compile(Some(output::Compiling::hook()))
            .pipeline_cache(if self.no_pipeline_cache {
                PipelineCache::Off
            } else {
                PipelineCache::User
            })
    }
}
