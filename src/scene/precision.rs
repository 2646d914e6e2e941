//! How exactly a frame is stored and computed, where exactness costs time: six choices, and three presets of them.

use half::f16;

use rara_base::limits;
use rara_base::setters;

/// Format of the picture that `Headless` draws into. A host has a format of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum TargetFormat {
    /// 8 bits a channel: each blend rounds, so that thin layers gather error or vanish.
    #[cfg_attr(feature = "clap", value(name = "8"))]
    Unorm8,
    /// 16-bit floats.
    #[cfg_attr(feature = "clap", value(name = "16f"))]
    Half,
    /// 32-bit floats: thousands of thin layers stay exact. A device that cannot blend them gets 16-bit ones, with a warning.
    #[default]
    #[cfg_attr(feature = "clap", value(name = "32f"))]
    Float,
}

impl TargetFormat {
    /// The pixels of an image of this format.
    #[doc(hidden)]
    pub fn decode(self, bytes: &[u8]) -> impl Iterator<Item = [f32; 4]> {
        let channel = move |at: usize| match self {
            Self::Unorm8 => f32::from(bytes[at]) / 255.0,
            Self::Half => f16::from_le_bytes([bytes[2 * at], bytes[2 * at + 1]]).to_f32(),
            Self::Float => f32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * at + byte])),
        };
        let pixels = bytes.len() / self.pixel_bytes() as usize;
        (0..pixels).map(move |at| std::array::from_fn(|c| channel(4 * at + c)))
    }

    /// Bytes of a pixel.
    pub const fn pixel_bytes(self) -> u64 {
        match self {
            Self::Unorm8 => 4,
            Self::Half => 8,
            Self::Float => 16,
        }
    }
}

/// How spherical harmonics lie in device memory. Chosen when a scene is loaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum ShFormat {
    /// 8 bits a coefficient and one scale a Gaussian; the constant term in 16-bit floats. 56 bytes for degree 3.
    #[cfg_attr(feature = "clap", value(name = "8"))]
    Byte,
    /// The constant term in 16-bit floats; each other coefficient's red, green and blue in 11, 11 and 10 bits of its
    /// degree's scale, a power of two: off by a 1023rd and a 511th of the degree's largest at most, unless that is
    /// beyond 65536. 68 bytes for degree 3.
    Packed,
    /// 16-bit floats. 96 bytes for degree 3.
    #[cfg_attr(feature = "clap", value(name = "16f"))]
    Half,
    /// 32-bit floats. 192 bytes for degree 3.
    #[default]
    #[cfg_attr(feature = "clap", value(name = "32f"))]
    Float,
}

/// The normal distribution's Phi in the weight of a cut splat: how it is approximated, and the largest error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum PhiForm {
    /// A logistic of an odd quintic: 1.9e-5.
    #[default]
    Quintic,
    /// A logistic of an odd cubic: 1.4e-4.
    Cubic,
    /// A logistic: 9.5e-3, two levels of 255.
    Logistic,
}

setters! {
    /// The precision that a frame gives up for time.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct Precision {
        /// Format of the picture.
        pub target: TargetFormat,
        /// How spherical harmonics are stored. Takes effect in `Headless::load_as` and
        /// `SceneBuffers::upload`, not frame by frame.
        pub sh: ShFormat,
        /// Phi of the exact mode.
        pub phi: PhiForm,
        /// How many bits of the depths the sort compares at most, 8 to 32; each pass takes eight. They count from the nearest
        /// depth that the scene's bounds allow, so 24 lose nothing unless the farthest is more than four times as far.
        pub key_bits: u32,
        /// Exact mode: a cut splat gets the perspective-exact form where sigma_max / Z exceeds this, else the affine one.
        /// Zero gives all of them the exact form.
        pub beam_switch: f32,
        /// Tiles only: a pixel with less transmittance than this is saturated. What lies behind would change it by less
        /// than this times its colour. Zero blends everything.
        pub transmittance_min: f32,
    }
}

impl Precision {
    /// Least peak signal to noise ratio, decibels, of a picture of this precision against its twin in f64: the smallest
    /// that one of the choices has by itself. Below it something else is wrong.
    pub fn least_psnr(&self) -> f64 {
        // How far the forms of a cut splat and saturation may be off is too little to be seen.
        let (target, sh, phi, key_bits, _beam_switch, _transmittance_min) = self.fields();
        let target: f64 = match target {
            TargetFormat::Unorm8 => 20.0,
            TargetFormat::Half => 40.0,
            TargetFormat::Float => 60.0,
        };
        let sh = match sh {
            ShFormat::Byte => 45.0,
            ShFormat::Half => 58.0,
            // A step of 511 of the degree's largest is far below what the others leave.
            ShFormat::Packed | ShFormat::Float => 60.0,
        };
        let phi = match phi {
            PhiForm::Logistic => 40.0,
            PhiForm::Cubic | PhiForm::Quintic => 60.0,
        };
        let keys = match key_bits {
            ..16 => 20.0,
            16..24 => 40.0,
            24..28 => 55.0,
            _ => 60.0,
        };
        target.min(sh).min(phi).min(keys)
    }
}

impl Default for Precision {
    fn default() -> Self {
        Preset::Balanced.precision()
    }
}

/// A choice of all six; the guide's chapter on modes has what each costs and gives up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Preset {
    /// Nothing is approximated.
    Exact,
    /// Only approximations that no picture shows.
    #[default]
    Balanced,
    /// Only approximations that pictures hardly show.
    Fast,
}

impl Preset {
    /// The precision that the preset stands for.
    pub const fn precision(self) -> Precision {
        let balanced = Precision {
            target: TargetFormat::Float,
            sh: ShFormat::Packed,
            phi: PhiForm::Quintic,
            key_bits: u32::BITS,
            beam_switch: limits::BEAM_SWITCH,
            transmittance_min: 4e-6,
        };
        match self {
            Self::Exact => Precision {
                sh: ShFormat::Float,
                beam_switch: 0.0,
                transmittance_min: 1e-7,
                ..balanced
            },
            Self::Balanced => balanced,
            Self::Fast => Precision {
                phi: PhiForm::Cubic,
                key_bits: 24,
                beam_switch: 0.05,
                transmittance_min: 1e-4,
                ..balanced
            },
        }
    }
}
