//! Maps of errors: how far each pixel of a picture is from that of another one, as colours.

use rara_base::error::Result;
use rara_scene::picture::Picture;

use crate::differences::same_size;

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

/// The largest difference of a channel of two pixels, on a scale of 0 to 255.
pub fn change(before: &[f32; 4], after: &[f32; 4]) -> f64 {
    let channels = before.iter().zip(after);
    channels
        .map(|(a, b)| 255.0 * (f64::from(*a) - f64::from(*b)).abs())
        .fold(0.0, f64::max)
}

/// The colour of a value from 0, light, to 1, dark blue: equal steps look equal.
fn sequential(value: f64) -> [u8; 3] {
    let value = value.clamp(0.0, 1.0);
    let chroma = 0.13 * (std::f64::consts::PI * (0.15 + 0.7 * value)).sin();
    oklch(0.97 - 0.65 * value, chroma, 100.0 + 165.0 * value)
}

/// A colour of Björn Ottosson's Oklab (2020), in which equal distances look about equal: lightness, chroma, and the hue
/// in degrees.
pub fn oklch(lightness: f64, chroma: f64, hue: f64) -> [u8; 3] {
    let (b, a) = hue.to_radians().sin_cos();
    let (a, b) = (chroma * a, chroma * b);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s,
    ];
    linear.map(|c| {
        let c = c.clamp(0.0, 1.0);
        let encoded = if c <= 0.003_130_8 {
            12.92 * c
        } else {
            1.055 * c.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * encoded).round() as u8
    })
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
mod tests;
