//! The choices that are compared: every mode, law and preset, and every choice of precision by itself.

use rara::{
    Decay, ExactForm, Miss, Mode, PhiForm, Preset, Raster, Settings, ShFormat, TargetFormat,
};

#[derive(Debug, Clone)]
pub(crate) struct Variant {
    pub(crate) name: &'static str,
    pub(crate) flags: &'static str,
    pub(crate) settings: Settings,
}

pub fn names() -> Vec<&'static str> {
    let all = variants(Settings::default()).into_iter();
    all.map(|variant| variant.name).collect()
}

/// All choices, on top of what the command line says about everything else. Choices that store spherical harmonics in the
/// same way follow each other.
pub(crate) fn variants(look: Settings) -> Vec<Variant> {
    let variant = |name, flags, settings| Variant {
        name,
        flags,
        settings,
    };
    let mode = |mode| look.mode(mode);
    let exact = mode(Mode::Exact);
    let rara = |sigma, miss, decay| mode(Mode::Rara).sigma(sigma).miss(miss).decay(decay);
    let precise = |precision| exact.precision(precision);
    let base = look.precision;
    let target = |target| precise(base.target(target));
    let sh = |sh| precise(base.sh(sh));
    let phi = |phi| precise(base.phi(phi));
    let keys = |key_bits| precise(base.key_bits(key_bits));
    let switch = |beam_switch| precise(base.beam_switch(beam_switch));
    let saturated = |transmittance_min| precise(base.transmittance_min(transmittance_min));
    let quads = exact.raster(Raster::Quad);
    let keep = rara(1.0, Miss::Keep, None);
    let drop = rara(3.0, Miss::Drop, None);
    let linear = exact.decay(Some(Decay::Linear));
    let affine = exact.form(ExactForm::Affine);
    vec![
        variant("none", "--mode none", mode(Mode::None)),
        variant("hard", "--mode hard", mode(Mode::Hard)),
        variant("rara, paper", "--mode rara --sigma 1 --miss keep", keep),
        variant("rara, released", "--mode rara --miss drop", drop),
        variant("rara", "--mode rara", mode(Mode::Rara)),
        variant(
            "rara, depth law",
            "--mode rara --decay depth",
            rara(look.sigma, look.miss, Some(Decay::Depth)),
        ),
        variant("exact, linear law", "--decay linear", linear),
        variant("exact", "", exact),
        variant("exact, all affine", "--beam-switch 1e9", affine),
        variant("switch 0.0025", "--beam-switch 0.0025", switch(0.0025)),
        variant("switch 0.01", "--beam-switch 0.01", switch(0.01)),
        variant("switch 0.02", "--beam-switch 0.02", switch(0.02)),
        variant("switch 0.05", "--beam-switch 0.05", switch(0.05)),
        variant("saturated 0", "--transmittance-min 0", saturated(0.0)),
        variant(
            "saturated 1e-4",
            "--transmittance-min 1e-4",
            saturated(1e-4),
        ),
        variant("quads", "--raster quad", quads),
        variant("phi cubic", "--phi cubic", phi(PhiForm::Cubic)),
        variant("phi logistic", "--phi logistic", phi(PhiForm::Logistic)),
        variant("keys 24", "--key-bits 24", keys(24)),
        variant("keys 16", "--key-bits 16", keys(16)),
        variant(
            "target 16f",
            "--target-format 16f",
            target(TargetFormat::Half),
        ),
        variant(
            "target 8",
            "--target-format 8",
            target(TargetFormat::Unorm8),
        ),
        variant(
            "preset fast",
            "--preset fast",
            precise(Preset::Fast.precision()),
        ),
        variant(
            "preset exact",
            "--preset exact",
            precise(Preset::Exact.precision()),
        ),
        variant("sh 32f", "--sh-format 32f", sh(ShFormat::Float)),
        variant("sh 16f", "--sh-format 16f", sh(ShFormat::Half)),
        variant("sh 8", "--sh-format 8", sh(ShFormat::Byte)),
    ]
}

#[cfg(test)]
mod tests;
