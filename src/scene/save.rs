//! Writing scenes; 3DGS `.ply` as INRIA's trainer does: the same properties in the same order, binary little endian.

use std::cmp::Reverse;
use std::io::{self, Write};
use std::path::Path;

use glam::DVec3;

use super::assemble::FIXED;
use super::formats::WRITERS;
use super::ply::up_comment;
use super::{Annotations, Format, Gaussians, Property, Training};
use rara_base::error::{Error, Result, shortened};
use rara_base::files::write_atomically;
use rara_base::setters;

/// The number written as the logarithm of a scale of exactly zero: exp(-104) is below the smallest single-precision
/// number, so that loading gives zero again, and other readers see a finite number.
const LN_ZERO: f32 = -104.0;
/// Opacities of exactly 0 and 1 have no finite logit. Loading -104 gives zero again, loading 40 gives one.
const LOGIT_ZERO: f32 = -104.0;
const LOGIT_ONE: f32 = 40.0;

/// Writes `gaussians` to a 3DGS `.ply` (normals zero, as the trainer writes them). The file appears when complete.
///
/// Scales are stored as logarithms and opacities as logits in single precision, which rounds them; a scale of zero is
/// stored as ln of a number below the smallest (-104), opacities of 0 and 1 as the logits -104 and 40.
///
/// # Errors
/// [`Error::Invalid`] names the first number that no reader could draw, such as one that is not finite; [`Error::Io`] if the
/// file can't be written.
pub fn save_ply(path: &Path, gaussians: &Gaussians) -> Result<()> {
    save_ply_with(path, gaussians, &SaveOptions::default())
}

fn save_ply_with(path: &Path, gaussians: &Gaussians, options: &SaveOptions) -> Result<()> {
    check(path, gaussians)?;
    let columns: Result<Vec<Column<'_>>> = options
        .properties
        .iter()
        .map(|one| Column::of(path, one, gaussians))
        .collect();
    let columns = columns?;
    write_atomically(path, |out| {
        write_header(out, gaussians, options.up, &columns)?;
        (0..gaussians.len()).try_for_each(|index| {
            write_row(out, gaussians, index)?;
            columns
                .iter()
                .try_for_each(|column| column.write(out, index))
        })
    })
}

/// A property that is written.
struct Column<'a> {
    property: &'a Property,
    kind: ColumnKind,
}

#[derive(Clone, Copy, PartialEq)]
enum ColumnKind {
    Int,
    Float,
    Double,
}

impl<'a> Column<'a> {
    fn of(path: &Path, property: &'a Property, gaussians: &Gaussians) -> Result<Self> {
        let wrong = |what: &str| {
            let name = shortened(&property.name);
            Error::Invalid(format!("{}: the property `{name}` {what}", path.display()))
        };
        let name = property.name.as_str();
        if name.is_empty() || !name.chars().all(|sign| sign.is_ascii_graphic()) {
            return Err(wrong(
                "has a name that is not of letters without blanks; give it another",
            ));
        }
        if is_of_gaussian(name) {
            return Err(wrong("is what a Gaussian is made of; give it another name"));
        }
        if property.values.len() != gaussians.len() {
            return Err(wrong("has not a value for each Gaussian"));
        }
        let is_integer = |value: &f64| *value == f64::from(*value as i32);
        let kind = match property.single {
            true => ColumnKind::Float,
            false if property.values.iter().all(is_integer) => ColumnKind::Int,
            false => ColumnKind::Double,
        };
        Ok(Self { property, kind })
    }

    fn write(&self, out: &mut dyn Write, index: usize) -> io::Result<()> {
        let value = self.property.values[index];
        match self.kind {
            ColumnKind::Int => out.write_all(&(value as i32).to_le_bytes()),
            ColumnKind::Float => out.write_all(&(value as f32).to_le_bytes()),
            ColumnKind::Double => out.write_all(&value.to_le_bytes()),
        }
    }
}

