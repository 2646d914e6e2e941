//! Lines, dots and letters in pictures, for charts and labels.

use rara::Picture;

/// Mixes a colour into a pixel; outside of the picture nothing happens.
fn mix(picture: &mut Picture, x: i64, y: i64, colour: [u8; 3], share: f64) {
    let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
        return;
    };
    if x >= picture.width || y >= picture.height || share <= 0.0 {
        return;
    }
    let share = share.min(1.0) as f32;
    let pixel = &mut picture.pixels[y as usize * picture.width as usize + x as usize];
    for (channel, ink) in pixel.iter_mut().zip(colour) {
        *channel += share * (f32::from(ink) / 255.0 - *channel);
    }
    pixel[3] += share * (1.0 - pixel[3]);
}

/// Paints every pixel near a shape by how much nearer its centre is than `radius`, over one pixel.
fn paint(
    picture: &mut Picture,
    [low, high]: [[f64; 2]; 2],
    radius: f64,
    colour: [u8; 3],
    distance: impl Fn([f64; 2]) -> f64,
) {
    let reach = radius + 1.0;
    let first = low.map(|v| (v - reach).max(-1.0).floor() as i64);
    let size = [picture.width, picture.height].map(f64::from);
    let last = [0, 1].map(|axis| (high[axis] + reach).min(size[axis]).ceil() as i64);
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            let from = distance([x as f64 + 0.5, y as f64 + 0.5]);
            mix(picture, x, y, colour, radius + 0.5 - from);
        }
    }
}

