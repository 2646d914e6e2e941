//! Parsers of the values that flags take.

use std::path::PathBuf;

use glam::DVec3;

/// `COUNT` numbers between commas, all finite.
pub(super) fn numbers<const COUNT: usize>(text: &str) -> Result<[f64; COUNT], String> {
    let list = rara::clip::numbers(text).map_err(|error| error.to_string())?;
    let found = list.len();
    list.try_into()
        .map_err(|_| format!("expected {COUNT} numbers with commas between them, found {found}"))
}

/// `x,y,z`.
pub(super) fn vec3(text: &str) -> Result<DVec3, String> {
    numbers::<3>(text).map(DVec3::from_array)
}

/// `x,y,z`, not all zero.
pub(super) fn direction(text: &str) -> Result<DVec3, String> {
    let vector = vec3(text)?;
    if vector == DVec3::ZERO {
        return Err("a direction cannot be zero".into());
    }
    Ok(vector)
}

/// An expression of shapes.
pub(super) fn expression(text: &str) -> Result<rara::clip::Expression, String> {
    text.parse().map_err(|error: rara::Error| error.to_string())
}

/// `WxH`. The library says which sizes are possible.
pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']);
    let sides = parts.and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides.ok_or_else(|| "expected a width and a height like 1024x768".into())
}

/// `r,g,b`, each 0 to 1.
pub(super) fn colour(text: &str) -> Result<[f32; 3], String> {
    let rgb = numbers::<3>(text)?;
    if rgb.iter().any(|c| !(0.0..=1.0).contains(c)) {
        return Err("red, green and blue are each between 0 and 1".into());
    }
    Ok(rgb.map(|c| c as f32))
}

/// A number above zero that single precision can hold.
pub(super) fn positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a finite number above zero".into()),
    }
}

/// A number of zero or more that single precision can hold.
pub(super) fn not_negative(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a finite number of zero or more".into()),
    }
}

/// A number from 0 to 1.
pub(super) fn share(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if (0.0..=1.0).contains(&number) => Ok(number),
        _ => Err("expected a number from 0 to 1".into()),
    }
}

/// A scene's file name.
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

/// A picture's file name; its ending says the format.
pub(super) fn picture_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    match ending.to_ascii_lowercase().as_str() {
        "png" | "exr" => Ok(path),
        _ => Err("a picture's name ends in .png (8 bits) or .exr (32-bit float)".into()),
    }
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
        assert!(direction("0,0,-0").is_err());
    }

    #[test]
    fn sizes_colours_and_names() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        assert!(size("640").is_err() && size("-1x5").is_err() && size("5x99999999999").is_err());
        assert!(colour("0,0.5,1").is_ok() && colour("0,0,1.5").is_err());
        assert!(positive("0").is_err() && positive("1e60").is_err() && positive("3").is_ok());
        assert!(picture_path("a.PNG").is_ok() && picture_path("a.exr").is_ok());
        assert!(picture_path("a.jpg").is_err() && picture_path("png").is_err());
    }
}