/// True for the properties of a Gaussian in a `.ply`.
fn is_of_gaussian(name: &str) -> bool {
    FIXED.contains(&name) || ["nx", "ny", "nz"].contains(&name) || name.starts_with("f_rest_")
}

/// Writes `gaussians` in the [format](Format::of_name) that the file's name says: `.ply`,
/// `.compressed.ply`, `.spz`, `.sog` or `.glb`. The file appears when complete.
///
/// All but `.glb` round what they store, `.ply` in the last digits of scales and opacities, and `.compressed.ply` and `.sog`
/// change the Gaussians' order; the guide's chapter on formats has what that costs.
///
/// Returns how many Gaussians have a scale, a colour or a coefficient beyond what the format holds; it becomes the nearest
/// that it does.
///
/// # Errors
/// [`Error::Invalid`] for a name of another format, for a number that no reader could draw, and for centres that the format
/// cannot hold; [`Error::Io`] if the file can't be written.
pub fn save(path: &Path, gaussians: &Gaussians) -> Result<u64> {
    save_with(path, gaussians, &SaveOptions::default())
}

setters! {
    /// The options of [`save_with`].
    #[derive(Debug, Clone, PartialEq)]
    #[non_exhaustive]
    pub struct SaveOptions {
        /// The version of a `.spz` file: 2, which the oldest readers know, 3, or 4, whose attributes are streams of zstd, each by itself.
        pub spz_version: u32,
        /// The names and `extras` around the Gaussians of a `.glb`; other formats cannot store them.
        pub annotations: Option<Annotations>,
        /// The direction that is up, which a `.ply` says by a comment where it is an axis; other formats have no room for it.
        pub up: Option<DVec3>,
        /// Values of each Gaussian beside those that it is made of, which a `.ply` has as further properties; other formats have no
        /// room for them. Integers are written as such, what [is](Property::single) of single precision as `float`.
        pub properties: Vec<Property>,
    }
}

impl Default for SaveOptions {
    fn default() -> Self {
        Self {
            spz_version: 3,
            annotations: None,
            up: None,
            properties: Vec::new(),
        }
    }
}

/// Like [`save`], as the options say.
///
/// # Errors
/// Those of [`save`], and [`Error::Invalid`] for a version that is not written, and for annotations of other Gaussians.
pub fn save_with(path: &Path, gaussians: &Gaussians, options: &SaveOptions) -> Result<u64> {
    let format = saved_format(path)?;
    if let Some(writer) = WRITERS.iter().find(|writer| writer.format == format) {
        check(path, gaussians)?;
        let (bytes, clamped) = writer.encode(gaussians, options)?;
        write_atomically(path, |out| out.write_all(&bytes))?;
        return Ok(clamped);
    }
    debug_assert_eq!(format, Format::Ply);
    save_ply_with(path, gaussians, options).map(|()| 0)
}

/// The format that [`save`] writes to a file of this name.
///
/// # Errors
/// [`Error::Invalid`] names the endings of those that are written.
pub fn saved_format(path: &Path) -> Result<Format> {
    Format::of_name(path).ok_or_else(|| {
        Error::Invalid(format!(
            "{}: the ending of the name chooses the format, and must be one of {}",
            path.display(),
            Format::endings()
        ))
    })
}

impl Format {
    /// The format that a file of this name is [saved](save) in; `None` for a name whose ending says none that is written.
    pub fn of_name(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let mut written = Self::written().into_iter();
        let found = written.find(|(ending, _)| name.ends_with(ending));
        found.map(|(_, format)| format)
    }

    /// The endings of the names of files that are written, for messages and help.
    pub fn endings() -> String {
        let endings: Vec<&str> = Self::written().iter().map(|(ending, _)| *ending).collect();
        endings.join(", ")
    }

    /// The endings of names and the formats that they say. Longer endings come first.
    fn written() -> Vec<(&'static str, Self)> {
        let mut written = vec![(".ply", Self::Ply)];
        written.extend(WRITERS.iter().map(|writer| (writer.ending, writer.format)));
        written.sort_by_key(|(ending, _)| Reverse(ending.len()));
        written
    }
}

