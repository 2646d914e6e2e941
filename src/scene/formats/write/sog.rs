//! Writing `.sog`, version 2: an archive of pictures, stored, since they are compressed already.

use std::fmt::Display;
use std::io::{Cursor, Write};

use image_webp::{ColorType, WebPEncoder};
use serde_json::json;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::super::super::{Gaussians, Training};
use super::super::sog::{CENTROIDS, LARGEST};
use super::codebook::{Codebook, sets};
use super::{ANY, Ranges, along_a_curve, byte, smallest_three};
use rara_base::error::{Error, Result};

/// Sets of spherical harmonics at most.
const SETS: usize = 65536;
/// The least logarithm of a scale that is written.
const LEAST_LOG: f64 = -20.0;

pub(super) const RANGES: Ranges = Ranges {
    logs: [LEAST_LOG, f64::INFINITY],
    colours: ANY,
    coefficients: ANY,
};

pub(super) fn encode(gaussians: &Gaussians) -> Result<Vec<u8>> {
    let order = along_a_curve(gaussians);
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    let means: Vec<[f64; 3]> = order
        .iter()
        .map(|&at| {
            let position = gaussians.positions()[at as usize].to_array();
            position.map(|value| f64::from(value).signum() * f64::from(value).abs().ln_1p())
        })
        .collect();
    let end = |pick: fn(f64, f64) -> f64| {
        let ends = means
            .iter()
            .copied()
            .reduce(|a, b| [0, 1, 2].map(|axis| pick(a[axis], b[axis])));
        ends.unwrap_or_default()
    };
    let (mins, maxs) = (end(f64::min), end(f64::max));
    let steps = means.iter().map(|mean| {
        [0, 1, 2].map(|axis| {
            let size = (maxs[axis] - mins[axis]).max(f64::MIN_POSITIVE);
            ((mean[axis] - mins[axis]) / size * 65535.0).round() as u16
        })
    });
    let half = |number: usize| {
        let pixel = move |[x, y, z]: [u16; 3]| {
            let [x, y, z] = [x, y, z].map(|value| value.to_le_bytes()[number]);
            [x, y, z, 255]
        };
        steps.clone().map(pixel)
    };
    archive.picture("means_l.webp", half(0), order.len())?;
    archive.picture("means_u.webp", half(1), order.len())?;

    let scale = |at: u32| {
        gaussians.scales()[at as usize]
            .to_array()
            .map(|s| f64::from(s).ln().max(LEAST_LOG))
    };
    let scales = Codebook::from_values(order.iter().flat_map(|&at| scale(at)));
    let pixels = order.iter().map(|&at| {
        let [x, y, z] = scale(at).map(|value| scales.nearest(value));
        [x, y, z, 255]
    });
    archive.picture("scales.webp", pixels, order.len())?;

    let pixels = order.iter().map(|&at| {
        let q = gaussians.rotations()[at as usize];
        let (largest, others) = smallest_three([q.w, q.x, q.y, q.z]);
        let [a, b, c] = others.map(|part| byte(part * std::f64::consts::FRAC_1_SQRT_2 + 0.5));
        [a, b, c, LARGEST + largest as u8]
    });
    archive.picture("quats.webp", pixels, order.len())?;

    let colour = |at: u32| {
        let own = gaussians.sh_of(at as usize);
        [own[0], own[1], own[2]].map(f64::from)
    };
    let colours = Codebook::from_values(order.iter().flat_map(|&at| colour(at)));
    let pixels = order.iter().map(|&at| {
        let [red, green, blue] = colour(at).map(|value| colours.nearest(value));
        [
            red,
            green,
            blue,
            byte(gaussians.opacities()[at as usize].into()),
        ]
    });
    archive.picture("sh0.webp", pixels, order.len())?;

    let mut meta = json!({
        "version": 2,
        "asset": { "generator": concat!("rara ", env!("CARGO_PKG_VERSION")) },
        "count": order.len(),
        "means": { "mins": mins, "maxs": maxs, "files": ["means_l.webp", "means_u.webp"] },
        "scales": { "codebook": scales.0, "files": ["scales.webp"] },
        "quats": { "files": ["quats.webp"] },
        "sh0": { "codebook": colours.0, "files": ["sh0.webp"] },
    });
    if gaussians.is_antialiased() {
        // Readers know one or the other.
        meta["antialias"] = json!(true);
        meta["model"] = json!("antialiased");
    }
    for (name, value) in gaussians.training().marks(Training::default()) {
        meta[name] = json!(value);
    }
    let coefficients = gaussians.sh_coefficients() - 1;
    if coefficients > 0 && !order.is_empty() {
        let size = 3 * coefficients;
        let mut all = Vec::with_capacity(size * order.len());
        order
            .iter()
            .for_each(|&at| all.extend_from_slice(&gaussians.sh_of(at as usize)[3..]));
        let (labels, means) = sets(&all, size, SETS);
        let values = Codebook::from_values(means.iter().map(|&value| value.into()));
        let count = means.len() / size;
        let pixels = means.chunks_exact(3).map(|rgb| {
            let [red, green, blue] =
                [rgb[0], rgb[1], rgb[2]].map(|value| values.nearest(value.into()));
            [red, green, blue, 255]
        });
        let rows = count.div_ceil(CENTROIDS);
        archive.picture_of(
            "shN_centroids.webp",
            pixels,
            [CENTROIDS * coefficients, rows],
        )?;
        let pixels = labels.iter().map(|label| {
            let [low, high] = label.to_le_bytes();
            [low, high, 0, 255]
        });
        archive.picture("shN_labels.webp", pixels, order.len())?;
        meta["shN"] = json!({
            "count": count,
            "bands": gaussians.sh_degree(),
            "codebook": values.0,
            "files": ["shN_centroids.webp", "shN_labels.webp"],
        });
    }
    archive.add("meta.json", meta.to_string().as_bytes())?;
    archive.finish()
}

