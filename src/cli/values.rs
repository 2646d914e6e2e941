//! The values that flags take: their parsers, and their texts.

use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::builder::{OsStringValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use glam::{DQuat, DVec3};

use super::output::{self, STANDARD};
use super::pattern::is_several;
use rara_base::value::Value;
pub(super) use rara_base::value::share as exact_share;
pub(super) use rara_scene::direction;
pub(super) use rara_scene::picture::size;

/// A colour: `r,g,b`, each 0 to 1, `#rgb`, `#rrggbb` or a name that CSS has for it.
pub(super) fn colour(text: &str) -> Result<[f32; 3], String> {
    Value::read(text)
}

/// `COUNT` numbers between commas, all finite.
pub(super) fn numbers<const COUNT: usize>(text: &str) -> Result<[f64; COUNT], String> {
    rara::clip::numbers_of(text).map_err(|error| error.to_string())
}

pub(super) fn vec3(text: &str) -> Result<DVec3, String> {
    numbers::<3>(text).map(DVec3::from_array)
}

/// An axis and an angle in degrees.
pub(super) fn turn(text: &str) -> Result<DQuat, String> {
    let [x, y, z, degrees] = numbers::<4>(text)?;
    let axis = DVec3::new(x, y, z).try_normalize();
    let axis = axis.ok_or("an axis cannot be zero")?;
    // Half a turn is exact, which its angle in radians is not.
    let (sin, cos) = match degrees.rem_euclid(360.0) {
        180.0 => (1.0, 0.0),
        degrees => (0.5 * degrees).to_radians().sin_cos(),
    };
    Ok(DQuat::from_xyzw(
        axis.x * sin,
        axis.y * sin,
        axis.z * sin,
        cos,
    ))
}

/// A number that is as `expected`.
pub(super) fn number<T: FromStr + Copy>(
    text: &str,
    is: impl Fn(T) -> bool,
    expected: &str,
) -> Result<T, String> {
    let number = text.parse().ok().filter(|number| is(*number));
    number.ok_or_else(|| format!("expected {expected}"))
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    number(text, f64::is_finite, "a finite number")
}

/// A number above zero that single precision can hold.
pub(super) fn positive(text: &str) -> Result<f32, String> {
    number(
        text,
        |x: f32| x > 0.0 && x.is_finite(),
        "a finite number above zero",
    )
}

/// A number of zero or more that single precision can hold.
pub(super) fn not_negative(text: &str) -> Result<f32, String> {
    number(
        text,
        |x: f32| x >= 0.0 && x.is_finite(),
        "a finite number of zero or more",
    )
}

/// The end of a message about a name that is not there: the one of these that is most like it, if one is.
pub(super) fn meant<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> String {
    let near = names.map(|name| {
        let likeness = strsim::jaro_winkler(&name.to_lowercase(), &wanted.to_lowercase());
        (likeness, name)
    });
    let nearest = near
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.7);
    nearest.map_or(String::new(), |(_, name)| {
        format!("; did you mean '{name}'?")
    })
}

/// A share in single precision.
pub(super) fn share(text: &str) -> Result<f32, String> {
    exact_share(text).map(|share| share as f32)
}

/// The name of one scene's file, or of several.
pub(super) fn ply_path(path: impl Into<PathBuf>) -> Result<PathBuf, &'static str> {
    let path = path.into();
    match output::ends_in(&path, "ply") {
        true => Ok(path),
        false => Err("a scene's name ends in .ply"),
    }
}

/// The name of one file, or of one folder.
pub fn one_file() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|name| match is_several(Path::new(&name)) {
        false => Ok(PathBuf::from(name)),
        true => Err("this is written once, and braces stand for several names: leave them out"),
    })
}

/// The file that JSON is written to; one that is there and holds something else is not taken for it.
pub(super) fn json_file() -> impl TypedValueParser<Value = PathBuf> {
    one_file().try_map(|path| {
        let mut begin = [0; 64];
        let file = std::fs::File::open(&path).and_then(|mut file| file.read(&mut begin));
        let first = begin.iter().find(|byte| !byte.is_ascii_whitespace());
        match (file, first) {
            (Ok(1..), Some(first)) if !b"{[".contains(first) && path.is_file() => {
                Err("this file holds something else than JSON: name another one")
            }
            _ => Ok(path),
        }
    })
}

/// A picture's file name; its ending says the format. It need not be text.
pub(super) fn picture_path(path: OsString) -> Result<PathBuf, String> {
    let path = PathBuf::from(path);
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    match ending.to_ascii_lowercase().as_str() {
        "png" | "exr" | "npy" => Ok(path),
        _ if path == Path::new(STANDARD) => Ok(path),
        _ => Err("a picture's name ends in .png (8 bits), .exr or .npy (32-bit float)".into()),
    }
}

/// True for a name that ends as that of a folder, or is one's.
pub(super) fn is_folder(path: &Path) -> bool {
    let name = path.as_os_str().as_encoded_bytes();
    let is_separator = |byte: &u8| std::path::is_separator((*byte).into());
    name.last().is_some_and(is_separator) || (path != Path::new(STANDARD) && path.is_dir())
}

#[cfg(feature = "view")]
pub(super) fn picture_file() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(picture_path)
}

/// The parser of a choice by its name.
pub fn named<T: Value + Clone + Send + Sync>() -> impl TypedValueParser<Value = T> {
    choices(T::CHOICES).try_map(|name| T::read(&name))
}

/// The same without one of the choices.
pub(super) fn named_but<T: Value + Clone + Send + Sync>(
    name: &'static str,
) -> impl TypedValueParser<Value = T> {
    let others = T::CHOICES.iter().filter(move |(other, _)| *other != name);
    choices(others).try_map(|name| T::read(&name))
}

/// The parser of one of these names, each with its documentation.
pub(super) fn choices(
    names: impl IntoIterator<Item = &'static (&'static str, &'static str)>,
) -> PossibleValuesParser {
    let all = names.into_iter();
    PossibleValuesParser::new(all.map(|(name, about)| PossibleValue::new(name).help(help(about).0)))
}

/// The help that a documentation's text is: its first paragraph without the stop at the end, and all of it where that is longer.
pub(super) fn help(about: &str) -> (String, Option<String>) {
    let paragraphs = about.split("\n\n").map(|paragraph| {
        let lines: Vec<_> = paragraph.lines().map(str::trim).collect();
        lines.join(" ").trim().to_owned()
    });
    let all: Vec<String> = paragraphs.collect();
    let first = all[0].strip_suffix('.').unwrap_or(&all[0]).to_owned();
    let rest = &all[1..];
    let long = (!rest.is_empty()).then(|| format!("{first}\n\n{}", rest.join("\n\n")));
    (first, long)
}

#[cfg(test)]
mod tests;
