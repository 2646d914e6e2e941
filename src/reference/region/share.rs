//! A pixel's share of a splat that several surfaces cut.

use crate::orthant::orthant;
use crate::real::Real;
use crate::threshold::Threshold;
use rara_scene::clip::ClipOp;

/// The share of a splat in one pixel that is kept by all surfaces, or by any.
pub fn share<T: Real>(op: ClipOp, surfaces: impl Iterator<Item = Threshold<T>>) -> T {
    match op {
        ClipOp::And => orthant(surfaces),
        ClipOp::Or => T::one() - orthant(surfaces.map(Threshold::complement)),
    }
}