/// A zip archive in the making, in which files are stored without a time.
struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// Adds a picture of `count` pixels that is about as wide as high.
    fn picture(
        &mut self,
        name: &str,
        pixels: impl Iterator<Item = [u8; 4]>,
        count: usize,
    ) -> Result<()> {
        // Pictures of other writers have sides of four pixels, at least.
        let width = ((count as f64).sqrt().ceil() as usize)
            .next_multiple_of(4)
            .max(4);
        self.picture_of(name, pixels, [width, count.div_ceil(width).max(1)])
    }

    fn picture_of(
        &mut self,
        name: &str,
        pixels: impl Iterator<Item = [u8; 4]>,
        [width, height]: [usize; 2],
    ) -> Result<()> {
        let mut plain: Vec<u8> = Vec::with_capacity(4 * width * height);
        pixels.for_each(|pixel| plain.extend(pixel));
        plain.resize(4 * width * height, 255);
        let mut picture = Vec::new();
        let encoder = WebPEncoder::new(&mut picture);
        let made = encoder.encode(&plain, width as u32, height as u32, ColorType::Rgba8);
        made.map_err(|error| {
            Error::Invalid(format!(
                "a picture of {width}x{height} pixels cannot be WebP ({error}); divide the scene"
            ))
        })?;
        self.add(name, &picture)
    }

    fn add(&mut self, name: &str, file: &[u8]) -> Result<()> {
        let stored = SimpleFileOptions::DEFAULT.compression_method(CompressionMethod::Stored);
        let begun = self.0.start_file(name, stored);
        begun.map_err(too_large)?;
        self.0.write_all(file).map_err(too_large)
    }

    fn finish(self) -> Result<Vec<u8>> {
        Ok(self.0.finish().map_err(too_large)?.into_inner())
    }
}

/// Nothing else can go wrong in memory.
fn too_large(error: impl Display) -> Error {
    Error::Invalid(format!(
        "the scene is too large for one .sog ({error}); divide it"
    ))
}
