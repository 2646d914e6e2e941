//! The outline and the rim of a cut surface, drawn onto a picture of it.

use super::Picture;
use rara_base::error::{Error, Result};

/// The marks that are drawn at the edge of a cut surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Cues {
    /// A line along the edge, half of it on each side.
    pub outline: Option<Cue>,
    /// A tint that is strongest at the edge and ends this far inside.
    pub rim: Option<Cue>,
    /// The alpha, 0 to 1, from which a pixel of the slice belongs to the cut surface. A higher value leaves more holes where
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

/// A colour and a width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cue {
    /// Red, green and blue, 0 to 1.
    pub colour: [f32; 3],
    /// The width, in pixels.
    pub width: f32,
}

/// The share of a rim's colour at the edge.
const RIM_STRENGTH: f32 = 0.6;

impl Picture {
    /// Draws the marks at the edge of the cut surface that a slice shows. The picture must show the scene cut by the plane of
    /// the slice, from the same camera.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a slice of another size, and for a width that is not a
    /// number above zero.
    pub fn draw_cues(&mut self, slice: &Self, cues: &Cues) -> Result<()> {
        if (self.width, self.height) != (slice.width, slice.height) {
            return Err(Error::Invalid(format!(
                "the slice has {}x{} pixels and the picture {}x{}; give two of one size",
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

impl Picture {
    /// Makes the cut surface that this slice shows opaque: all that has at least an alpha of `level`, 0 to 1. What has less
    /// fades in proportion, so that the surface keeps a soft edge. The colours stay.
    pub fn make_opaque(&mut self, level: f32) {
        for pixel in &mut self.pixels {
            let alpha = pixel[3];
            if alpha > 0.0 {
                let factor = (alpha / level).min(1.0) / alpha;
                *pixel = pixel.map(|value| value * factor);
                pixel[3] = pixel[3].min(1.0);
            }
        }
    }

    /// Puts the picture in front of a colour, red, green and blue from 0 to 1.
    pub fn put_before(&mut self, background: [f32; 3]) {
        for pixel in &mut self.pixels {
            let rest = 1.0 - pixel[3];
            for (value, behind) in pixel.iter_mut().zip(background) {
                *value += rest * behind;
            }
            pixel[3] = 1.0;
        }
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
mod tests;