/// Refuses what cannot be drawn, which whoever changes Gaussians in place can make.
fn check(path: &Path, gaussians: &Gaussians) -> Result<()> {
    gaussians
        .check()
        .map_err(|error| Error::Invalid(format!("{} is not written: {error}", path.display())))
}

/// The lines of a PLY's header by which readers know how Gaussians were trained: others that they are antialiased, this one also
/// the rest.
pub(super) fn training_comments(gaussians: &Gaussians) -> String {
    let training = gaussians.training();
    let mut lines = String::new();
    if training.antialiased {
        lines.push_str("comment SplatRenderMode: mip\n");
    }
    for (name, value) in training.marks(Training::default()) {
        lines.push_str(&format!("comment {name}: {value}\n"));
    }
    lines
}

fn write_header(
    out: &mut dyn Write,
    gaussians: &Gaussians,
    up: Option<DVec3>,
    columns: &[Column<'_>],
) -> io::Result<()> {
    let rest = 3 * (gaussians.sh_coefficients() - 1);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\n{}{}element vertex {}\n",
        training_comments(gaussians),
        up.and_then(up_comment).unwrap_or_default(),
        gaussians.len()
    )?;
    let fixed = |names: &'static [&'static str]| names.iter().map(|name| name.to_string());
    let names = fixed(&[
        "x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2",
    ])
    .chain((0..rest).map(|i| format!("f_rest_{i}")))
    .chain(fixed(&[
        "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3",
    ]));
    // Only double precision holds what is far from zero.
    let is_far = gaussians.origin() != DVec3::ZERO;
    for (at, name) in names.enumerate() {
        let number = if is_far && at < 3 { "double" } else { "float" };
        writeln!(out, "property {number} {name}")?;
    }
    for column in columns {
        let kind = match column.kind {
            ColumnKind::Int => "int",
            ColumnKind::Float => "float",
            ColumnKind::Double => "double",
        };
        writeln!(out, "property {kind} {}", column.property.name)?;
    }
    writeln!(out, "end_header")
}

fn write_row(out: &mut dyn Write, gaussians: &Gaussians, index: usize) -> io::Result<()> {
    // At most degree 3: 3 + 3 + 48 + 1 + 3 + 4 numbers. They are collected first, since each write to `out` is a virtual
    // call.
    let (mut row, mut first) = ([0.0_f32; 62], 0);
    let sh = gaussians.sh_of(index);
    let coefficients = sh.len() / 3;
    if gaussians.origin() == DVec3::ZERO {
        row[..3].copy_from_slice(&gaussians.positions()[index].to_array());
    } else {
        let centre = gaussians.centre(index).to_array();
        centre
            .iter()
            .try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
        first = 3;
    }
    row[6..9].copy_from_slice(&sh[..3]);
    for (at, value) in row[9..].iter_mut().take(sh.len() - 3).enumerate() {
        let (channel, coefficient) = (at / (coefficients - 1), at % (coefficients - 1) + 1);
        *value = sh[3 * coefficient + channel];
    }
    let tail = 6 + sh.len();
    row[tail] = logit(gaussians.opacities()[index]);
    let scale = gaussians.scales()[index].to_array().map(log);
    row[tail + 1..][..3].copy_from_slice(&scale);
    let q = gaussians.rotations()[index];
    row[tail + 4..][..4].copy_from_slice(&[q.w, q.x, q.y, q.z]);
    let mut bytes = [0_u8; 4 * 62];
    for (to, value) in bytes.chunks_exact_mut(4).zip(row) {
        to.copy_from_slice(&value.to_le_bytes());
    }
    out.write_all(&bytes[4 * first..4 * (tail + 8)])
}

fn log(scale: f32) -> f32 {
    (f64::from(scale).ln() as f32).max(LN_ZERO)
}

fn logit(opacity: f32) -> f32 {
    let opacity = f64::from(opacity);
    ((opacity / (1.0 - opacity)).ln() as f32).clamp(LOGIT_ZERO, LOGIT_ONE)
}

#[cfg(test)]
mod tests;
