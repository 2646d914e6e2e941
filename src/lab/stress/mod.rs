//! The stress suite: scenes and cuts at the edges of what single precision can hold, each drawn on the GPU and
//! compared with the reference in double precision.
//!
//! A [`Regime`] is a kind of difficulty and builds [`Case`]s: a scene, a camera and a clip. [`run`] draws them in every
//! form of the cut and measures. `rara-lab stress` prints the table, `tests/pictures/stress.rs` holds it to the targets.

#![forbid(unsafe_code)]

mod files;
mod frames;
mod make;
mod measure;
mod meshes;
mod places;
mod planes;
mod regions;
mod shapes;

use rara::{Camera, Clip, Gaussians};

pub use files::regimes as files;
pub use frames::regimes as frames;
pub use measure::{FormRow, RegimeRow, run};
pub use meshes::regimes as meshes;
pub use places::regimes as places;
pub use planes::regimes as planes;
pub use regions::regimes as regions;
pub use shapes::regimes as shapes;

/// Largest error of alpha times weight in a pixel that a regime may show, unless it states its own limit.
pub const TARGET: f64 = 2e-4;
/// The factor of it on GPUs. Vulkan allows them errors in divisions and square roots that are several times those of CPUs.
const COARSE: f64 = 2.0;

/// A scene, a view of it and a cut.
#[derive(Debug, Clone)]
pub struct Case {
    pub scene: Gaussians,
    pub camera: Camera,
    pub clip: Clip,
    /// True when the footprints are apart: a pixel's alpha is then that of one splat, and shows its weight.
    pub apart: bool,
}

/// A limit where single precision ends: what a regime is allowed instead of the target, and why.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// Largest error of alpha times weight.
    pub weight: f64,
    /// Least peak signal to noise ratio of a picture, decibels.
    pub psnr: f64,
    pub reason: &'static str,
}

#[derive(Debug, Clone)]
pub struct Regime {
    pub name: &'static str,
    /// The limit of a regime that cannot meet the target.
    pub limit: Option<Limit>,
    /// Largest error of a colour in any pixel, for regimes in which the usual two levels of 255 in a thousandth of the
    /// pixels are too many: an order of splats is wrong or right.
    pub exact: Option<f64>,
    /// True when there is nothing to draw.
    pub empty: bool,
    pub cases: fn() -> Vec<Case>,
}

impl Regime {
    /// A regime that has to meet the target.
    const fn new(name: &'static str, cases: fn() -> Vec<Case>) -> Self {
        Self {
            name,
            limit: None,
            exact: None,
            empty: false,
            cases,
        }
    }

    /// The same with a limit of its own.
    const fn limited(self, weight: f64, psnr: f64, reason: &'static str) -> Self {
        Self {
            limit: Some(Limit {
                weight,
                psnr,
                reason,
            }),
            ..self
        }
    }

    /// The same with every pixel's colour held to `error`.
    const fn exact(self, error: f64) -> Self {
        Self {
            exact: Some(error),
            ..self
        }
    }
}

pub fn regimes() -> Vec<Regime> {
    [
        shapes(),
        places(),
        planes(),
        regions(),
        meshes(),
        frames(),
        files(),
    ]
    .concat()
}
