//! Stage `sort`: front to back.

use super::project::Splat;
use super::real::Real;

/// Orders splats by the depth of their centres, nearest first; equal depths keep the scene's order.
pub fn sort<T: Real>(splats: &mut [Splat<T>]) {
    splats.sort_by(|a, b| {
        let depths = a.footprint.centre.z.partial_cmp(&b.footprint.centre.z);
        depths
            .expect("depths are finite")
            .then(a.index.cmp(&b.index))
    });
}
