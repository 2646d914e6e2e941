//! Maps of errors: how far each pixel of a picture is from that of another one, as colours.

use rara::{Picture, Result};

use crate::charts::sequential;
use crate::measure::{change, same_size};

/// The difference that has the darkest colour, on a scale of 0 to 255; larger ones look the same.
pub const MOST: f64 = 100.0;
/// The difference at which colours begin, on that scale; smaller ones are white.
pub const LEAST: f64 = 0.1;

/// An opaque picture that shows the largest difference of a channel in each pixel, from light to dark on a logarithmic
/// scale from [`LEAST`] to [`MOST`]. Equal steps of the scale look equal.
pub fn error_map(a: &Picture, b: &Picture) -> Result<Picture> {
    same_size(a, b)?;
    let mut map = a.clone();
    for (pixel, (a, b)) in map.pixels.iter_mut().zip(a.pixels.iter().zip(&b.pixels)) {
        *pixel = colour(change(a, b));
    }
    Ok(map)
}

pub fn scale(width: u32, height: u32) -> Picture {
    let mut picture = Picture::filled(width, height, [1.0; 4]);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        let x = (i as u32 % width.max(1)) as f64 / f64::from(width.max(2) - 1);
        *pixel = colour(LEAST * (MOST / LEAST).powf(x));
    }
    picture
}

pub fn place(difference: f64) -> f64 {
    ((difference / LEAST).ln() / (MOST / LEAST).ln()).clamp(0.0, 1.0)
}

fn colour(difference: f64) -> [f32; 4] {
    if difference < LEAST {
        return [1.0; 4];
    }
    let [r, g, b] = sequential(place(difference)).map(|c| f32::from(c) / 255.0);
    [r, g, b, 1.0]
}

/// The left and the top edge of the square of `side` pixels in which two pictures differ most.
pub fn worst_square(a: &Picture, b: &Picture, side: u32) -> Result<[u32; 2]> {
    same_size(a, b)?;
    let (width, height) = (a.width as usize, a.height as usize);
    // Sums over all pixels to the left and above.
    let mut sums = vec![0.0; (width + 1) * (height + 1)];
    for y in 0..height {
        for x in 0..width {
            let at = (y + 1) * (width + 1) + x + 1;
            sums[at] = sums[at - 1] + sums[at - width - 1] - sums[at - width - 2]
                + change(&a.pixels[y * width + x], &b.pixels[y * width + x]);
        }
    }
    let side = (side as usize).min(width).min(height);
    let (mut most, mut best) = (f64::NEG_INFINITY, [0, 0]);
    for top in 0..=height - side {
        for left in 0..=width - side {
            let at = |x: usize, y: usize| sums[y * (width + 1) + x];
            let sum = at(left + side, top + side) - at(left, top + side) - at(left + side, top)
                + at(left, top);
            if sum > most {
                (most, best) = (sum, [left as u32, top as u32]);
            }
        }
    }
    Ok(best)
}

/// Puts a part into a picture, its upper left corner at [left, top], as far as there is room.
pub fn put(whole: &mut Picture, part: &Picture, [left, top]: [u32; 2]) {
    let left = left.min(whole.width);
    let count = part.width.min(whole.width - left) as usize;
    let rows = part.pixels.chunks(part.width.max(1) as usize);
    for (y, row) in (top..whole.height).zip(rows) {
        let begin = y as usize * whole.width as usize + left as usize;
        whole.pixels[begin..begin + count].copy_from_slice(&row[..count]);
    }
}

/// A part of a picture, each pixel `scale` pixels wide.
pub fn magnified(picture: &Picture, [left, top]: [u32; 2], side: u32, scale: u32) -> Picture {
    let mut part = Picture::filled(side * scale, side * scale, [0.0; 4]);
    for (i, pixel) in part.pixels.iter_mut().enumerate() {
        let (x, y) = (i as u32 % (side * scale), i as u32 / (side * scale));
        let (x, y) = (left + x / scale, top + y / scale);
        if x < picture.width && y < picture.height {
            *pixel = picture.pixels[(y * picture.width + x) as usize];
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_white_where_nothing_differs_and_darker_where_more_does() {
        let a = Picture::filled(3, 1, [0.5, 0.5, 0.5, 1.0]);
        let mut b = a.clone();
        b.pixels[1][1] += 1.0 / 255.0;
        b.pixels[2][1] -= 0.4;
        let map = error_map(&a, &b).unwrap();
        let bright = |x: usize| map.pixels[x][..3].iter().sum::<f32>();
        assert_eq!(map.pixels[0], [1.0; 4]);
        assert!(
            bright(0) > bright(1) && bright(1) > bright(2) + 0.5,
            "{map:?}"
        );
        assert!(map.pixels.iter().all(|p| p[3] == 1.0));
        let scale = scale(64, 1);
        let brightness = |p: &[f32; 4]| 0.3 * p[0] + 0.6 * p[1] + 0.1 * p[2];
        // A step of 8 bits may be rounded the other way.
        let falls = |p: &[[f32; 4]]| brightness(&p[0]) + 1.0 / 255.0 >= brightness(&p[1]);
        assert!(scale.pixels.windows(2).all(falls));
    }

    #[test]
    fn the_worst_square_is_around_what_differs() {
        let a = Picture::filled(20, 12, [0.0; 4]);
        let mut b = a.clone();
        for (x, y) in [(13, 7), (14, 8), (15, 9)] {
            b.pixels[y * 20 + x][0] = 1.0;
        }
        let [left, top] = worst_square(&a, &b, 4).unwrap();
        assert!(
            (12..=13).contains(&left) && (6..=7).contains(&top),
            "{left} {top}"
        );
        let part = magnified(&b, [left, top], 4, 2);
        let red = part.pixels.iter().filter(|p| p[0] == 1.0).count();
        assert_eq!((part.width, red), (8, 12));
        assert!(worst_square(&a, &Picture::filled(3, 3, [0.0; 4]), 4).is_err());
    }
}