/// A line one pixel wide.
pub(super) fn line(picture: &mut Picture, from: [f64; 2], to: [f64; 2], colour: [u8; 3]) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let distance = |[x, y]: [f64; 2]| {
        let (dx, dy) = (x - from[0], y - from[1]);
        let share = if squared > 0.0 {
            ((dx * along[0] + dy * along[1]) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (dx - share * along[0]).hypot(dy - share * along[1])
    };
    let low = [from[0].min(to[0]), from[1].min(to[1])];
    let high = [from[0].max(to[0]), from[1].max(to[1])];
    paint(picture, [low, high], 0.5, colour, distance);
}

/// A filled circle.
pub(super) fn dot(picture: &mut Picture, at: [f64; 2], radius: f64, colour: [u8; 3]) {
    let distance = |[x, y]: [f64; 2]| (x - at[0]).hypot(y - at[1]);
    paint(picture, [at, at], radius, colour, distance);
}

/// Writes small letters and digits with their top left corner at (x, y); capitals become small, what has no glyph is a
/// space. A letter is five dots wide and seven high, each dot `scale` pixels.
pub(super) fn text(
    picture: &mut Picture,
    [x, y]: [f64; 2],
    words: &str,
    scale: i64,
    colour: [u8; 3],
) {
    let (left, top) = (x.round() as i64, y.round() as i64);
    for (place, letter) in (0..).zip(words.chars()) {
        for (row, dots) in (0..).zip(glyph(letter.to_ascii_lowercase())) {
            for column in (0..5).filter(|column| dots >> (4 - column) & 1 == 1) {
                let corner = [left + (6 * place + column) * scale, top + row * scale];
                for dot in 0..scale * scale {
                    let (dx, dy) = (dot % scale, dot / scale);
                    mix(picture, corner[0] + dx, corner[1] + dy, colour, 1.0);
                }
            }
        }
    }
}

/// A letter's rows from the top, the leftmost of five dots being 16.
pub(super) fn glyph(letter: char) -> [u8; 7] {
    match letter {
        '0' => [14, 17, 19, 21, 25, 17, 14],
        '1' => [4, 12, 4, 4, 4, 4, 14],
        '2' => [14, 17, 1, 6, 8, 16, 31],
        '3' => [31, 2, 4, 6, 1, 17, 14],
        '4' => [2, 6, 10, 18, 31, 2, 2],
        '5' => [31, 16, 30, 1, 1, 17, 14],
        '6' => [6, 8, 16, 30, 17, 17, 14],
        '7' => [31, 1, 2, 4, 4, 8, 8],
        '8' => [14, 17, 17, 14, 17, 17, 14],
        '9' => [14, 17, 17, 15, 1, 2, 12],
        'a' => [0, 0, 14, 1, 15, 17, 15],
        'b' => [16, 16, 22, 25, 17, 17, 30],
        'c' => [0, 0, 14, 17, 16, 17, 14],
        'd' => [1, 1, 13, 19, 17, 19, 13],
        'e' => [0, 0, 14, 17, 31, 16, 14],
        'f' => [6, 9, 8, 28, 8, 8, 8],
        'g' => [0, 15, 17, 17, 15, 1, 14],
        'h' => [16, 16, 22, 25, 17, 17, 17],
        'i' => [4, 0, 12, 4, 4, 4, 14],
        'j' => [2, 0, 6, 2, 2, 18, 12],
        'k' => [16, 16, 18, 20, 24, 20, 18],
        'l' => [12, 4, 4, 4, 4, 4, 14],
        'm' => [0, 0, 26, 21, 21, 17, 17],
        'n' => [0, 0, 22, 25, 17, 17, 17],
        'o' => [0, 0, 14, 17, 17, 17, 14],
        'p' => [0, 0, 30, 17, 30, 16, 16],
        'q' => [0, 0, 13, 19, 15, 1, 1],
        'r' => [0, 0, 22, 25, 16, 16, 16],
        's' => [0, 0, 14, 16, 14, 1, 30],
        't' => [8, 8, 30, 8, 8, 9, 6],
        'u' => [0, 0, 17, 17, 17, 19, 13],
        'v' => [0, 0, 17, 17, 17, 10, 4],
        'w' => [0, 0, 17, 17, 21, 21, 10],
        'x' => [0, 0, 17, 10, 4, 10, 17],
        'y' => [0, 0, 17, 17, 15, 1, 14],
        'z' => [0, 0, 31, 2, 4, 8, 31],
        '.' => [0, 0, 0, 0, 0, 12, 12],
        ',' => [0, 0, 0, 0, 12, 4, 8],
        '-' => [0, 0, 0, 31, 0, 0, 0],
        '_' => [0, 0, 0, 0, 0, 0, 31],
        '+' => [0, 4, 4, 31, 4, 4, 0],
        '/' => [0, 1, 2, 4, 8, 16, 0],
        '(' => [2, 4, 8, 8, 8, 4, 2],
        ')' => [8, 4, 2, 2, 2, 4, 8],
        _ => [0; 7],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_dots_cover_what_they_should() {
        let mut picture = Picture::filled(40, 40, [1.0; 4]);
        line(&mut picture, [5.0, 10.5], [35.0, 10.5], [0; 3]);
        assert_eq!(picture.at(20, 10), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(picture.at(20, 12), [1.0; 4]);
        dot(&mut picture, [20.0, 25.0], 4.0, [255, 0, 0]);
        let below_the_line = &picture.pixels[15 * 40..];
        let red: f32 = below_the_line.iter().map(|pixel| 1.0 - pixel[1]).sum();
        assert!((f64::from(red) - std::f64::consts::PI * 16.0).abs() < 1.0);
        // Partly or wholly outside is no harm.
        dot(&mut picture, [-50.0, 1e9], 4.0, [0; 3]);
        line(&mut picture, [-1e7, 20.0], [30.0, 20.0], [0; 3]);
        text(&mut picture, [35.0, 36.0], "edge", 3, [0; 3]);
    }

    #[test]
    fn letters_are_where_they_were_put() {
        let mut picture = Picture::filled(20, 10, [1.0; 4]);
        text(&mut picture, [1.0, 1.0], "L1", 1, [0; 3]);
        assert_eq!(picture.at(3, 1), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(picture.at(9, 1), [0.0, 0.0, 0.0, 1.0]);
        assert!(picture.pixels.iter().filter(|p| p[0] == 0.0).count() > 10);
        for letter in ('a'..='z').chain('0'..='9') {
            assert_ne!(glyph(letter), [0; 7], "{letter}");
        }
    }
}
