//! A part of a picture, for measures that the rest would dilute.

use rara_base::error::Result;
use rara_scene::picture::Picture;

use crate::differences::same_size;

/// Some of a picture's pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    width: usize,
    inside: Vec<bool>,
}

impl Pixels {
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
mod tests;
