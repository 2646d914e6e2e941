//! Lines in the world that a window shows over its picture: where a camera sees them.

use rara::glam::{DVec2, DVec3};
use rara::{Camera, PictureLine, Projection};

/// A line in the world, which [`Windowed`](super::Windowed) draws over its picture. Nothing hides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// The ends of the line, in world units.
    pub ends: [DVec3; 2],
    /// Red, green and blue, each 0 to 1, as the picture's colours are stored.
    pub colour: [f32; 3],
    /// The width of the line, in px.
    pub width: f32,
}

/// What is nearer than this share of the farther end's depth is left out of a line in perspective, since it would be seen
/// too far beside the picture for its numbers.
const NEAREST: f64 = 1e-6;

impl Line {
    /// The part of it that the camera sees, in its picture and not far beside it; `None` where that is nothing.
    pub(crate) fn seen_by(&self, camera: &Camera) -> Option<PictureLine> {
        let ends = projected(self.ends, camera)?;
        // Beside the picture single precision would tell pixels apart no more.
        let margin = f64::from(self.width) + 2.0;
        let size = DVec2::new(camera.width.into(), camera.height.into());
        let [from, to] = within(ends, DVec2::splat(-margin), size + margin)?;
        Some(PictureLine {
            ends: [from.x, from.y, to.x, to.y].map(|v| v as f32),
            colour: self.colour,
            radius: self.width / 2.0,
        })
    }
}

/// Where the camera sees the part of a line that is before it, px.
fn projected(ends: [DVec3; 2], camera: &Camera) -> Option<[DVec2; 2]> {
    let [from, to] = ends.map(|end| camera.rotation * (end - camera.eye));
    let (focal, centre) = (
        DVec2::new(camera.fx, camera.fy),
        DVec2::new(camera.cx, camera.cy),
    );
    if camera.projection == Projection::Orthographic {
        // Such a camera has no eye that anything could be behind.
        return Some([from, to].map(|p| focal * p.truncate() + centre));
    }
    let near = NEAREST * from.z.max(to.z);
    if near <= 0.0 {
        return None;
    }
    // An end behind the eye moves along the line to the nearest depth.
    let before = |end: DVec3, other: DVec3| match end.z < near {
        true => end
            .lerp(other, (near - end.z) / (other.z - end.z))
            .with_z(near),
        false => end,
    };
    let ends = [before(from, to), before(to, from)];
    Some(ends.map(|p| focal * p.truncate() / p.z + centre))
}

/// The part of a line within a rectangle, by the shares of it at which it crosses the sides (Liang and Barsky 1984).
fn within([from, to]: [DVec2; 2], low: DVec2, high: DVec2) -> Option<[DVec2; 2]> {
    let along = to - from;
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        if along[axis] == 0.0 {
            if !(low[axis]..=high[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        let [a, b] = [low, high].map(|side| (side[axis] - from[axis]) / along[axis]);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    // The ends of a line that goes far beyond the picture are rounded far off.
    let at = |share: f64| (from + share * along).clamp(low, high);
    (first <= last && along.is_finite()).then(|| [at(first), at(last)])
}

#[cfg(test)]
mod tests;
