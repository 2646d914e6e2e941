//! Stage `sort` orders the splats front to back.

use std::cmp::Ordering;

use super::project::Splat;
use super::real::Real;

/// Orders splats by the depth of their centres, nearest first; equal depths keep the scene's order.
pub fn sort<T: Real>(splats: &mut [Splat<T>]) {
    splats.sort_by(|a, b| {
        let depths = [a, b].map(|splat| splat.footprint.view_centre.z);
        nearest_first(depths, [a.index, b.index])
    });
}

/// The places of splats, front to back, by the depths of their centres and their indices in the scene.
pub fn order<T: Real>(depths: &[T], indices: &[u32]) -> Vec<u32> {
    let mut places: Vec<u32> = (0..).take(depths.len()).collect();
    places.sort_by(|&a, &b| {
        let [a, b] = [a, b].map(|place| place as usize);
        nearest_first([depths[a], depths[b]], [indices[a], indices[b]])
    });
    places
}

fn nearest_first<T: Real>([a, b]: [T; 2], indices: [u32; 2]) -> Ordering {
    let depths = a.partial_cmp(&b).expect("depths are finite");
    depths.then(indices[0].cmp(&indices[1]))
}
