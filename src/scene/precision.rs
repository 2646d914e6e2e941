//! How exactly a frame is stored and computed, where exactness costs time: six choices, and three presets of them.

use half::f16;

use crate::setting::settings;
use rara_base::{limits, named};

named! {
    /// The format of the picture that `Headless` draws into. A host chooses the format of its own target.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum TargetFormat {
        /// 8 bits per channel. Each blend rounds, so many faint splats add up to a visible error, or vanish.
        Unorm8 = "8",
        /// 16-bit floats.
        Half = "16f",
        /// 32-bit floats. Thousands of faint splats stay exact. A device that cannot blend them gets 16-bit floats, with a warning.
        #[default]
        Float = "32f",
    }
}

impl TargetFormat {
    /// Returns the pixels of an image of this format.
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

named! {
    /// The storage of spherical harmonics in device memory. It is chosen when a scene is loaded.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum ShFormat {
        /// 8 bits per coefficient, with one scale per Gaussian. The constant term has 16-bit floats. Degree 3 takes 56 bytes.
        Byte = "8",
        /// 11, 11 and 10 bits for the red, green and blue of each coefficient, with one scale per degree, a power of two. The error
        /// is at most 1/1023 of the largest coefficient of the degree (1/511 for blue), if that is at most 65536. The constant term
        /// has 16-bit floats. Degree 3 takes 68 bytes.
        Packed = "packed",
        /// 16-bit floats. Degree 3 takes 96 bytes.
        Half = "16f",
        /// 32-bit floats. Degree 3 takes 192 bytes.
        #[default]
        Float = "32f",
    }
}

named! {
    /// The approximation of the normal distribution function Phi in the weight of a cut splat.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum PhiForm {
        /// A logistic function of an odd quintic. The largest error is 1.9e-5.
        #[default]
        Quintic = "quintic",
        /// A logistic function of an odd cubic. The largest error is 1.4e-4.
        Cubic = "cubic",
        /// A logistic function. The largest error is 9.5e-3, which is more than two of 255 levels.
        Logistic = "logistic",
    }
}

settings! {
    /// The precision that a frame gives up for time. The storage of spherical harmonics takes effect when a scene is loaded or
    /// uploaded (`Headless::load_as`, `SceneBuffers::upload`), not frame by frame.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct Precision {
        /// Format in which a picture is blended: 8 bits, 16-bit floats or 32-bit floats a channel.
        pub target: TargetFormat as "target-format"(Precision, "FORMAT"),
        /// How spherical harmonics are stored on the device.
        ///
        /// A coefficient is stored as a float of 32 bits (32f) or 16 bits (16f), in 10 or 11 bits with a scale for each degree
        /// (packed), or in 8 bits with a scale for each Gaussian (8).
        pub sh: ShFormat as "sh-format"(Precision, "FORMAT"),
        /// Mode exact: the approximation of the normal distribution function.
        ///
        /// The largest errors are 1.9e-5 (quintic), 1.4e-4 (cubic) and 9.5e-3 (logistic).
        pub phi: PhiForm as "phi"(Precision, "FORM"),
        /// How many bits of a depth the sort compares at most, 8 to 32.
        ///
        /// Each pass of the sort compares 8 bits. 24 bits are exact if the largest depth in the
        /// scene is at most four times the smallest.
        pub key_bits: u32 as "key-bits"(Precision, "N", |n| (8..=32).contains(n), "a number from 8 to 32"),
        /// Mode exact: the ratio sigma/depth above which a splat's weight is exact in perspective.
        ///
        /// sigma is the largest standard deviation of the splat, and depth how far its centre is in front of the camera. If the
        /// ratio is smaller, the weight is computed as if the rays of all pixels were parallel. 0 makes all cut splats exact in
        /// perspective.
        pub beam_switch: f32 as "beam-switch"(
            Precision, "X", |x| *x >= 0.0 && x.is_finite(), "a finite number, zero or above"
        ),
        /// Tiles: the transmittance below which a pixel counts as saturated, from 0 to below 1.
        ///
        /// Once a pixel is saturated, the splats behind are not blended. They would change the pixel by less than this
        /// transmittance times their colour. With 0, all splats are blended.
        pub transmittance_min: f32 as "transmittance-min"(
            Precision, "X", |x| (0.0..1.0).contains(x), "a number from zero to below 1"
        ),
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

named! {
    /// A choice of all six fields of [`Precision`]. The guide's chapter on modes says what each preset costs and how exact it is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Preset {
        /// The smallest errors that rara can reach.
        Exact = "exact",
        /// Approximations whose errors cannot be seen in pictures.
        #[default]
        Balanced = "balanced",
        /// Approximations whose errors can hardly be seen in pictures.
        Fast = "fast",
    }
}

impl Preset {
    /// Returns the precision that the preset stands for.
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
