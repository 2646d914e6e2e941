//! A scene in a file that only compresses it: a gzip stream, or a zip archive that holds nothing else that could be meant.

use std::path::Path;

use super::files::{Archive, Files, own_name};
use super::inflate::Gzip;
use super::{Failure, Format, project};
use rara_base::counted::counted;

/// A stream may become so many times as large: scenes are numbers without much order, of which gzip saves half.
const MOST: u64 = 64;
/// A scene of a few Gaussians may have so many bytes more.
const LEAST: u64 = 1 << 20;

/// Returns the scene that a gzip stream holds; `None` for what is no such stream.
pub(super) fn decompressed(bytes: &[u8]) -> Result<Option<Vec<u8>>, Failure> {
    match is_gzip(bytes) {
        true => once(gzip(bytes)?).map(Some),
        false => Ok(None),
    }
}

/// Returns the one scene that an archive wraps, and where the files beside it are; `None` for an archive that wraps none, as
/// one whose files are a scene together.
pub(super) fn unpacked<'a>(
    archive: &'a Archive<'_>,
) -> Result<Option<(Vec<u8>, Files<'a>)>, Failure> {
    let Some(path) = scene(archive)? else {
        return Ok(None);
    };
    let scene = once(archive.get(path)?)?;
    Ok(Some((scene, Files::beside(archive, path))))
}

/// Refuses a scene that is wrapped once more.
fn once(scene: Vec<u8>) -> Result<Vec<u8>, Failure> {
    if is_gzip(&scene) || is_archive(&scene) {
        return Err(Failure::Format(
            "it is compressed twice; decompress it once".into(),
        ));
    }
    Ok(scene)
}

/// True for a gzip stream that is no `.spz`. What is damaged from the start is said by the reader of `.spz`.
fn is_gzip(bytes: &[u8]) -> bool {
    let is_stream = bytes.starts_with(&[0x1f, 0x8b]);
    is_stream && Gzip::new(bytes).next(4).is_ok_and(|start| start != b"NGSP")
}

fn is_archive(bytes: &[u8]) -> bool {
    let archive = Archive::is(bytes)
        .then(|| Archive::open(bytes).ok())
        .flatten();
    archive.is_some_and(|archive| !matches!(scene(&archive), Ok(None)))
}

fn gzip(bytes: &[u8]) -> Result<Vec<u8>, Failure> {
    let most = MOST * bytes.len() as u64 + LEAST;
    let mut stream = Gzip::new(bytes);
    let scene = stream.next(most)?;
    match stream.rest()? {
        0 => Ok(scene),
        _ => Err(Failure::Format(format!(
            "its gzip stream has {} and more, which no scene compresses to that; decompress it, if it is one",
            counted(scene.len(), "byte")
        ))),
    }
}

/// The file that describes what the others of an archive are together, if there is one.
pub(super) fn description(archive: &Archive<'_>) -> Option<&'static str> {
    names_scenes(archive).or_else(|| archive.find("meta.json").and(Some("meta.json")))
}

/// The same of one that may name files that are scenes themselves.
fn names_scenes(archive: &Archive<'_>) -> Option<&'static str> {
    match archive.find("lod-meta.json") {
        Some(_) => Some("lod-meta.json"),
        None => project::document(archive).and(Some(project::DOCUMENT)),
    }
}

/// The scene of an archive that holds nothing else that could be meant.
fn scene<'a>(archive: &'a Archive<'_>) -> Result<Option<&'a Path>, Failure> {
    if names_scenes(archive).is_some() {
        return Ok(None);
    }
    let scenes = archive
        .paths()
        .filter(|path| Format::is_name(&own_name(path)));
    match scenes.collect::<Vec<_>>().as_slice() {
        [] => Ok(None),
        [one] => Ok(Some(one)),
        several => Err(Failure::Format(format!(
            "the archive holds {}; unpack it, and give the one that is meant",
            counted(several.len(), "scene")
        ))),
    }
}

#[cfg(test)]
pub(super) mod tests;
