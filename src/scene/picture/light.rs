//! Linear light, and how displays store it: by the curve of sRGB.

use super::Picture;

/// The linear light of a colour as it is stored; beyond white the curve goes on.
#[doc(hidden)]
pub fn linear_light(stored: f32) -> f32 {
    let stored = f64::from(stored.max(0.0));
    let light = match stored <= 0.04045 {
        true => stored / 12.92,
        false => ((stored + 0.055) / 1.055).powf(2.4),
    };
    light as f32
}

/// The inverse.
fn stored_colour(light: f32) -> f32 {
    let light = f64::from(light.max(0.0));
    let stored = match light <= 0.0031308 {
        true => 12.92 * light,
        false => 1.055 * light.powf(1.0 / 2.4) - 0.055,
    };
    stored as f32
}

impl Picture {
    /// Turns a picture of linear light into what displays store. A premultiplied colour is the pixel's own times its alpha.
    #[doc(hidden)]
    pub fn store_light(&mut self) {
        for [rgb @ .., alpha] in &mut self.pixels {
            if *alpha > 0.0 {
                *rgb = rgb.map(|light| *alpha * stored_colour(light / *alpha));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_stored_and_read_again() {
        for (stored, light) in [
            (0.0, 0.0),
            (0.04, 0.003_095_975),
            (0.5, 0.214_041_14),
            (1.0, 1.0),
            (2.0, 4.953_847),
        ] {
            assert!((linear_light(stored) - light).abs() < 1e-5, "{stored}");
            assert!((stored_colour(light) - stored).abs() < 1e-5, "{stored}");
        }
        let mut picture = Picture::filled(1, 1, [0.5 * 0.214_041_14, 0.0, 0.5, 0.5]);
        picture.store_light();
        let [red, green, blue, alpha] = picture.pixels[0];
        assert!((red - 0.25).abs() < 1e-6 && (blue - 0.5).abs() < 1e-6);
        assert_eq!((green, alpha), (0.0, 0.5));
    }
}
