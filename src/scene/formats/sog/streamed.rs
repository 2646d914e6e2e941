//! Streamed SOG: a tree of places, each with Gaussians of several levels of detail in folders of SOG.

use std::collections::{BTreeMap, HashSet};
use std::path::PathBuf;

use serde_json::Value;

use super::super::files::Archive;
use super::super::{Failure, Files, FormatOutput, json, list};

/// Reads the finest level that each place has, and the surroundings.
pub(in super::super) fn read(document: &Value, files: Files<'_>) -> Result<FormatOutput, Failure> {
    let names = list(document, "filenames");
    let mut pieces: BTreeMap<usize, Vec<[u64; 2]>> = BTreeMap::new();
    let mut nodes: Vec<&Value> = document.get("tree").into_iter().collect();
    while let Some(node) = nodes.pop() {
        nodes.extend(list(node, "children"));
        let Some(levels) = node.get("lods").and_then(Value::as_object) else {
            continue;
        };
        let level = |(name, piece): (&String, _)| Some((name.parse::<u32>().ok()?, piece));
        let finest = levels
            .iter()
            .filter_map(level)
            .min_by_key(|(level, _)| *level);
        let Some((_, piece)) = finest else { continue };
        let number = |key: &str| piece.get(key).and_then(Value::as_u64);
        match (number("file"), number("offset"), number("count")) {
            (Some(file), Some(offset), Some(count)) if file < names.len() as u64 => {
                let end = offset.saturating_add(count);
                pieces.entry(file as usize).or_default().push([offset, end]);
            }
            _ => {
                return Err(Failure::Format(
                    "a place in lod-meta.json has no file, offset and count that fit its filenames; export the scene again"
                        .into(),
                ));
            }
        }
    }
    let mut whole = FormatOutput::default();
    let mut read = HashSet::new();
    for (file, mut ranges) in pieces {
        let mut piece = load(&names[file], files, &mut read)?;
        ranges.sort_unstable();
        let count = piece.elements;
        let next = ranges.iter().try_fold(0, |next, &[first, end]| {
            (first >= next && end <= count).then_some(end)
        });
        if next.is_none() {
            return Err(Failure::Format(format!(
                "lod-meta.json asks for Gaussians of file {file} twice, or for more than its {count}; export the scene again"
            )));
        }
        let all = ranges.iter().map(|[first, end]| end - first).sum::<u64>() == count;
        if !all {
            let mut open = ranges.iter().peekable();
            let mut is_asked = |element: u64| {
                while open.next_if(|[_, end]| *end <= element).is_some() {}
                open.peek().is_some_and(|[first, _]| *first <= element)
            };
            let numbered = (0_u32..).zip(piece.numbers());
            let (kept, left_out): (Vec<_>, Vec<_>) =
                numbered.partition(|(_, element)| is_asked(*element));
            let kept: Vec<u32> = kept.into_iter().map(|(number, _)| number).collect();
            piece.gaussians.keep(&kept);
            let left_out = left_out.into_iter().map(|(_, element)| element);
            piece.dropped.extend(left_out);
            piece.dropped.sort_unstable();
        }
        whole.append(piece)?;
    }
    if let Some(surroundings) = document.get("environment").filter(|name| !name.is_null()) {
        whole.append(load(surroundings, files, &mut read)?)?;
    }
    Ok(whole)
}

/// A scene of SOG by the name of its `meta.json` or of its archive, which may not have been read before.
fn load(
    name: &Value,
    files: Files<'_>,
    read: &mut HashSet<PathBuf>,
) -> Result<FormatOutput, Failure> {
    let name = name.as_str().ok_or_else(|| {
        "a file name in lod-meta.json is not text; export the scene again".to_owned()
    })?;
    let path = files.path(name)?;
    // Its parts, since there are many ways to write one path.
    if !read.insert(path.components().collect()) {
        return Err(Failure::Format(format!(
            "lod-meta.json names the file \"{}\" twice; export the scene again",
            rara_base::error::shortened(name)
        )));
    }
    let bytes = files.get(name)?;
    if Archive::is(&bytes) {
        let archive = Archive::open(&bytes)?;
        let (document, pictures) = archive.document("meta.json")?;
        return super::read(&document, pictures);
    }
    super::read(&json(&bytes)?, files.at(&path))
}
