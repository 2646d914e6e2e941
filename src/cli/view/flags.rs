//! The flags that draw again what the viewer shows.

use rara::clip::Expression;
use rara::{ClipOp, Precision, Preset, Settings};

use super::cut::Cut;
use crate::cli::settings::name;

/// The flags of `rara render` for a clip and settings, as a user would type them. They leave out defaults.
pub(super) fn flags(cut: &Cut, settings: &Settings) -> String {
    let mut flags = Vec::new();
    let expressions = cut.expressions();
    // Shells take some of an expression's characters for their own.
    flags.extend(expressions.iter().map(|expression| match expression {
        Expression::Shape(shape) if shape.is_outside() => format!("--clip '{shape}'"),
        Expression::Shape(shape) => format!("--clip {shape}"),
        other => format!("--clip-expr '{other}'"),
    }));
    if expressions.len() > 1 && cut.op() == ClipOp::Or {
        flags.push("--clip-op or".into());
    }
    flags.push(format!("--mode {}", name(settings.mode)));
    add_settings(&mut flags, settings);
    add_precision(&mut flags, &settings.precision);
    flags.join(" ")
}

fn add_settings(flags: &mut Vec<String>, settings: &Settings) {
    let Settings {
        decay,
        sigma,
        miss,
        trace_all,
        background,
        sh_degree,
        raster,
        show,
        ..
    } = *settings;
    let default = Settings::default();
    if let Some(decay) = decay {
        flags.push(format!("--decay {}", name(decay)));
    }
    if sigma != default.sigma {
        flags.push(format!("--sigma {sigma}"));
    }
    if miss != default.miss {
        flags.push(format!("--miss {}", name(miss)));
    }
    if trace_all {
        flags.push("--trace-all".into());
    }
    if let Some([r, g, b]) = background {
        flags.push(format!("--background {r},{g},{b}"));
    }
    if let Some(degree) = sh_degree {
        flags.push(format!("--sh-degree {degree}"));
    }
    if raster != default.raster {
        flags.push(format!("--raster {}", name(raster)));
    }
    if show != default.show {
        flags.push(format!("--show {}", name(show)));
    }
}

/// Adds the preset that leaves the fewest single flags, and those flags.
fn add_precision(flags: &mut Vec<String>, precision: &Precision) {
    // The default preset comes first, since it needs no flag.
    let presets = [
        (Preset::Balanced, None),
        (Preset::Exact, Some("--preset exact")),
        (Preset::Fast, Some("--preset fast")),
    ];
    let written = presets.map(|(preset, flag)| {
        let mut flags: Vec<String> = flag.map(Into::into).into_iter().collect();
        flags.extend(differences(precision, &preset.precision()));
        flags
    });
    let fewest = written.into_iter().min_by_key(Vec::len);
    flags.extend(fewest.unwrap_or_default());
}

/// The single flags that make `preset` into `precision`.
fn differences(precision: &Precision, preset: &Precision) -> Vec<String> {
    let Precision {
        target,
        sh,
        phi,
        key_bits,
        beam_switch,
        transmittance_min,
        ..
    } = *precision;
    let mut flags = Vec::new();
    if target != preset.target {
        flags.push(format!("--target-format {}", name(target)));
    }
    if sh != preset.sh {
        flags.push(format!("--sh-format {}", name(sh)));
    }
    if phi != preset.phi {
        flags.push(format!("--phi {}", name(phi)));
    }
    if key_bits != preset.key_bits {
        flags.push(format!("--key-bits {key_bits}"));
    }
    if beam_switch != preset.beam_switch {
        flags.push(format!("--beam-switch {beam_switch}"));
    }
    if transmittance_min != preset.transmittance_min {
        flags.push(format!("--transmittance-min {transmittance_min}"));
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::clip::ClipArgs;
    use crate::cli::settings::SettingsArgs;
    use clap::{Args as _, FromArgMatches as _};
    use glam::DVec3;
    use rara::Plane;

    /// The clip and the settings that flags mean.
    fn meant(flags: &str) -> (Cut, Settings) {
        let command = clap::Command::new("rara").no_binary_name(true);
        let command = SettingsArgs::augment_args(ClipArgs::augment_args(command));
        let matches = command.try_get_matches_from(flags.split_whitespace());
        let matches = matches.unwrap_or_else(|error| panic!("{flags}: {error}"));
        let settings = SettingsArgs::from_arg_matches(&matches).unwrap();
        let clip = ClipArgs::from_arg_matches(&matches).unwrap();
        let cut = Cut::new(clip.expressions().unwrap(), clip.op(), DVec3::ZERO);
        (cut, settings.meant().unwrap())
    }

    /// The flags that are written for the clip and the settings of `typed`.
    fn written(typed: &str) -> String {
        let (cut, settings) = meant(typed);
        flags(&cut, &settings)
    }

    #[test]
    fn what_was_typed_is_what_draws_it_again() {
        for typed in [
            "--mode exact",
            "--clip plane:0,0,-1,0.25 --mode hard",
            "--clip plane:0,0,1,0.1 --clip plane:1,0,0,-2 --clip-op or --mode none",
            "--mode rara --decay depth --sigma 1.7 --miss keep --trace-all",
            "--mode rara --decay linear --miss drop",
            "--mode exact --background 0.1,0.2,0.7 --sh-degree 0 --raster quad --show weight",
            "--mode exact --raster mesh",
            "--mode exact --raster tiles",
            "--mode exact --preset fast",
            "--mode exact --preset exact",
            "--mode exact --preset exact --phi logistic --key-bits 20",
            "--mode exact --target-format 8 --sh-format 8",
            "--mode exact --target-format 16f --sh-format 16f --phi cubic",
            "--mode exact --preset fast --sh-format 32f",
            "--mode exact --beam-switch 0.0123 --transmittance-min 0.0000003",
        ] {
            assert_eq!(written(typed), typed);
        }
    }

    #[test]
    fn nothing_is_left_out_by_accident() {
        let text = format!("{:?}", Settings::default());
        let words = text.split(|letter: char| !(letter.is_alphanumeric() || "_:".contains(letter)));
        let settings: Vec<&str> = words.filter_map(|word| word.strip_suffix(':')).collect();
        let written = [
            "mode",
            "decay",
            "sigma",
            "miss",
            "trace_all",
            "background",
            "sh_degree",
            "raster",
            "show",
            "precision",
            "target",
            "sh",
            "phi",
            "key_bits",
            "beam_switch",
            "transmittance_min",
        ];
        let without_a_flag = ["form"];
        for setting in settings {
            assert!(
                written.contains(&setting) || without_a_flag.contains(&setting),
                "{setting} is new: write its flag, then name it here"
            );
        }
    }

    #[test]
    fn no_number_is_rounded() {
        let normal = DVec3::new(0.1, -0.7, 1.0 / 3.0);
        let plane = Plane::new(normal, 1e-9 / 7.0).unwrap();
        let settings = Settings::default()
            .background(Some([1.0 / 3.0, f32::MIN_POSITIVE, 0.1 + 0.2]))
            .sigma(1e-7 / 3.0)
            .precision(Precision::default().beam_switch(1e20 / 7.0));
        let typed = vec![Expression::Shape(plane.into())];
        let cut = Cut::new(typed, ClipOp::And, DVec3::ZERO);
        let (read, again) = meant(&flags(&cut, &settings));
        assert_eq!(again, settings);
        let read = read.plane();
        assert!((read.normal() - plane.normal()).length() < 1e-15);
        assert!((read.offset() / plane.offset() - 1.0).abs() < 1e-15);
    }
}
