//! Stage `sort` orders the splats front to back.

use std::cmp::Ordering;

use super::project::Splat;
use super::real::Real;
use rara_scene::SortBy;

/// Orders splats by the depth or the distance of their centres, nearest first; equal ones keep the scene's order.
pub fn sort<T: Real>(splats: &mut [Splat<T>], by: SortBy) {
    splats.sort_by(|a, b| {
        let keys = [a, b].map(|splat| match by {
            SortBy::Depth => splat.footprint.view_centre.z,
            SortBy::Distance => splat.footprint.view_centre.squared(),
        });
        nearest_first(keys, [a.index, b.index])
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
    let depths = a.partial_cmp(&b).expect("centres are finite");
    depths.then(indices[0].cmp(&indices[1]))
}
