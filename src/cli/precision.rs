//! The flags that give up exactness for time.

use clap::Args;
use rara::{PhiForm, Precision, Preset, ShFormat, TargetFormat};

use super::values;
#[cfg(feature = "view")]
use super::values::{flag, name, text};

/// The precision that is given up for time. A single choice overrides the preset's.
#[derive(Debug, Args)]
#[command(next_help_heading = "Precision")]
pub(super) struct PrecisionArgs {
    /// A choice of all the following
    ///
    /// The guide (src/guide/modes.md) has what each costs and gives up.
    #[arg(long, default_value = "balanced")]
    pub(super) preset: Preset,
    /// Channels of the target: 8 bits, or floats of 16 or 32
    #[arg(long, value_name = "FORMAT")]
    target_format: Option<TargetFormat>,
    /// Storage of spherical harmonics on the device
    ///
    /// Floats of 32 or 16 bits, 11 bits and a scale for each degree (packed), or 8 bits and a scale for each
    /// Gaussian.
    #[arg(long, value_name = "FORMAT")]
    sh_format: Option<ShFormat>,
    /// Mode exact: approximation of the normal distribution
    ///
    /// The forms are off by at most 2e-5, 1.4e-4 or 1e-2.
    #[arg(long, value_name = "FORM")]
    phi: Option<PhiForm>,
    /// Bits of the depths that the sort compares, at most
    ///
    /// Each pass of the sort takes 8.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=32))]
    key_bits: Option<u32>,
    /// Mode exact: sigma/depth from which the form in perspective is used
    ///
    /// 0 uses that form for all cut splats.
    #[arg(long, value_name = "X", value_parser = switch, allow_hyphen_values = true)]
    beam_switch: Option<f32>,
    /// Tiles: transmittance at which a pixel is saturated
    ///
    /// What lies behind is left out; 0 blends everything.
    #[arg(long, value_name = "X", value_parser = transmittance, allow_hyphen_values = true)]
    transmittance_min: Option<f32>,
}

impl PrecisionArgs {
    pub(super) fn meant(&self) -> Precision {
        let preset = self.preset.precision();
        let (target, sh, phi, key_bits, beam_switch, transmittance_min) = preset.fields();
        preset
            .target(self.target_format.unwrap_or(target))
            .sh(self.sh_format.unwrap_or(sh))
            .phi(self.phi.unwrap_or(phi))
            .key_bits(self.key_bits.unwrap_or(key_bits))
            .beam_switch(self.beam_switch.unwrap_or(beam_switch))
            .transmittance_min(self.transmittance_min.unwrap_or(transmittance_min))
    }
}

/// The single flags that make `preset` into `own`, as a user would type them.
#[cfg(feature = "view")]
pub(super) fn differences(own: Precision, preset: Precision) -> impl Iterator<Item = String> {
    let (target, sh, phi, key_bits, beam_switch, transmittance_min) = own.fields();
    let flags = [
        flag("target-format", target, preset.target, name),
        flag("sh-format", sh, preset.sh, name),
        flag("phi", phi, preset.phi, name),
        flag("key-bits", key_bits, preset.key_bits, text),
        flag("beam-switch", beam_switch, preset.beam_switch, text),
        flag(
            "transmittance-min",
            transmittance_min,
            preset.transmittance_min,
            text,
        ),
    ];
    flags.into_iter().flatten()
}

fn switch(text: &str) -> Result<f32, String> {
    let is = |x: f32| x >= 0.0 && x.is_finite();
    values::number(text, is, "a finite number, zero or above")
}

fn transmittance(text: &str) -> Result<f32, String> {
    let is = |x: f32| (0.0..1.0).contains(&x);
    values::number(text, is, "a number from zero to below 1")
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::FromArgMatches as _;

    fn meant(flags: &str) -> Precision {
        let command = PrecisionArgs::augment_args(clap::Command::new("rara").no_binary_name(true));
        let matches = command.get_matches_from(flags.split_whitespace());
        PrecisionArgs::from_arg_matches(&matches).unwrap().meant()
    }

    #[test]
    fn single_flags_override_the_preset() {
        assert_eq!(meant(""), Precision::default());
        assert_eq!(meant("--preset fast"), Preset::Fast.precision());
        let mixed = meant("--preset fast --target-format 32f --key-bits 24 --phi logistic");
        assert_eq!(mixed.target, TargetFormat::Float);
        assert_eq!((mixed.key_bits, mixed.phi), (24, PhiForm::Logistic));
        assert_eq!(mixed.sh, Preset::Fast.precision().sh);
        assert_eq!(meant("--sh-format 8 --beam-switch 0").sh, ShFormat::Byte);
        assert!(transmittance("1").is_err() && transmittance("0").is_ok());
        assert!(switch("-1").is_err() && switch("nan").is_err() && switch("0").is_ok());
    }
}
