//! The values that flags take: their parsers, and their texts.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{OsStringValueParser, TypedValueParser};
use glam::{DQuat, DVec3};

/// `COUNT` numbers between commas, all finite.
pub(super) fn numbers<const COUNT: usize>(text: &str) -> Result<[f64; COUNT], String> {
    let list = rara::clip::numbers(text).map_err(|error| error.to_string())?;
    let found = list.len();
    list.try_into()
        .map_err(|_| format!("expected {COUNT} numbers with commas between them, found {found}"))
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

/// `x,y,z`, not all zero, or an axis as `y` or `-z`.
pub(super) fn direction(text: &str) -> Result<DVec3, String> {
    let (sign, axis) = match text.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    match axis {
        "x" => return Ok(sign * DVec3::X),
        "y" => return Ok(sign * DVec3::Y),
        "z" => return Ok(sign * DVec3::Z),
        _ => {}
    }
    let vector = vec3(text)?;
    if vector == DVec3::ZERO {
        return Err("a direction cannot be zero".into());
    }
    Ok(vector)
}

/// `WxH`. The library says which sizes are possible.
pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']);
    let sides = parts.and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides.ok_or_else(|| "expected a width and a height like 1024x768".into())
}

/// `r,g,b`, each 0 to 1, `#rgb`, `#rrggbb` or one of a few names.
pub(super) fn colour(text: &str) -> Result<[f32; 3], String> {
    if let Some(digits) = text.strip_prefix('#') {
        return hexadecimal(digits)
            .ok_or_else(|| "expected three or six hexadecimal digits, as in #fff".into());
    }
    if let Some((_, rgb)) = COLOURS.iter().find(|(name, _)| *name == text) {
        return Ok(*rgb);
    }
    let rgb = numbers::<3>(text).map_err(|error| {
        let names: Vec<_> = COLOURS.iter().map(|(name, _)| *name).collect();
        format!("{error}; or #rrggbb, or one of {}", names.join(", "))
    })?;
    if rgb.iter().any(|c| !(0.0..=1.0).contains(c)) {
        return Err("red, green and blue are each between 0 and 1".into());
    }
    Ok(rgb.map(|c| c as f32))
}

const COLOURS: [(&str, [f32; 3]); 7] = [
    ("black", [0.0, 0.0, 0.0]),
    ("white", [1.0, 1.0, 1.0]),
    ("grey", [0.5, 0.5, 0.5]),
    ("gray", [0.5, 0.5, 0.5]),
    ("red", [1.0, 0.0, 0.0]),
    ("green", [0.0, 1.0, 0.0]),
    ("blue", [0.0, 0.0, 1.0]),
];

fn hexadecimal(digits: &str) -> Option<[f32; 3]> {
    let values = digits.chars().map(|digit| digit.to_digit(16));
    let values: Vec<u32> = values.collect::<Option<_>>()?;
    let of = |value: u32| value as f32 / 255.0;
    match *values.as_slice() {
        [r, g, b] => Some([r, g, b].map(|v| of(17 * v))),
        [r1, r0, g1, g0, b1, b0] => {
            Some([(r1, r0), (g1, g0), (b1, b0)].map(|(h, l)| of(16 * h + l)))
        }
        _ => None,
    }
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

pub(super) fn share(text: &str) -> Result<f32, String> {
    number(
        text,
        |x: f32| (0.0..=1.0).contains(&x),
        "a number from 0 to 1",
    )
}

pub(super) fn ply_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let fits = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("ply"));
    if fits {
        Ok(path)
    } else {
        Err("a scene's name ends in .ply".into())
    }
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

/// The name of standard input and standard output in place of a file.
pub(super) const STANDARD: &str = "-";

pub(super) fn picture_file() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(picture_path)
}

/// The name of a value on the command line and in the statistics.
pub(super) fn name(value: impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().into())
}

/// The flag of a value that is not the default, as a user would type it.
#[cfg(feature = "view")]
pub(super) fn flag<T: PartialEq>(
    flag: &str,
    own: T,
    default: T,
    text: impl Fn(T) -> String,
) -> Option<String> {
    let own = (own != default).then(|| text(own))?;
    Some(format!("--{flag} {own}"))
}

/// A number on the command line.
#[cfg(feature = "view")]
pub(super) fn text(number: impl ToString) -> String {
    number.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_take_signs_spaces_and_exponents() {
        assert_eq!(vec3("-1, 2.5,-3e2"), Ok(DVec3::new(-1.0, 2.5, -300.0)));
        assert!(vec3("1,2").is_err());
        assert!(vec3("1,2,3,4").is_err());
        assert!(vec3("1,,3").is_err());
        assert!(vec3("nan,0,0").is_err());
        assert!(vec3("1e999,0,0").is_err());
        assert!(direction("0,0,-0").is_err() && direction("w").is_err());
        assert_eq!(direction("-z"), Ok(DVec3::NEG_Z));
        assert_eq!(
            (direction("y"), direction("+y")),
            (Ok(DVec3::Y), Ok(DVec3::Y))
        );
    }

    #[test]
    fn turns_are_about_an_axis_by_degrees() {
        let half = turn("0,0,2,180").expect("an axis");
        assert_eq!(half * DVec3::X, DVec3::NEG_X);
        let back = turn("0,1,0,-90").expect("an axis");
        assert!((back * DVec3::X).distance(DVec3::Z) < 1e-15);
        assert!(turn("0,0,0,90").is_err() && turn("1,2,3").is_err());
    }

    #[test]
    fn sizes_colours_and_names() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert!(size("640").is_err() && size("-1x5").is_err() && size("5x99999999999").is_err());
        assert_eq!(colour("white"), Ok([1.0; 3]));
        assert_eq!(colour("#fff"), Ok([1.0; 3]));
        assert_eq!(colour("#ff0080"), Ok([1.0, 0.0, 128.0 / 255.0]));
        assert!(colour("#ffff").is_err() && colour("#ggg").is_err() && colour("wite").is_err());
        assert!(colour("0,0.5,1").is_ok() && colour("0,0,1.5").is_err());
        assert!(positive("0").is_err() && positive("1e60").is_err() && positive("3").is_ok());
        assert!(picture_path("a.PNG".into()).is_ok() && picture_path("a.exr".into()).is_ok());
        assert!(picture_path("a.jpg".into()).is_err() && picture_path("png".into()).is_err());
    }
}
