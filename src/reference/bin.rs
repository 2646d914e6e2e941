//! Stage `bin` finds which tiles of pixels a splat reaches, row by row of tiles, and the splats of each tile.
//!
//! The contour on which alpha falls to 1/255 is the ellipse `(k0 dx)^2 + (k1 dx + k2 dy)^2 = K^2`. At a height dy its
//! chord has the middle `-k1 k2 dy / k` and the half length `sqrt(k K^2 - (k0 k2 dy)^2) / k`, with `k = k0^2 + k1^2`. Its
//! right end is farthest to the right at the height where `k1 dx + k2 dy` is zero, and its left end opposite of that. So the
//! ends of a row of tiles are the chord's at whichever of the row's heights is nearest to those.

use super::real::Real;
use rara_base::limits::{ALPHA_MIN_INVERSE, TILE_HEIGHT, TILE_WIDTH};

/// A splat's outline, as the rasteriser knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline<T> {
    /// The centre, pixels.
    pub centre: [T; 2],
    /// The Cholesky factor k0, k1, k2 of the footprint's inverse covariance, 1/pixels.
    pub conic: [T; 3],
    /// Opacity at the centre, 0 to 1.
    pub opacity: T,
    /// First and last x, and first and last y, of the quad that it is drawn with, pixels.
    pub quad: [[T; 2]; 2],
    /// A cut splat is cut away where `line[0] + line[1] dx + line[2] dy` is negative.
    pub line: Option<[T; 3]>,
}

/// The tiles of one row that a splat reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    pub row: u32,
    /// First and last (exclusive) column of tiles.
    pub columns: [u32; 2],
}

impl<T: Real> Outline<T> {
    /// How far beyond the contour a tile still counts, pixels. Near the contour's ends its chord is the root of a
    /// difference, which is off by the root of single precision.
    pub fn margin(&self) -> T {
        let [x, y] = self.centre.map(|c| c.abs());
        T::of(0.01) + T::of(4e-4) * self.extent() / self.conic[0] + T::of(1e-6) * x.max(y)
    }

    fn extent(&self) -> T {
        let brightness = self.opacity * T::of(f64::from(ALPHA_MIN_INVERSE));
        (T::of(2.0) * brightness.ln()).max(T::zero()).sqrt()
    }

    /// The tiles of a picture of `size` pixels that the splat reaches, with a margin in pixels.
    pub fn spans(&self, size: [u32; 2], margin: T) -> Vec<Span> {
        let ([k0, k1, k2], extent) = (self.conic, self.extent());
        let k = k0 * k0 + k1 * k1;
        let tip = -k1 / k2 * (extent / k0);
        let slope = -k1 * k2 / k;
        let reach = extent * k.sqrt() / (k0 * k2) + margin;
        let [cx, cy] = self.centre;
        let top = self.quad[1][0].max(cy - reach);
        let bottom = self.quad[1][1].min(cy + reach);
        let Some([first, last]) = tiles_between(top, bottom, size[1], TILE_HEIGHT) else {
            return Vec::new();
        };
        let half = |y: T| {
            let rest = k0 * k2 * y;
            (k * (extent * extent) - rest * rest).max(T::zero()).sqrt() / k
        };
        let in_row = |row: u32| {
            let top = T::of(f64::from(row * TILE_HEIGHT) + 0.5) - cy;
            let bottom = (top + T::of(f64::from(TILE_HEIGHT - 1))).min(reach);
            let top = top.max(-reach);
            let nearest = |y: T| y.max(top).min(bottom);
            let (right_at, left_at) = (nearest(tip), nearest(-tip));
            let mut left = cx + slope * left_at - half(left_at) - margin;
            let mut right = cx + slope * right_at + half(right_at) + margin;
            // Comparisons, unlike max() and min(), leave the quad's sides where the ends are no numbers.
            left = if left > self.quad[0][0] {
                left
            } else {
                self.quad[0][0]
            };
            right = if right < self.quad[0][1] {
                right
            } else {
                self.quad[0][1]
            };
            if let Some([at, along, down]) = self.line {
                let least = at + (down * top).max(down * bottom);
                let edge = cx - least / along;
                if along > T::zero() {
                    left = left.max(edge - margin);
                } else if along < T::zero() {
                    right = right.min(edge + margin);
                } else if least < T::zero() {
                    return None;
                }
            }
            let columns = tiles_between(left, right, size[0], TILE_WIDTH)?;
            Some(Span { row, columns })
        };
        (first..last).filter_map(in_row).collect()
    }
}

/// First and last (exclusive) tile with a pixel centre in an interval.
fn tiles_between<T: Real>(low: T, high: T, pixels: u32, side: u32) -> Option<[u32; 2]> {
    let half = T::of(0.5);
    let first = (low - half).ceil().max(T::zero());
    let last = (high - half).floor().min(T::of(f64::from(pixels) - 1.0));
    (first <= last).then(|| [first.wide() as u32 / side, last.wide() as u32 / side + 1])
}

/// The place in the list of all at which each tile's splats begin, and that list: for each tile, row by row, the splats
/// that reach it in their order.
pub fn bin(spans: &[Vec<Span>], order: &[u32], tiles: [u32; 2]) -> (Vec<u32>, Vec<u32>) {
    let [columns, rows] = tiles;
    let mut lists = vec![Vec::new(); (columns * rows) as usize];
    for &splat in order {
        for span in &spans[splat as usize] {
            for column in span.columns[0]..span.columns[1] {
                lists[(span.row * columns + column) as usize].push(splat);
            }
        }
    }
    let mut begins = vec![0];
    for list in &lists {
        begins.push(begins[begins.len() - 1] + list.len() as u32);
    }
    (begins, lists.concat())
}
