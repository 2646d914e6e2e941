//! `--scale-bar` and `--letters`: how large the picture of a section is, and which way it is seen.

use clap::Args;
use glam::DVec3;
use rara::{Camera, Picture, Projection};
use rara_scene::picture::ink;

use super::failure::Failure;
use super::values;

rara_base::named! {
    /// The letters of directions.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Letters {
        /// Left, right, anterior, posterior, superior and inferior, for scenes in DICOM's coordinates.
        Dicom = "dicom",
        /// The same for scenes in NIfTI's coordinates, whose x and y are reversed.
        Nifti = "nifti",
        /// The axes of the world.
        Axes = "axes",
    }
}

/// The labels of a picture without perspective.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sections")]
pub(super) struct LabelArgs {
    /// Draw a scale bar whose length is a round number; --scale-bar=mm names the unit
    ///
    /// The number at the bar is in world units. The bar needs a section or a camera without perspective.
    #[arg(long, value_name = "UNIT", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    scale_bar: Option<String>,
    /// Label the edges of the picture with directions
    ///
    /// The letters need a section or a camera without perspective.
    #[arg(long, value_name = "SYSTEM", value_parser = values::named::<Letters>())]
    letters: Option<Letters>,
}

const INK: [u8; 3] = [255; 3];
/// The colour around letters and bar, so that they can be read on all colours.
const EDGE: [u8; 3] = [0; 3];
/// The share of the picture's width that a bar may have.
const BAR: f64 = 0.3;

impl LabelArgs {
    /// True when there are any.
    pub(super) fn are_drawn(&self) -> bool {
        self.scale_bar.is_some() || self.letters.is_some()
    }

    /// Refuses labels where lengths and directions differ from pixel to pixel.
    pub(super) fn check(&self, camera: &Camera) -> Result<(), Failure> {
        match camera.projection {
            Projection::Perspective if self.are_drawn() => Err(Failure::Usage(
                "--scale-bar and --letters are for pictures without perspective: give --section or --ortho, or leave them out"
                    .into(),
            )),
            _ => Ok(()),
        }
    }

    /// Draws them onto the picture of a camera.
    pub(super) fn draw(&self, picture: &mut Picture, camera: &Camera) {
        let scale = i64::from(picture.width.min(picture.height) / 300).max(1);
        if let Some(unit) = &self.scale_bar {
            draw_bar(picture, camera.fx, unit, scale);
        }
        if let Some(letters) = self.letters {
            draw_letters(picture, camera, letters, scale);
        }
    }
}

/// Draws a bar into the lower left corner, of so many pixels a unit.
fn draw_bar(picture: &mut Picture, pixels: f64, unit: &str, scale: i64) {
    let (length, number) = round_length(BAR * f64::from(picture.width) / pixels);
    let long = ((length * pixels).round() as i64).max(1);
    let (left, low) = (8 * scale, i64::from(picture.height) - 8 * scale);
    let bar = |edge: i64| {
        [
            left - edge..left + long + edge,
            low - 2 * scale - edge..low + edge,
        ]
    };
    ink::fill(picture, bar(scale), EDGE);
    ink::fill(picture, bar(0), INK);
    let words = format!("{number} {unit}");
    write(picture, [left, low - 16 * scale], words.trim(), scale);
}

/// The largest length of 1, 2 or 5 times a power of ten that is no longer than this, and its digits.
fn round_length(most: f64) -> (f64, String) {
    let power = most.log10().floor() as i32;
    let ten = 10_f64.powi(power);
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * ten <= most);
    let length = factor.unwrap_or(1.0) * ten;
    let digits = (-power).max(0) as usize;
    (length, format!("{length:.digits$}"))
}

/// Writes the letters of the directions at the middles of the edges.
fn draw_letters(picture: &mut Picture, camera: &Camera, letters: Letters, scale: i64) {
    let [right, down] = [0, 1].map(|row| camera.rotation.row(row));
    let (width, height) = (i64::from(picture.width), i64::from(picture.height));
    let (wide, tall) = (9 * scale, 11 * scale);
    let margin = 6 * scale;
    for (direction, is_across, is_far) in [
        (right, true, true),
        (-right, true, false),
        (down, false, true),
        (-down, false, false),
    ] {
        let words = letter(direction, letters);
        let wide = wide * words.len() as i64;
        let along = |size: i64, own: i64| match is_far {
            true => size - margin - own,
            false => margin,
        };
        let at = match is_across {
            true => [along(width, wide), (height - tall) / 2],
            false => [(width - wide) / 2, along(height, tall)],
        };
        write(picture, at, words, scale);
    }
}

/// The letters of a direction.
fn letter(direction: DVec3, letters: Letters) -> &'static str {
    let axis = direction.abs().max_position();
    let is_positive = direction[axis] > 0.0;
    let names = match letters {
        Letters::Dicom => [["R", "L"], ["A", "P"], ["I", "S"]],
        Letters::Nifti => [["L", "R"], ["P", "A"], ["I", "S"]],
        Letters::Axes => [["-x", "+x"], ["-y", "+y"], ["-z", "+z"]],
    };
    names[axis][usize::from(is_positive)]
}

/// Writes with an edge around the letters.
fn write(picture: &mut Picture, [x, y]: [i64; 2], words: &str, scale: i64) {
    let font = (ink::Font::Large, scale);
    for (dx, dy) in [
        (-1, 0),
        (1, 0),
        (0, -1),
        (0, 1),
        (-1, -1),
        (1, 1),
        (-1, 1),
        (1, -1),
    ] {
        let at = [x + dx * scale, y + dy * scale].map(|v| v as f64);
        ink::text(picture, at, words, font, EDGE);
    }
    ink::text(picture, [x, y].map(|v| v as f64), words, font, INK);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        for (most, number) in [
            (1.0, "1"),
            (1.99, "1"),
            (4.9, "2"),
            (73.0, "50"),
            (0.024, "0.02"),
            (0.5, "0.5"),
            (1234.0, "1000"),
        ] {
            let (length, said) = round_length(most);
            assert!(said == number && length <= most, "{most}: {length}, {said}");
            assert_eq!(said.parse(), Ok(length));
        }
    }

    #[test]
    fn letters_are_those_of_the_patient() {
        let axial = |letters| [DVec3::X, DVec3::Y, DVec3::NEG_Z].map(|d| letter(d, letters));
        assert_eq!(axial(Letters::Dicom), ["L", "P", "I"]);
        assert_eq!(axial(Letters::Nifti), ["R", "A", "I"]);
        assert_eq!(axial(Letters::Axes), ["+x", "+y", "-z"]);
        assert_eq!(letter(DVec3::new(-0.2, 0.1, 0.9), Letters::Dicom), "S");
    }
}
