//! A file's name that stands for several: `{}` is a number, `{:04}` one with zeros before it, `{name}` a name. Of files for scenes
//! `{}` is a name too.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::output;

/// What takes the place of braces.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slot {
    /// A number of at least so many digits.
    Number(usize),
    Name,
}

/// The name of one picture. A pattern that is no text keeps its bytes where the system's names are bytes.
pub(super) fn filled(pattern: &Path, number: usize, name: &str) -> PathBuf {
    filled_with(pattern, number, &bare(name), &number.to_string())
}

/// The name of one picture, with what takes the place of `{}`.
fn filled_with(pattern: &Path, number: usize, name: &str, plain: &str) -> PathBuf {
    let mut made = Vec::new();
    let mut rest = pattern.as_os_str().as_encoded_bytes();
    while let Some((at, length, slot)) = first_slot(rest) {
        made.extend_from_slice(&rest[..at]);
        let text = match slot {
            Slot::Number(0) => plain.into(),
            Slot::Number(digits) => format!("{number:0digits$}"),
            Slot::Name => name.into(),
        };
        made.extend_from_slice(text.as_bytes());
        rest = &rest[at + length..];
    }
    made.extend_from_slice(rest);
    os_string(made, pattern.as_os_str()).into()
}

/// True where a name stands for several.
pub(super) fn is_several(pattern: &Path) -> bool {
    first_slot(pattern.as_os_str().as_encoded_bytes()).is_some()
}

/// The files that a name means for scenes or layers of these names, one for each, or one for all. Each can be written, and is
/// none of `sources`: those would be gone.
pub(super) fn scene_files<'a>(
    pattern: &Path,
    names: &[&str],
    sources: impl Iterator<Item = &'a Path> + Clone,
) -> Result<Vec<PathBuf>, Failure> {
    let files: Vec<_> = match is_several(pattern) {
        false => vec![pattern.to_owned()],
        true => {
            let names = names.iter().map(|name| name.replace(['/', '\\'], "_"));
            let named = names.enumerate();
            named
                .map(|(number, name)| filled_with(pattern, number, &name, &name))
                .collect()
        }
    };
    for (number, file) in files.iter().enumerate() {
        if files[..number].contains(file) {
            return Err(Failure::Usage(format!(
                "two of the scenes would be written to {}; rename one, as NAME=FILE, or leave the braces out to write all as one",
                file.display()
            )));
        }
        if let Some(source) = sources.clone().find(|one| output::is_same(one, file)) {
            return Err(Failure::Usage(format!(
                "{} is one of the scenes, and writing it would replace {}; name another file",
                file.display(),
                source.display()
            )));
        }
        output::check_file(file)?;
    }
    Ok(files)
}

/// The first braces that stand for something: where they are, how long they are, and for what they stand.
fn first_slot(text: &[u8]) -> Option<(usize, usize, Slot)> {
    let begins = (0..text.len()).filter(|at| text[*at] == b'{');
    begins.into_iter().find_map(|at| {
        let length = text[at..].iter().position(|byte| *byte == b'}')? + 1;
        let slot = match &text[at + 1..at + length - 1] {
            b"" => Slot::Number(0),
            b"name" => Slot::Name,
            [b':', b'0', digit @ b'1'..=b'9'] => Slot::Number((digit - b'0').into()),
            _ => return None,
        };
        Some((at, length, slot))
    })
}

/// A view's name as a part of a file's name: without its ending, and without what would lead elsewhere.
fn bare(name: &str) -> String {
    let stem = name.rsplit_once('.').map_or(name, |(stem, ending)| {
        let is_ending = !stem.is_empty()
            && !stem.ends_with(['/', '.'])
            && ending.chars().all(|c| c.is_ascii_alphabetic());
        if is_ending { stem } else { name }
    });
    let kept = |c: char| match c {
        '/' | '\\' | ':' => '_',
        c if c.is_control() => '_',
        c => c,
    };
    stem.trim_start_matches(['.', '/'])
        .chars()
        .map(kept)
        .collect()
}

#[cfg(unix)]
fn os_string(bytes: Vec<u8>, _: &OsStr) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes)
}

/// Elsewhere names are text, or stay as they are.
#[cfg(not(unix))]
fn os_string(bytes: Vec<u8>, pattern: &OsStr) -> OsString {
    String::from_utf8(bytes).map_or_else(|_| pattern.to_owned(), Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_take_their_places() {
        let named = |pattern: &str| {
            let made = filled(Path::new(pattern), 7, "./images/00{}1.jpg");
            made.to_str().expect("text").to_owned()
        };
        assert_eq!(named("v_{}.png"), "v_7.png");
        assert_eq!(named("v_{:03}_{}.png"), "v_007_7.png");
        assert_eq!(named("a/{name}.png"), "a/images_00{}1.png");
        assert_eq!(named("{{}}{other}{:3}"), "{7}{other}{:3}");
        assert_eq!(filled(Path::new("{name}"), 0, "z=0.5"), Path::new("z=0.5"));
        assert_eq!(filled(Path::new("{name}"), 0, "../.x"), Path::new("x"));
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_text_is_filled_too() {
        use std::os::unix::ffi::OsStrExt;
        let pattern = Path::new(OsStr::from_bytes(b"\xff_{}.png"));
        let made = filled(pattern, 12, "");
        assert_eq!(made.as_os_str().as_bytes(), b"\xff_12.png");
    }
}
