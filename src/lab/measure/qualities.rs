//! The six qualities of a cut that the paper's user study asks for, as numbers. All compare a picture `p` with the truth `t`;
//! `alpha` is a picture's fourth channel, `w` the truth of the scene without a cut.

use super::{Pixels, Popping, compare_within, same_size};
use rara::{Picture, Result};

/// Coverage from which a pixel belongs to what is seen.
const SOLID: f64 = 0.5;
/// Coverage of the whole scene from which an edge is one of the cut and not of the scene's own outline.
const COVERED: f64 = 0.75;
/// Pixels of a piece or hole that counts; a smaller one is not seen.
const LEAST_PIECE: usize = 4;

/// The qualities of one way of cutting in one case. Less is better, except for `naturalness`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Qualities {
    /// Distance between the edge of the cut and the true one, pixels: the mean over the points of one edge of the distance
    /// from the nearest point of the other, averaged over both ways. Edges are where alpha crosses 1/2 and the whole
    /// scene covers 3/4. `None` if the truth has no edge.
    pub flatness: Option<f64>,
    /// Temporal stability: how much more than the truth a pixel changes from step to step of a slow sweep, the mean over
    /// pixels and steps, of 255.
    pub stability: f64,
    /// Topological integrity: pieces and holes of at least four pixels that the truth does not have, and those of the
    /// truth that are missing.
    pub topology: f64,
    /// SSIM in the band around the cut. `None` if the cut changes nothing.
    pub naturalness: Option<f64>,
    /// ROI exposure: the share of the energy of what was removed that still covers the cut, 0 to 1.
    pub exposure: f64,
    /// Context completeness: the share of the energy of what lies behind the cut that is lost, 0 to 1.
    pub completeness: f64,
}

/// What the qualities of a case are measured against.
#[derive(Debug)]
pub struct Truth {
    /// The scene without a cut.
    pub whole: Picture,
    pub cut: Picture,
    /// A cut that removes a little more.
    pub deeper: Picture,
    /// The pixels around the cut.
    pub band: Pixels,
}

impl Truth {
    /// Measures a picture; `popping` is that of a sweep.
    pub fn measure(&self, picture: &Picture, popping: &Popping) -> Result<Qualities> {
        let (_, naturalness) = compare_within(picture, &self.cut, Some(&self.band))?;
        Ok(Qualities {
            flatness: edge_distance(picture, &self.cut, &self.whole)?,
            stability: popping.mean_beyond,
            topology: f64::from(pieces_apart(picture, &self.cut)?),
            naturalness,
            exposure: share_of_way(picture, &self.cut, &self.whole)?,
            completeness: share_of_way(picture, &self.cut, &self.deeper)?,
        })
    }
}

/// How far apart the edges of two pictures are, pixels: the mean over the points of one edge of the distance from the
/// nearest point of the other, averaged over both ways. `None` if the second picture has no edge. If only the first has
/// none, the way from the second counts as the picture's diagonal.
pub fn edge_distance(picture: &Picture, truth: &Picture, whole: &Picture) -> Result<Option<f64>> {
    let (ours, theirs) = (edge(picture, whole)?, edge(truth, whole)?);
    if theirs.is_empty() {
        return Ok(None);
    }
    let farthest = f64::from(picture.width).hypot(f64::from(picture.height));
    let mean = |from: &[[f64; 2]], to: &[[f64; 2]]| {
        let nearest = |p: &[f64; 2]| {
            let squares = to
                .iter()
                .map(|q| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2));
            squares.fold(farthest * farthest, f64::min).sqrt()
        };
        from.iter().map(nearest).sum::<f64>() / from.len().max(1) as f64
    };
    let ways = [mean(&ours, &theirs), mean(&theirs, &ours)];
    Ok(Some(0.5 * (ways[0] + ways[1])))
}

