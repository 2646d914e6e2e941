//! Outlines that are drawn in the picture by the mouse.

use glam::{DVec2, DVec3};
use rara::{Camera, Projection};

use crate::Line;

/// An outline's corners are no farther from where it was drawn, px.
const NEAR: f64 = 1.5;
/// The colour of an outline that is being drawn, and its width in px.
const DRAWN: ([f32; 3], f32) = ([1.0, 1.0, 1.0], 2.0);

/// An outline with as few corners as follow it (Douglas and Peucker 1973).
pub(super) fn simplified(drawn: &[DVec2]) -> Vec<DVec2> {
    let [first, .., last] = drawn else {
        return drawn.to_vec();
    };
    let mut corners = vec![*first];
    add_corners(drawn, &mut corners);
    if first.distance(*last) <= NEAR {
        corners.pop();
    }
    corners
}

/// Adds the corners of a way but for its first.
fn add_corners(way: &[DVec2], corners: &mut Vec<DVec2>) {
    let mut left = vec![way];
    while let Some(way) = left.pop() {
        let [first, between @ .., last] = way else {
            continue;
        };
        let along = (last - first).normalize_or_zero();
        let distance = |point: &DVec2| {
            let from = point - first;
            from.distance(along * from.dot(along).clamp(0.0, first.distance(*last)))
        };
        let farthest = (0..between.len())
            .map(|at| (distance(&between[at]), at + 1))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match farthest {
            Some((distance, at)) if distance > NEAR => {
                left.push(&way[at..]);
                left.push(&way[..=at]);
            }
            _ => corners.push(*last),
        }
    }
}

/// The lines that show an outline while it is drawn, in a scene of this radius.
pub(super) fn lines(drawn: &[DVec2], camera: &Camera, radius: f64) -> Vec<Line> {
    let point = |pixel: &DVec2| {
        let across = DVec2::new(
            (pixel.x - camera.cx) / camera.fx,
            (pixel.y - camera.cy) / camera.fy,
        );
        let seen: DVec3 = match camera.projection {
            Projection::Perspective => radius * across.extend(1.0),
            Projection::Orthographic => across.extend(radius),
        };
        camera.eye + camera.rotation.transpose() * seen
    };
    let (colour, width) = DRAWN;
    let closing = [drawn.last(), drawn.first()];
    let closing = closing.into_iter().flatten().copied().collect::<Vec<_>>();
    let ways = drawn.windows(2).chain(closing.chunks_exact(2));
    ways.map(|ends| Line {
        ends: [point(&ends[0]), point(&ends[1])],
        colour,
        width,
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_keeps_the_corners_that_it_needs() {
        let way = |corners: &[DVec2]| -> Vec<DVec2> {
            let pieces = corners.windows(2);
            pieces
                .flat_map(|ends| (0..20).map(|at| ends[0].lerp(ends[1], f64::from(at) / 20.0)))
                .collect()
        };
        let square = [(0.0, 0.0), (90.0, 0.0), (90.0, 80.0), (0.0, 80.0)].map(DVec2::from);
        let drawn = way(&[&square[..], &square[..1]].concat());
        let corners = simplified(&drawn);
        for (found, wanted) in corners.iter().zip(&square) {
            assert!(found.distance(*wanted) < 1e-9, "{corners:?}");
        }
        // It was left open, so that its last place is one more.
        assert_eq!(corners.len(), 5);
        let closed = [&drawn[..], &square[..1]].concat();
        assert_eq!(simplified(&closed).len(), 4);
        assert!(simplified(&[]).is_empty() && simplified(&square[..2]).len() == 2);
    }
}
