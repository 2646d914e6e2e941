//! Stage `splat` blends the splats over their pixels, front to back.

use super::footprint::Footprint;
use super::project::Splat;
use super::real::Real;
use super::view::ViewTransform;
use rara_base::limits::{ALPHA_MIN_INVERSE, TRANSMITTANCE_OPAQUE};
use rara_base::parallel::in_parallel;
use rara_scene::picture::Picture;
use rara_scene::settings::{Decay, Settings, Show};

/// Rows of the picture that one thread blends at a time.
const BAND: u32 = 16;

/// Draws splats that are sorted front to back.
pub fn splat<T: Real>(
    splats: &[Splat<T>],
    view: &ViewTransform<T>,
    settings: &Settings,
) -> Picture {
    let [width, height] = view.size;
    let mut members = vec![Vec::new(); height.div_ceil(BAND) as usize];
    for splat in splats {
        // There is a pixel of padding, since each pixel's alpha counts, and not how the box was rounded.
        if let Some((first, last)) = splat.footprint.span(1, height, T::one()) {
            for band in first / BAND..=last / BAND {
                members[band as usize].push(splat);
            }
        }
    }

    let mut picture = Picture::filled(width, height, [0.0; 4]);
    let pixels = picture.pixels.chunks_mut(BAND as usize * width as usize);
    let bands = (0..).step_by(BAND as usize).zip(&members).zip(pixels);
    // Bands do not share pixels, so the picture does not depend on which thread draws which.
    in_parallel(bands, |((top, splats), pixels)| {
        draw_band(splats, top, pixels, width, settings);
    });
    picture
}

/// Blends the splats of one band of rows and composites the background.
fn draw_band<T: Real>(
    splats: &[&Splat<T>],
    top: u32,
    pixels: &mut [[f32; 4]],
    width: u32,
    settings: &Settings,
) {
    let law = settings.decay_law();
    let mut blended = vec![[T::zero(); 4]; pixels.len()];
    let mut alphas = vec![T::zero(); pixels.len()];
    let saturated = T::of(1.0 - f64::from(settings.precision.transmittance_min));
    for splat in splats {
        let rows = blended
            .chunks_mut(width as usize)
            .zip(alphas.chunks_mut(width as usize));
        for (y, (row, alphas)) in (top..).zip(rows) {
            let dy = T::of(f64::from(y) + 0.5) - splat.footprint.screen_centre[1];
            let Some((first, last)) = row_span(&splat.footprint, dy, width) else {
                continue;
            };
            let pixels = row.iter_mut().zip(alphas).skip(first as usize);
            for (x, (pixel, alphas)) in (first..=last).zip(pixels) {
                let dx = T::of(f64::from(x) + 0.5) - splat.footprint.screen_centre[0];
                if let Some(alpha) = alpha(splat, dx, dy, law) {
                    match settings.show {
                        Show::Colour => blend(pixel, alpha, splat.colour),
                        Show::Weight => blend(pixel, alpha, weight_colour(splat, dx, dy)),
                        Show::Count => {
                            let shows = alpha * T::of(f64::from(ALPHA_MIN_INVERSE)) >= T::one();
                            let counts = shows && pixel[3] <= saturated;
                            add(pixel, alpha, [T::of(f64::from(u8::from(counts))); 3]);
                        }
                        Show::Mean => {
                            *alphas = *alphas + alpha;
                            add(pixel, alpha, splat.colour.map(|c| alpha * c));
                        }
                        Show::Strongest => {
                            let added = (T::one() - *alphas) * alpha;
                            *alphas = *alphas + added;
                            if added > pixel[3] {
                                let [low, high] = [splat.index & 0xffff, splat.index >> 16];
                                let [low, high, layer] =
                                    [low, high, splat.layer].map(|n| T::of(f64::from(n)));
                                *pixel = [low, high, layer, added];
                            }
                        }
                    }
                }
            }
        }
    }
    for ((pixel, blended), alphas) in pixels.iter_mut().zip(&mut blended).zip(alphas) {
        if settings.show == Show::Mean && alphas > T::zero() {
            let share = blended[3] / alphas;
            blended[..3].iter_mut().for_each(|c| *c = *c * share);
        }
        if let Some(background) = settings.background {
            blend(blended, T::one(), background.map(|c| T::of(f64::from(c))));
        }
        *pixel = blended.map(|v| v.wide() as f32);
    }
}

