//! Lines in the world that a window shows over its picture: where a camera sees them.

use glam::{DVec2, DVec3};

use crate::passes::PictureLine;
use rara_scene::camera::{Camera, Projection};

/// A line in the world, which [`Windowed`](super::Windowed) draws over its picture. Nothing hides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its ends, world units.
    pub ends: [DVec3; 2],
    /// Red, green and blue, each 0 to 1, as the picture's colours are stored.
    pub colour: [f32; 3],
    /// Its width, px.
    pub width: f32,
}

/// What is nearer than this share of the farther end's depth is left out of a line in perspective, since it would be seen
/// too far beside the picture for its numbers.
const NEAREST: f64 = 1e-6;

impl Line {
    /// The part of it that the camera sees, in its picture and not far beside it; `None` where that is nothing.
    pub(super) fn seen_by(&self, camera: &Camera) -> Option<PictureLine> {
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
mod tests {
    use super::*;

    fn camera() -> Camera {
        // 100 px a unit of the slope.
        Camera::look_at(
            DVec3::ZERO,
            DVec3::Z,
            DVec3::NEG_Y,
            2.0 * 1.0_f64.atan().to_degrees(),
            (400, 200),
        )
        .unwrap()
    }

    fn seen(from: [f64; 3], to: [f64; 3], camera: &Camera) -> Option<[f32; 4]> {
        let line = Line {
            ends: [from, to].map(DVec3::from),
            colour: [1.0; 3],
            width: 2.0,
        };
        line.seen_by(camera).map(|line| line.ends)
    }

    fn close(a: [f32; 4], b: [f32; 4]) {
        for (a, b) in a.into_iter().zip(b) {
            assert!((a - b).abs() < 1e-3, "{a} is not {b}");
        }
    }

    #[test]
    fn a_line_before_the_eye_is_seen_between_its_ends() {
        let line = seen([-1.0, 0.5, 2.0], [1.0, 0.0, 1.0], &camera());
        close(line.expect("it is seen"), [150.0, 125.0, 300.0, 100.0]);
    }

    #[test]
    fn what_is_behind_the_eye_is_left_out_and_what_is_beside_the_picture_ends_there() {
        let camera = camera();
        assert_eq!(seen([0.0, 0.0, -1.0], [1.0, 0.0, -2.0], &camera), None);
        assert_eq!(seen([9.0, 0.0, 1.0], [9.0, 5.0, 1.0], &camera), None);
        // From straight ahead to the right and behind: it leaves the picture at its right edge, on its way.
        let line = seen([0.0, 0.0, 1.0], [1.0, 0.0, -1.0], &camera);
        close(line.expect("it is seen"), [200.0, 100.0, 404.0, 100.0]);
        // The other way round it is the same line.
        let line = seen([1.0, 0.0, -1.0], [0.0, 0.0, 1.0], &camera);
        close(line.expect("it is seen"), [404.0, 100.0, 200.0, 100.0]);
        // Through the eye itself, and with an end in it.
        assert!(seen([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], &camera).is_some());
        assert!(seen([0.0, 0.0, 0.0], [0.5, 0.0, 1.0], &camera).is_some());
        for far in [1e300, f64::INFINITY, f64::NAN] {
            if let Some(line) = seen([far, 1.0, 2.0], [0.0, 0.0, 1.0], &camera) {
                assert!(line.iter().all(|v| v.is_finite()), "{far}: {line:?}");
            }
        }
    }

    #[test]
    fn a_camera_without_perspective_sees_lines_wherever_they_are_along_its_axis() {
        let size = (400, 200);
        let camera = Camera::orthographic(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 2.0, size).unwrap();
        let line = seen([-1.0, 0.5, -7.0], [1.0, 0.0, 70.0], &camera);
        close(line.expect("it is seen"), [100.0, 150.0, 300.0, 100.0]);
    }
}
