//! A contact sheet: pictures side by side, a label over each, and a piece of each magnified below.

use rara::Picture;

use rara_scene::picture::ink;

/// Pixels between two pictures.
const GAP: u32 = 4;
/// Colour of what is between the pictures.
const MARGIN: [f32; 4] = [0.25, 0.25, 0.25, 1.0];
const INK: [u8; 3] = [255; 3];
pub(super) const ZOOM: u32 = 6;

/// Pictures of one size with their labels, and under each the same piece of it, magnified; `corner` is the piece's
/// left and top.
pub(super) fn sheet(pictures: &[(String, Picture)], corner: [u32; 2]) -> Picture {
    let Some((_, first)) = pictures.first() else {
        return Picture::default();
    };
    let (width, height) = (first.width, first.height);
    let (label, height_of_label) = match width {
        0..256 => (ink::Font::Small, 11),
        _ => (ink::Font::Large, 22),
    };
    let scale = (width / 200).max(1);
    let band = height_of_label * scale;
    let count = pictures.len() as u32;
    let mut sheet = Picture::filled(count * (width + GAP) - GAP, band + 2 * height + GAP, MARGIN);
    for (column, (words, picture)) in (0..).zip(pictures) {
        let left = column * (width + GAP);
        let at = [left + 2 * scale, 2 * scale].map(f64::from);
        ink::text(&mut sheet, at, words, (label, scale.into()), INK);
        for y in 0..height {
            for x in 0..width {
                set(&mut sheet, left + x, band + y, picture.at(x, y));
                let near = picture.at(corner[0] + x / ZOOM, corner[1] + y / ZOOM);
                set(&mut sheet, left + x, band + height + GAP + y, near);
            }
        }
    }
    sheet
}

fn set(picture: &mut Picture, x: u32, y: u32, pixel: [f32; 4]) {
    if x < picture.width && y < picture.height {
        picture.pixels[y as usize * picture.width as usize + x as usize] = pixel;
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
    fn pictures_stand_side_by_side_and_magnified_below() {
        let mut red = Picture::filled(12, 12, [1.0, 0.0, 0.0, 1.0]);
        set(&mut red, 5, 5, [0.0, 1.0, 0.0, 1.0]);
        let blue = Picture::filled(12, 12, [0.0, 0.0, 1.0, 1.0]);
        let made = sheet(&[("x".into(), red), ("o".into(), blue)], [5, 5]);
        assert_eq!((made.width, made.height), (28, 11 + 12 + 4 + 12));
        assert_eq!(made.at(0, 11), [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(made.at(12, 11), MARGIN);
        assert_eq!(made.at(16, 11), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(made.at(0, 27), [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(made.at(6, 27), [1.0, 0.0, 0.0, 1.0]);
    }
}
