//! What a `meta.json` says, of version 1 (ranges) or 2 (codebooks).

use serde_json::Value;

use super::super::super::Training;
use super::super::{numbers, unread_members};
use rara_base::counted::counted;
use rara_base::error::shortened;

/// What the values of a picture stand for.
pub(super) enum Range {
    /// One number for each of 256 values.
    Codebook(Vec<f64>),
    /// The ends of a range for each channel, or of one for all.
    Ends(Vec<[f64; 2]>),
}

impl Range {
    /// The number that a value of a channel stands for.
    pub(super) fn value(&self, channel: usize, value: u8) -> f64 {
        match self {
            Self::Codebook(book) => book[usize::from(value)],
            Self::Ends(ends) => {
                let [low, high] = ends[channel.min(ends.len() - 1)];
                low + (high - low) * f64::from(value) / 255.0
            }
        }
    }

    fn from_json(part: &Value, name: &str, channels: usize) -> Result<Self, String> {
        if let Some(book) = part.get("codebook") {
            // An entry that no pixel has may be null.
            let numbers = book.as_array().map(|all| {
                let number = |one: &Value| one.as_f64().unwrap_or(f64::NAN);
                all.iter().map(number).collect::<Vec<_>>()
            });
            return match numbers {
                Some(numbers) if numbers.len() == 256 => Ok(Self::Codebook(numbers)),
                found => Err(format!(
                    "the codebook of {name} has {}, and 256 are needed; export the scene again",
                    counted(found.map_or(0, |numbers| numbers.len()), "number")
                )),
            };
        }
        ends(part, name, channels).map(Self::Ends)
    }
}

fn ends(part: &Value, name: &str, channels: usize) -> Result<Vec<[f64; 2]>, String> {
    let side = |key: &str| numbers(part.get(key)?);
    match (side("mins"), side("maxs")) {
        (Some(low), Some(high)) if low.len() == channels && high.len() == channels => {
            Ok(low.into_iter().zip(high).map(<[f64; 2]>::from).collect())
        }
        _ => Err(format!(
            "{name} has neither a codebook of 256 numbers nor \"mins\" and \"maxs\" of {}; export the scene again",
            counted(channels, "number")
        )),
    }
}

/// Spherical harmonics above degree 0: sets of them, and for each Gaussian the number of its set.
pub(super) struct Harmonics<'a> {
    /// How many sets there are; version 1 does not say it.
    pub(super) count: Option<u64>,
    bands: Option<u64>,
    pub(super) values: Range,
    pub(super) centroids: &'a str,
    pub(super) labels: &'a str,
}

impl Harmonics<'_> {
    /// The degree, by what is said and by the width of the sets' picture.
    pub(super) fn degree(&self, width: usize) -> Result<u32, String> {
        let degree = match width / super::CENTROIDS {
            3 => 1,
            8 => 2,
            15 => 3,
            24 => 4,
            _ => 0,
        };
        let fits = width.is_multiple_of(super::CENTROIDS) && degree > 0;
        if fits && self.bands.is_none_or(|bands| bands == u64::from(degree)) {
            return Ok(degree);
        }
        Err(format!(
            "the picture of spherical harmonics is {} wide, which {} does not fit: 192, 512, 960 and 1536 are of \
             degree 1, 2, 3 and 4; export the scene again",
            counted(width, "pixel"),
            self.bands.map_or("any degree".into(), |bands| format!(
                "the degree {bands} of meta.json"
            ))
        ))
    }
}

