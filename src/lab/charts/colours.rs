//! Colours that differ for everybody, and maps of colours in which equal steps look equal.

use plotters::style::RGBColor;

/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// What stands behind, but is read.
pub(super) const FAINT: RGBColor = RGBColor(0x66, 0x66, 0x66);
pub(super) const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
pub(super) const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);

/// The colours of Okabe and Ito, "Color Universal Design" (2008), those that stand out on white first; yellow, which does
/// not, is left out.
const SERIES: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x00, 0x00),
];

pub(super) fn series(number: usize) -> RGBColor {
    SERIES[number % SERIES.len()]
}

/// A colour that text can have.
pub(super) fn darker(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let [r, g, b] = [r, g, b].map(|c| (u32::from(c) * 7 / 10) as u8);
    RGBColor(r, g, b)
}

/// The colour of a value from -1, blue, by 0, nearly white, to 1, red.
pub(super) fn diverging(value: f64) -> RGBColor {
    let strength = value.abs().min(1.0);
    let hue: f64 = if value < 0.0 { 250.0 } else { 35.0 };
    oklch(0.97 - 0.45 * strength, 0.15 * strength, hue)
}

/// The colour of a value from 0, light, to 1, dark blue.
pub(super) fn sequential(value: f64) -> RGBColor {
    let value = value.clamp(0.0, 1.0);
    let chroma = 0.13 * (std::f64::consts::PI * (0.15 + 0.7 * value)).sin();
    oklch(0.97 - 0.65 * value, chroma, 100.0 + 165.0 * value)
}

/// What is read well on a colour.
pub(super) fn on(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let brightness = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
    if brightness > 128.0 { INK } else { PAPER }
}

/// A colour of Björn Ottosson's Oklab (2020), in which equal distances look about equal: lightness, chroma, and the hue
/// in degrees.
fn oklch(lightness: f64, chroma: f64, hue: f64) -> RGBColor {
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
    let [r, g, b] = linear.map(|c| {
        let c = c.clamp(0.0, 1.0);
        let encoded = if c <= 0.003_130_8 {
            12.92 * c
        } else {
            1.055 * c.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * encoded).round() as u8
    });
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours_of_oklab_come_out() {
        assert_eq!(oklch(1.0, 0.0, 0.0), RGBColor(255, 255, 255));
        assert_eq!(oklch(0.0, 0.0, 0.0), RGBColor(0, 0, 0));
        // Red of sRGB, as CSS Color 4 has it.
        let RGBColor(r, g, b) = oklch(0.627_955, 0.257_683, 29.234);
        assert!(r >= 254 && g <= 1 && b <= 1, "{r} {g} {b}");
    }

    #[test]
    fn both_directions_are_equally_strong_and_text_can_be_read_on_all() {
        let brightness = |RGBColor(r, g, b)| (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
        assert_eq!(diverging(0.0), diverging(-0.0));
        for step in 1..=10 {
            let value = f64::from(step) / 10.0;
            let (RGBColor(r, _, b), RGBColor(r2, _, b2)) = (diverging(value), diverging(-value));
            assert!(r > b && b2 > r2, "{value}");
            assert!(brightness(diverging(value)) < brightness(diverging(value - 0.1)));
            assert!(brightness(sequential(value)) < brightness(sequential(value - 0.1)));
        }
    }
}