/// The points between neighbouring pixels at which alpha crosses 1/2, where the whole scene covers enough.
fn edge(picture: &Picture, whole: &Picture) -> Result<Vec<[f64; 2]>> {
    same_size(picture, whole)?;
    let (width, height) = (picture.width as usize, picture.height as usize);
    let alpha = |picture: &Picture, x: usize, y: usize| f64::from(picture.pixels[y * width + x][3]);
    let mut points = Vec::new();
    for y in 0..height {
        for x in 0..width {
            for (other_x, other_y) in [(x + 1, y), (x, y + 1)] {
                if other_x >= width || other_y >= height {
                    continue;
                }
                let covered = [(x, y), (other_x, other_y)]
                    .iter()
                    .all(|&(x, y)| alpha(whole, x, y) >= COVERED);
                let (from, to) = (alpha(picture, x, y), alpha(picture, other_x, other_y));
                if covered && (from >= SOLID) != (to >= SOLID) {
                    let share = (SOLID - from) / (to - from);
                    points.push([
                        x as f64 + share * (other_x - x) as f64,
                        y as f64 + share * (other_y - y) as f64,
                    ]);
                }
            }
        }
    }
    Ok(points)
}

/// The number of pieces of what is seen, and of holes in it, that one of the pictures has and the other has not. A piece
/// is a set of solid pixels that touch, also at corners; a hole is a set of others that touch along sides.
pub fn pieces_apart(picture: &Picture, truth: &Picture) -> Result<u32> {
    same_size(picture, truth)?;
    let solid = |picture: &Picture| -> Vec<bool> {
        let pixels = picture.pixels.iter();
        pixels.map(|pixel| f64::from(pixel[3]) >= SOLID).collect()
    };
    let (ours, theirs) = (solid(picture), solid(truth));
    let width = picture.width as usize;
    let mut apart = 0;
    for (a, b) in [(&ours, &theirs), (&theirs, &ours)] {
        for kind in [true, false] {
            apart += unmatched(a, b, width, kind);
        }
    }
    Ok(apart)
}

/// The number of sets of `kind` in `a` that have no pixel of that kind in `b`.
fn unmatched(a: &[bool], b: &[bool], width: usize, kind: bool) -> u32 {
    let height = a.len() / width.max(1);
    let mut seen = vec![false; a.len()];
    let mut count = 0;
    for start in 0..a.len() {
        if seen[start] || a[start] != kind {
            continue;
        }
        let (mut stack, mut size, mut matched) = (vec![start], 0_usize, false);
        seen[start] = true;
        while let Some(at) = stack.pop() {
            size += 1;
            matched |= b[at] == kind;
            let (x, y) = (at % width, at / width);
            for ny in y.saturating_sub(1)..(y + 2).min(height) {
                for nx in x.saturating_sub(1)..(x + 2).min(width) {
                    let next = ny * width + nx;
                    let touches = kind || nx == x || ny == y;
                    if touches && !seen[next] && a[next] == kind {
                        seen[next] = true;
                        stack.push(next);
                    }
                }
            }
        }
        count += u32::from(!matched && size >= LEAST_PIECE);
    }
    count
}

/// How far a picture is on the way from the truth to `other`, 0 to 1: in each pixel the part of its error that points
/// there, at most all of the way, weighted by the length of the way.
pub fn share_of_way(picture: &Picture, truth: &Picture, other: &Picture) -> Result<f64> {
    same_size(picture, truth)?;
    same_size(picture, other)?;
    let (mut gone, mut whole) = (0.0, 0.0);
    for ((p, t), o) in picture.pixels.iter().zip(&truth.pixels).zip(&other.pixels) {
        let (mut dot, mut square) = (0.0, 0.0);
        for channel in 0..4 {
            let way = f64::from(o[channel]) - f64::from(t[channel]);
            dot += way * (f64::from(p[channel]) - f64::from(t[channel]));
            square += way * way;
        }
        if square > 0.0 {
            gone += square.sqrt() * (dot / square).clamp(0.0, 1.0);
            whole += square.sqrt();
        }
    }
    Ok(if whole > 0.0 { gone / whole } else { 0.0 })
}

#[cfg(test)]
mod tests;
