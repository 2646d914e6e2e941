//! Letters in pictures, for labels.

use std::convert::Infallible;
use std::ops::Range;

use super::Picture;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::{FONT_6X10, FONT_8X13, FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;

/// Fills columns and rows as far as they are in the picture.
pub fn fill(picture: &mut Picture, [columns, rows]: [Range<i64>; 2], colour: [u8; 3]) {
    let [r, g, b] = colour.map(|ink| f32::from(ink) / 255.0);
    let width = i64::from(picture.width);
    for y in rows.start.max(0)..rows.end.min(picture.height.into()) {
        for x in columns.start.max(0)..columns.end.min(width) {
            picture.pixels[(y * width + x) as usize] = [r, g, b, 1.0];
        }
    }
}

/// A font of fixed width.
#[derive(Debug, Clone, Copy)]
pub enum Font {
    /// Capitals are seven dots high and letters six wide.
    Small,
    /// Nine and eight.
    Middle,
    /// Eleven and nine.
    Large,
}

/// Writes with the top left corner of the first letter, if it is a capital, at (x, y). Each dot of the font is so many pixels;
/// what is not ASCII becomes a question mark.
pub fn text(
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
            let square = [(left, at.x), (top, at.y)].map(|(corner, dot)| {
                let begin = corner + i64::from(dot) * self.scale;
                begin..begin + self.scale
            });
            fill(self.picture, square, self.colour);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
