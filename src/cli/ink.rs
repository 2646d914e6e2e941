//! Lines, dots and letters in pictures, for charts and labels.

use std::convert::Infallible;

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::{FONT_6X10, FONT_8X13, FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
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

/// Paints every pixel near a shape, with a share that falls from one to zero over one pixel around the distance `radius`.
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

/// A font of fixed width.
#[derive(Debug, Clone, Copy)]
pub(super) enum Font {
    /// Capitals are seven dots high and letters six wide.
    Small,
    /// Nine and eight.
    #[cfg_attr(not(feature = "view"), allow(dead_code))]
    Middle,
    /// Eleven and nine.
    Large,
}

/// Writes with the top left corner of the first letter, if it is a capital, at (x, y). Each dot of the font is so many pixels;
/// what is not ASCII becomes a question mark.
pub(super) fn text(
    picture: &mut Picture,
    [x, y]: [f64; 2],
    words: &str,
    (font, scale): (Font, i64),
    colour: [u8; 3],
) {
    // The lowest row of a capital, counted from 0.
    let (font, baseline) = match font {
        Font::Small => (&FONT_6X10, 6),
        Font::Middle => (&FONT_8X13, 8),
        Font::Large => (&FONT_9X18_BOLD, 10),
    };
    let mut dots = Dots {
        picture,
        corner: [x, y].map(|v| v.round() as i64),
        scale,
        colour,
    };
    let style = MonoTextStyle::new(font, BinaryColor::On);
    let Ok(_end) = Text::new(words, Point::new(0, baseline), style).draw(&mut dots);
}

/// The picture that the font's dots are painted into, as squares.
struct Dots<'a> {
    picture: &'a mut Picture,
    corner: [i64; 2],
    scale: i64,
    colour: [u8; 3],
}

impl OriginDimensions for Dots<'_> {
    fn size(&self) -> Size {
        Size::new(self.picture.width, self.picture.height)
    }
}

impl DrawTarget for Dots<'_> {
    type Color = BinaryColor;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, dots: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<BinaryColor>>,
    {
        for Pixel(at, colour) in dots {
            if colour.is_off() {
                continue;
            }
            let [left, top] = self.corner;
            let (left, top) = (
                left + i64::from(at.x) * self.scale,
                top + i64::from(at.y) * self.scale,
            );
            for y in top..top + self.scale {
                for x in left..left + self.scale {
                    mix(self.picture, x, y, self.colour, 1.0);
                }
            }
        }
        Ok(())
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
        // Text that is partly or wholly outside does no harm.
        dot(&mut picture, [-50.0, 1e9], 4.0, [0; 3]);
        line(&mut picture, [-1e7, 20.0], [30.0, 20.0], [0; 3]);
        text(&mut picture, [35.0, 36.0], "edge", (Font::Small, 3), [0; 3]);
    }

    #[test]
    fn letters_are_where_they_were_put() {
        let mut picture = Picture::filled(20, 10, [1.0; 4]);
        text(&mut picture, [1.0, 1.0], "L1", (Font::Small, 1), [0; 3]);
        let black = |x, y| picture.at(x, y) == [0.0, 0.0, 0.0, 1.0];
        let left = (1..8).all(|y| black(1, y));
        assert!(left && (1..6).all(|x| black(x, 7)), "an L from (1, 1)");
        assert!((1..8).all(|y| black(9, y)), "a 1 beside it");
        assert!((0..20).all(|x| !black(x, 0) && !black(x, 8)));
    }

    #[test]
    fn every_letter_has_a_shape_of_its_own_at_any_scale() {
        let drawn = |letter: char, scale: i64| {
            let mut picture = Picture::filled(24, 36, [1.0; 4]);
            text(
                &mut picture,
                [3.0, 6.0],
                &letter.to_string(),
                (Font::Small, scale),
                [0; 3],
            );
            picture
        };
        let letters: Vec<char> = ('!'..='~').collect();
        for (place, &letter) in letters.iter().enumerate() {
            let small = drawn(letter, 1);
            assert_ne!(small, Picture::filled(24, 36, [1.0; 4]), "{letter}");
            for &other in &letters[..place] {
                assert_ne!(small, drawn(other, 1), "{letter} and {other}");
            }
            let ink = |picture: &Picture| picture.pixels.iter().filter(|p| p[0] == 0.0).count();
            assert_eq!(ink(&drawn(letter, 3)), 9 * ink(&small), "{letter}");
        }
        assert_eq!(drawn('é', 1), drawn('?', 1));
    }
}
