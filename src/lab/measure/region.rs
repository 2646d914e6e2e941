//! A part of a picture, for measures that the rest would dilute.

use super::same_size;
use rara::{Picture, Result};

/// Some of a picture's pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    width: usize,
    inside: Vec<bool>,
}

impl Region {
    /// The pixels of which any channel differs between two pictures by more than `threshold` (of 1).
    pub fn where_different(a: &Picture, b: &Picture, threshold: f32) -> Result<Self> {
        same_size(a, b)?;
        let differs = |(a, b): (&[f32; 4], &[f32; 4])| {
            a.iter().zip(b).any(|(a, b)| (a - b).abs() > threshold)
        };
        Ok(Self {
            width: a.width as usize,
            inside: a.pixels.iter().zip(&b.pixels).map(differs).collect(),
        })
    }

    /// The region widened by `radius` pixels in each direction: every pixel within a square of that half side about one
    /// inside.
    pub fn dilated(&self, radius: usize) -> Self {
        let (width, height) = (self.width, self.inside.len() / self.width);
        let near = |line: &dyn Fn(usize) -> bool, length: usize, at: usize| {
            (at.saturating_sub(radius)..(at + radius + 1).min(length)).any(line)
        };
        let across: Vec<bool> = (0..width * height)
            .map(|i| near(&|x| self.inside[i / width * width + x], width, i % width))
            .collect();
        let down = |i: usize| near(&|y| across[y * width + i % width], height, i / width);
        Self {
            width,
            inside: (0..width * height).map(down).collect(),
        }
    }

    pub fn share(&self) -> f64 {
        let inside = self.inside.iter().filter(|&&inside| inside).count();
        inside as f64 / self.inside.len() as f64
    }

    /// Mean of one value per pixel over the pixels inside; `None` if there are none.
    pub(super) fn mean(&self, values: &[f64]) -> Option<f64> {
        let inside = values
            .iter()
            .zip(&self.inside)
            .filter(|(_, inside)| **inside);
        let (sum, count) = inside.fold((0.0, 0_usize), |(sum, n), (v, _)| (sum + v, n + 1));
        (count > 0).then(|| sum / count as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dilated_pixel_is_a_square_cut_off_at_the_edges() {
        let a = Picture::filled(9, 7, [0.0; 4]);
        let mut b = a.clone();
        b.pixels[3 * 9 + 4][2] = 0.5;
        let spot = Region::where_different(&a, &b, 0.4).unwrap();
        assert_eq!(spot.share(), 1.0 / 63.0);
        assert_eq!(spot.dilated(2).share(), 25.0 / 63.0);
        assert_eq!(spot.dilated(0), spot);
        assert_eq!(Region::where_different(&a, &b, 0.6).unwrap().share(), 0.0);
        b.pixels[0][0] = 1.0;
        let both = Region::where_different(&a, &b, 0.4).unwrap();
        assert_eq!(both.dilated(1).share(), (9.0 + 4.0) / 63.0);
        assert_eq!(both.dilated(9).share(), 1.0);
    }

    #[test]
    fn means_are_over_what_is_inside() {
        let a = Picture::filled(2, 2, [0.0; 4]);
        let mut b = a.clone();
        let nothing = Region::where_different(&a, &b, 0.0).unwrap();
        assert_eq!(nothing.mean(&[1.0; 4]), None);
        b.pixels[1][3] = 1.0;
        b.pixels[2][3] = 1.0;
        let two = Region::where_different(&a, &b, 0.0).unwrap();
        assert_eq!(two.mean(&[9.0, 1.0, 2.0, 9.0]), Some(1.5));
        assert!(Region::where_different(&a, &Picture::default(), 0.0).is_err());
    }
}
