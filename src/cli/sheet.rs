//! Contact sheets: pictures in rows, a label over each.

use rara::{Picture, Result};
use rara_scene::picture::ink;

use super::memory;

/// Pixels between two pictures.
pub(super) const GAP: u32 = 4;
/// Colour of what is between the pictures.
pub(super) const MARGIN: [f32; 4] = [0.25, 0.25, 0.25, 1.0];
const INK: [u8; 3] = [255; 3];

/// A sheet that is filled with pictures of one size, row by row.
pub(super) struct Sheet {
    picture: Picture,
    size: (u32, u32),
    columns: u32,
    count: u32,
}

impl Sheet {
    /// An empty sheet with room for so many pictures of a size, in so many columns; of 0 columns there are as many as make it
    /// about square.
    pub(super) fn new(size: (u32, u32), count: u32, columns: u32) -> Result<Self> {
        let (.., band) = lettering(size.0);
        let (width, height) = (size.0 + GAP, band + size.1 + GAP);
        let square = (f64::from(count) * f64::from(height) / f64::from(width)).sqrt();
        let columns = match columns {
            0 => square.round() as u32,
            columns => columns,
        };
        let columns = columns.clamp(1, count.max(1));
        let (across, down) = (
            columns * width - GAP,
            count.div_ceil(columns) * height - GAP,
        );
        memory::check_picture((across, down), 0)?;
        Ok(Self {
            picture: Picture::filled(across, down, MARGIN),
            size,
            columns,
            count: 0,
        })
    }

    /// Puts the next picture on the sheet.
    pub(super) fn add(&mut self, label: &str, picture: &Picture) {
        let (width, height) = self.size;
        let (font, scale, band) = lettering(width);
        let (column, row) = (self.count % self.columns, self.count / self.columns);
        let corner = [column * (width + GAP), row * (band + height + GAP)];
        let mut words = Picture::filled(width, band, MARGIN);
        ink::text(
            &mut words,
            [2.0 * f64::from(scale); 2],
            &short(label),
            (font, scale.into()),
            INK,
        );
        paste(&mut self.picture, &words, corner);
        paste(&mut self.picture, picture, [corner[0], corner[1] + band]);
        self.count += 1;
    }

    pub(super) fn picture(&self) -> &Picture {
        &self.picture
    }
}

/// A label whose numbers have four decimals at most.
fn short(label: &str) -> String {
    let mut decimals = None;
    let fits = |letter: &char| {
        decimals = match (decimals, letter) {
            (_, '.') => Some(0),
            (Some(before), '0'..='9') => Some(before + 1),
            _ => None,
        };
        decimals.is_none_or(|count| count <= 4)
    };
    label.chars().filter(fits).collect()
}

/// The letters over pictures of a width: their font, how many pixels its dots have, and how high the label is.
fn lettering(width: u32) -> (ink::Font, u32, u32) {
    match (width, width / 200) {
        (0..256, _) => (ink::Font::Small, 1, 11),
        (_, scale) => (ink::Font::Large, scale, 22 * scale),
    }
}

/// Puts a picture on another one, as far as it reaches.
pub(super) fn paste(onto: &mut Picture, picture: &Picture, [left, top]: [u32; 2]) {
    let width = picture.width.min(onto.width.saturating_sub(left)) as usize;
    let rows = picture.pixels.chunks_exact(picture.width.max(1) as usize);
    let below = onto.pixels.chunks_exact_mut(onto.width.max(1) as usize);
    for (to, from) in below.skip(top as usize).zip(rows) {
        to[left as usize..][..width].copy_from_slice(&from[..width]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rara::Mode;

    #[test]
    fn every_mode_can_be_labelled() {
        for mode in Mode::ALL {
            assert!(mode.name().chars().all(|letter| letter.is_ascii_graphic()));
        }
    }

    #[test]
    fn numbers_in_labels_are_short() {
        assert_eq!(short("axial=0.28571428571428575"), "axial=0.2857");
        assert_eq!(short("z@-12.123456 of 3.5.ply"), "z@-12.1234 of 3.5.ply");
        assert_eq!(short("2.7182818x2.7182818"), "2.7182x2.7182");
    }

    #[test]
    fn pictures_stand_in_rows() {
        let red = Picture::filled(12, 10, [1.0, 0.0, 0.0, 1.0]);
        let blue = Picture::filled(12, 10, [0.0, 0.0, 1.0, 1.0]);
        let mut sheet = Sheet::new((12, 10), 3, 2).expect("a sheet");
        sheet.add("x", &red);
        sheet.add("a label that is longer than its picture", &blue);
        sheet.add("", &red);
        let made = sheet.picture();
        assert_eq!((made.width, made.height), (28, 11 + 10 + 4 + 11 + 10));
        assert_eq!(made.at(0, 11), [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(made.at(12, 11), MARGIN);
        assert_eq!(made.at(16, 11), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(made.at(27, 20), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(made.at(11, 45), [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(made.at(16, 36), MARGIN);
        let across = |count| Sheet::new((640, 360), count, 0).expect("a sheet").columns;
        assert_eq!([1, 2, 9, 400].map(across), [1, 1, 2, 16]);
    }
}
