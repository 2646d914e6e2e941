//! The outline and the rim of a cut surface, drawn onto a picture of it.

use super::Picture;
use rara_base::error::{Error, Result};

/// What is drawn of a cut surface's edge, beside its colours.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Cues {
    /// A line along the edge, half of it on each side.
    pub outline: Option<Cue>,
    /// A tint that is strongest at the edge and ends this far inside.
    pub rim: Option<Cue>,
    /// The alpha from which a pixel of the slice belongs to the cut surface, 0 to 1: the higher, the more holes it has where
    /// the scene is translucent.
    pub level: f32,
}

impl Default for Cues {
    fn default() -> Self {
        Self {
            outline: None,
            rim: None,
            level: 0.1,
        }
    }
}

/// A colour and how wide it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cue {
    /// Red, green and blue, 0 to 1.
    pub colour: [f32; 3],
    /// Pixels.
    pub width: f32,
}

/// The share of a rim's colour at the edge.
const RIM_STRENGTH: f32 = 0.6;

impl Picture {
    /// Draws the cues of the surface that a slice covers. A picture is a surface's where it
    /// shows the scene cut by the slice's plane, from the same camera.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a slice of another size, and for a width that is not a
    /// number above zero.
    pub fn draw_cues(&mut self, slice: &Self, cues: &Cues) -> Result<()> {
        if (self.width, self.height) != (slice.width, slice.height) {
            return Err(Error::Invalid(format!(
                "a slice of {}x{} is no slice of a picture of {}x{}",
                slice.width, slice.height, self.width, self.height
            )));
        }
        for cue in [cues.outline, cues.rim].into_iter().flatten() {
            if !(cue.width.is_finite() && cue.width > 0.0) {
                return Err(Error::Invalid(format!(
                    "a cue of width {} cannot be drawn; give a number of pixels above zero",
                    cue.width
                )));
            }
        }
        if cues.outline.is_none() && cues.rim.is_none() {
            return Ok(());
        }
        let distances = distances(slice, cues.level);
        for (pixel, distance) in self.pixels.iter_mut().zip(distances) {
            if let Some(rim) = cues.rim.filter(|_| distance > 0.0) {
                let share = RIM_STRENGTH * (1.0 - distance / rim.width).max(0.0);
                // Only what is there is tinted.
                let alpha = pixel[3];
                over(pixel, rim.colour, share, alpha);
            }
            if let Some(outline) = cues.outline {
                let share = (0.5 * outline.width + 0.5 - distance.abs()).clamp(0.0, 1.0);
                over(pixel, outline.colour, share, 1.0);
            }
        }
        Ok(())
    }
}

/// Blends a share of a colour with an alpha over a pixel.
fn over(pixel: &mut [f32; 4], colour: [f32; 3], share: f32, alpha: f32) {
    let [r, g, b] = colour.map(|c| c * alpha);
    for (value, colour) in pixel.iter_mut().zip([r, g, b, alpha]) {
        *value += share * (colour - *value);
    }
}

/// How far each pixel's centre is from the edge of what a slice covers, pixels, positive inside. The edge lies half way
/// between the centres of neighbours on its two sides.
fn distances(slice: &Picture, level: f32) -> Vec<f32> {
    let covered: Vec<bool> = slice.pixels.iter().map(|pixel| pixel[3] >= level).collect();
    let size = (slice.width as usize, slice.height as usize);
    let to_others = nearest(&covered, false, size);
    let to_covered = nearest(&covered, true, size);
    let both = to_others.into_iter().zip(to_covered);
    let signed = covered
        .iter()
        .zip(both)
        .map(|(&inside, (out, within))| match inside {
            true => out.sqrt() - 0.5,
            false => 0.5 - within.sqrt(),
        });
    signed.collect()
}

