//! The laws by which a cut splat is weighted, from the settings.

use crate::types;
use rara_scene::precision::PhiForm;
use rara_scene::settings::{Decay, Miss, Settings};

/// The settings of a cut splat's weight, whatever the mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Laws {
    /// `DECAY_*`.
    pub(super) decay: u32,
    /// `MISS_*`.
    pub(super) miss: u32,
    /// `PHI_*`.
    pub(super) phi: u32,
}

impl Laws {
    /// Takes them from the settings.
    pub(crate) fn from_settings(settings: &Settings) -> Self {
        Self {
            decay: match settings.decay_law() {
                Decay::Linear => types::DECAY_LINEAR,
                Decay::Depth => types::DECAY_DEPTH,
            },
            miss: match settings.miss {
                Miss::Keep => types::MISS_KEEP,
                Miss::Drop => types::MISS_DROP,
                Miss::Peak => types::MISS_PEAK,
            },
            phi: match settings.precision.phi {
                PhiForm::Quintic => types::PHI_QUINTIC,
                PhiForm::Cubic => types::PHI_CUBIC,
                PhiForm::Logistic => types::PHI_LOGISTIC,
            },
        }
    }
}