/// Adds to a pixel's numbers, while alpha grows as in blending.
fn add<T: Real>(pixel: &mut [T; 4], alpha: T, numbers: [T; 3]) {
    for (sum, number) in pixel.iter_mut().zip(numbers) {
        *sum = *sum + number;
    }
    pixel[3] = pixel[3] + (T::one() - pixel[3]) * alpha;
}

/// Opacity of a splat at an offset from its centre in pixels; nothing where it does not count: where its uncut alpha is
/// below 1/255, or the clip keeps none of it.
pub fn alpha<T: Real>(splat: &Splat<T>, dx: T, dy: T, law: Decay) -> Option<T> {
    let footprint = &splat.footprint;
    let falloff = (T::of(-0.5) * footprint.power(dx, dy)).exp();
    let whole = splat.alpha_max.min(footprint.opacity * falloff);
    if whole * T::of(f64::from(ALPHA_MIN_INVERSE)) < T::one() {
        return None;
    }
    match &splat.cut {
        Some(cut) => decayed(whole, cut.weight(dx, dy), law),
        None => Some(whole),
    }
}

/// The debug view: blue for a splat that is not cut; for one that is, from red, where nothing is kept, to yellow, where all
/// is.
fn weight_colour<T: Real>(splat: &Splat<T>, dx: T, dy: T) -> [T; 3] {
    match &splat.cut {
        None => [0.25, 0.45, 0.9].map(T::of),
        Some(cut) => {
            let kept = cut.weight(dx, dy).max(T::zero()).min(T::one());
            [T::one(), kept, T::zero()]
        }
    }
}

/// The alpha that is left where the share `weight` is visible (the paper's `alpha w`, or the Beer-Lambert law).
pub fn decayed<T: Real>(alpha: T, weight: T, law: Decay) -> Option<T> {
    if weight >= T::one() {
        Some(alpha) // unchanged to the bit: a clip that removes nothing changes nothing
    } else if weight > T::zero() {
        Some(match law {
            Decay::Linear => alpha * weight,
            // 1 - (1 - alpha)^w without cancellation for small alpha.
            // What is opaque has a finite depth.
            Decay::Depth => {
                let least = T::of(f64::from(TRANSMITTANCE_OPAQUE).ln());
                -(weight * (-alpha).ln_1p().max(least)).exp_m1()
            }
        })
    } else {
        None
    }
}

/// Adds a colour behind what a pixel holds (premultiplied RGBA).
fn blend<T: Real>(pixel: &mut [T; 4], alpha: T, colour: [T; 3]) {
    let through = (T::one() - pixel[3]) * alpha;
    for (channel, colour) in pixel.iter_mut().zip(colour) {
        *channel = *channel + through * colour;
    }
    pixel[3] = pixel[3] + through;
}

/// The pixels of one row that a footprint can reach, and a pixel more on either side. It is computed in double precision for
/// either type, since it must never be too short.
fn row_span<T: Real>(footprint: &Footprint<T>, dy: T, width: u32) -> Option<(u32, u32)> {
    let [k0, k1, k2] = footprint.conic.map(T::wide);
    let (dy, reach, centre) = (
        dy.wide(),
        footprint.extent.wide(),
        footprint.screen_centre[0].wide(),
    );
    // q = (k0 dx)^2 + (k1 dx + k2 dy)^2 is at its least in this row at `middle`, and at most K^2 within `half` of it.
    let squares = k0 * k0 + k1 * k1;
    let middle = -k1 * k2 * dy / squares;
    let least = (k0 * k2 * dy).powi(2) / squares;
    let half = ((reach * reach - least).max(0.0) / squares).sqrt() + 1.0;
    if least > 1.01 * reach * reach + 0.01 {
        return None;
    }
    let first = (centre + middle - half - 0.5).ceil().max(0.0);
    let last = (centre + middle + half - 0.5)
        .floor()
        .min(f64::from(width) - 1.0);
    (first <= last).then_some((first as u32, last as u32))
}