/// The square of the distance from each pixel's centre to that of the nearest pixel that is `wanted`: along the columns, and
/// then along the rows, whose least distances are those below all of the parabolas that the columns stand for (Felzenszwalb and
/// Huttenlocher, "Distance Transforms of Sampled Functions").
fn nearest(mask: &[bool], wanted: bool, (width, height): (usize, usize)) -> Vec<f32> {
    // Farther than any pixel, and its square is finite.
    let far = (width + height) as f32 * 2.0;
    let mut squares = vec![far * far; mask.len()];
    for x in 0..width {
        let mut sweep = |rows: &mut dyn Iterator<Item = usize>| {
            let mut distance = far;
            for y in rows {
                distance = if mask[y * width + x] == wanted {
                    0.0
                } else {
                    (distance + 1.0).min(far)
                };
                let square = &mut squares[y * width + x];
                *square = square.min(distance * distance);
            }
        };
        sweep(&mut (0..height));
        sweep(&mut (0..height).rev());
    }
    let mut hull = Vec::<(usize, f64)>::with_capacity(width);
    for row in squares.chunks_mut(width.max(1)) {
        hull.clear();
        // Each parabola of the lower hull, and from where on it is the lowest. The squares of columns beyond 4096 have more
        // digits than single precision, and their differences are what counts.
        for (x, &square) in row.iter().enumerate() {
            let crossing = |&(other, _): &(usize, f64)| {
                let (at, before) = (x as f64, other as f64);
                let squares = f64::from(square) - f64::from(row[other]);
                (squares + at * at - before * before) / (2.0 * (at - before))
            };
            while hull.last().is_some_and(|last| crossing(last) <= last.1) {
                hull.pop();
            }
            let from = hull.last().map_or(f64::NEG_INFINITY, crossing);
            hull.push((x, from));
        }
        let mut lowest = 0;
        let least: Vec<f32> = (0..row.len())
            .map(|x| {
                while hull.get(lowest + 1).is_some_and(|next| next.1 <= x as f64) {
                    lowest += 1;
                }
                let at = hull[lowest].0;
                let aside = x as f32 - at as f32;
                row[at] + aside * aside
            })
            .collect();
        row.copy_from_slice(&least);
    }
    squares
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of alpha in a picture.
    fn disc(size: u32, radius: f32) -> Picture {
        let middle = size as f32 / 2.0;
        let pixel = |at: u32| {
            let (x, y) = ((at % size) as f32 + 0.5, (at / size) as f32 + 0.5);
            let alpha = f32::from(u8::from((x - middle).hypot(y - middle) < radius));
            [0.0, 0.0, 0.0, alpha]
        };
        Picture {
            width: size,
            height: size,
            pixels: (0..size * size).map(pixel).collect(),
        }
    }

    #[test]
    fn distances_are_those_to_the_nearest_pixel_of_the_other_side() {
        let (size, radius) = (40_usize, 11.0);
        let slice = disc(size as u32, radius);
        let covered: Vec<bool> = slice.pixels.iter().map(|p| p[3] > 0.5).collect();
        let ours = distances(&slice, 0.5);
        for at in 0..size * size {
            let apart = |other: usize| {
                let (x, y) = ((at % size) as f32, (at / size) as f32);
                (x - (other % size) as f32).hypot(y - (other / size) as f32)
            };
            let others = (0..size * size).filter(|&other| covered[other] != covered[at]);
            let least = others.map(apart).fold(f32::INFINITY, f32::min) - 0.5;
            let expected = if covered[at] { least } else { -least };
            assert!(
                (ours[at] - expected).abs() < 1e-4,
                "{at}: {} and {expected}",
                ours[at]
            );
        }
    }

    #[test]
    fn distances_are_right_at_the_end_of_a_long_row() {
        let (width, height) = (9000_usize, 3_usize);
        let mut slice = Picture::filled(width as u32, height as u32, [0.0; 4]);
        let covered: Vec<(usize, usize)> = (0..width / 7).map(|i| (7 * i, i % height)).collect();
        for (x, y) in &covered {
            slice.pixels[y * width + x] = [1.0; 4];
        }
        for (at, &ours) in distances(&slice, 0.5).iter().enumerate() {
            let (x, y) = (at % width, at / width);
            let apart =
                |&(to, row): &(usize, usize)| (x as f64 - to as f64).hypot(y as f64 - row as f64);
            // The nearest is among these, since each seventh column has one.
            let near = x.saturating_sub(21) / 7..(x / 7 + 4).min(covered.len());
            let least = covered[near]
                .iter()
                .map(apart)
                .fold(f64::INFINITY, f64::min);
            let expected = if least == 0.0 { 0.5 } else { 0.5 - least };
            assert!(
                (f64::from(ours) - expected).abs() < 1e-3,
                "{x}, {y}: {ours} and {expected}"
            );
        }
    }

    #[test]
    fn cues_stay_near_the_edge_and_nothing_is_drawn_without() {
        let slice = disc(64, 20.0);
        let grey = Picture::filled(64, 64, [0.5, 0.5, 0.5, 1.0]);
        let mut drawn = grey.clone();
        drawn
            .draw_cues(&slice, &Cues::default())
            .expect("nothing to draw");
        assert_eq!(drawn, grey);
        let cue = |colour, width| Some(Cue { colour, width });
        let cues = Cues {
            outline: cue([1.0, 0.0, 0.0], 2.0),
            rim: cue([0.0, 0.0, 1.0], 8.0),
            ..Cues::default()
        };
        drawn
            .draw_cues(&slice, &cues)
            .expect("a slice of the same size");
        assert_eq!(drawn.at(32, 32), grey.at(32, 32), "the middle");
        assert_eq!(drawn.at(2, 2), grey.at(2, 2), "outside");
        let on_line = drawn.at(32 + 19, 32);
        assert!(on_line[0] > 0.9 && on_line[2] < 0.1, "{on_line:?}");
        let on_rim = drawn.at(32 + 15, 32);
        assert!(on_rim[2] > 0.6 && on_rim[0] < 0.4, "{on_rim:?}");
        // Of a slice that covers nothing, or everything, there is no edge.
        for alpha in [0.0, 1.0] {
            let mut drawn = grey.clone();
            let all = Picture::filled(64, 64, [0.0, 0.0, 0.0, alpha]);
            drawn.draw_cues(&all, &cues).expect("the same size");
            assert_eq!(drawn, grey);
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let mut picture = Picture::filled(4, 4, [0.0; 4]);
        let other = Picture::filled(4, 5, [0.0; 4]);
        assert!(picture.draw_cues(&other, &Cues::default()).is_err());
        for width in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let cue = Cue {
                colour: [1.0; 3],
                width,
            };
            let cues = Cues {
                outline: Some(cue),
                ..Cues::default()
            };
            let slice = picture.clone();
            assert!(picture.draw_cues(&slice, &cues).is_err(), "{width}");
        }
    }
}