/// A whole `meta.json`.
pub(super) struct Meta<'a> {
    /// Whether opacities are logits, as version 1 has them.
    pub(super) is_first: bool,
    pub(super) count: u64,
    /// How they were trained.
    pub(super) training: Training,
    /// The ends of the logarithms of each axis.
    pub(super) bounds: Vec<[f64; 2]>,
    /// The pictures of the low and of the high bytes.
    pub(super) means: [&'a str; 2],
    pub(super) scales: (&'a str, Range),
    pub(super) quats: &'a str,
    pub(super) sh0: (&'a str, Range),
    pub(super) harmonics: Option<Harmonics<'a>>,
}

impl<'a> Meta<'a> {
    pub(super) fn from_json(document: &'a Value) -> Result<Self, String> {
        let is_first = match document.get("version").map(Value::as_f64) {
            None | Some(Some(1.0)) => true,
            Some(Some(2.0)) => false,
            Some(other) => {
                return Err(format!(
                    "this is SOG of version {}; rara reads versions 1 and 2: export the scene as one of these",
                    other.map_or("an unknown number".into(), |version| format!("{version:e}"))
                ));
            }
        };
        let [means, scales, quats, sh0] = [
            part(document, "means")?,
            part(document, "scales")?,
            part(document, "quats")?,
            part(document, "sh0")?,
        ];
        let count = match document.get("count") {
            Some(count) => count.as_u64(),
            None => means
                .get("shape")
                .and_then(|shape| shape.get(0))
                .and_then(Value::as_u64),
        };
        let count = count
            .filter(|&count| count <= u64::from(u32::MAX))
            .ok_or_else(|| {
                format!(
                    "its \"count\" is not a whole number from 0 to {}; export the scene again",
                    u32::MAX
                )
            })?;
        // The format's own word, and the one that splat-transform writes.
        let model = document.get("model").and_then(Value::as_str);
        if model == Some("2dgs") {
            return Err(
                "it holds discs of 2D Gaussian Splatting, which are intersected with each line of sight, not projected as \
                 3D Gaussians are; train the scene with 3DGS"
                    .into(),
            );
        }
        let antialias = document.get("antialias").and_then(Value::as_bool);
        let harmonics = match document.get("shN").filter(|part| !part.is_null()) {
            None => None,
            Some(part) => {
                let [centroids, labels] = files(part, "shN")?;
                Some(Harmonics {
                    count: whole(part, "count", super::MOST_SETS)?,
                    bands: whole(part, "bands", 4)?,
                    values: Range::from_json(part, "shN", 1)?,
                    centroids,
                    labels,
                })
            }
        };
        let [means_low, means_high] = files(means, "means")?;
        let [scales_file] = files(scales, "scales")?;
        let [quats_file] = files(quats, "quats")?;
        let [sh0_file] = files(sh0, "sh0")?;
        let is_antialiased = antialias == Some(true) || model == Some("antialiased");
        let mut training = Training::default().antialiased(is_antialiased);
        for (name, value) in document.as_object().into_iter().flatten() {
            training.mark(name, value.as_str().unwrap_or_default())?;
        }
        Ok(Self {
            is_first: is_first && sh0.get("codebook").is_none(),
            count,
            training,
            bounds: ends(means, "means", 3)?,
            means: [means_low, means_high],
            scales: (scales_file, Range::from_json(scales, "scales", 3)?),
            quats: quats_file,
            sh0: (sh0_file, Range::from_json(sh0, "sh0", 4)?),
            harmonics,
        })
    }
}

/// The names of what a `meta.json` has beside that.
pub(super) fn others(document: &Value) -> Vec<String> {
    unread_members(document, |name| match name {
        "version" | "asset" | "count" | "antialias" | "model" => true,
        "means" | "scales" | "quats" | "sh0" | "shN" => true,
        _ => Training::is_mark(name),
    })
}

fn part<'a>(document: &'a Value, name: &str) -> Result<&'a Value, String> {
    document
        .get(name)
        .ok_or_else(|| format!("meta.json has no \"{name}\"; export the scene again"))
}

/// A number of spherical harmonics' `shN` from 1 to the most, if it is said.
fn whole(part: &Value, key: &str, most: u64) -> Result<Option<u64>, String> {
    let Some(said) = part.get(key) else {
        return Ok(None);
    };
    let number = said.as_u64().filter(|number| (1..=most).contains(number));
    number.map(Some).ok_or_else(|| {
        format!("the \"{key}\" of shN is not a number from 1 to {most}; export the scene again")
    })
}

/// The names of an attribute's pictures.
fn files<'a, const N: usize>(part: &'a Value, name: &str) -> Result<[&'a str; N], String> {
    let list = part.get("files").and_then(Value::as_array);
    let names = list.map(|list| list.iter().filter_map(Value::as_str).collect::<Vec<_>>());
    let names = names.unwrap_or_default();
    let found = names
        .iter()
        .map(|name| shortened(name))
        .take(4)
        .collect::<Vec<_>>()
        .join(", ");
    names.try_into().map_err(|_| {
        format!("the \"files\" of {name} are not {N} names of pictures but [{found}]; export the scene again")
    })
}
