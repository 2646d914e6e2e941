//! Streamed SOG: a tree of places, each with Gaussians of several levels of detail in folders of SOG.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::super::{Failure, FormatOutput, beside, json};

/// Reads the finest level that each place has, and the surroundings.
pub(in super::super) fn read(
    document: &Value,
    folder: Option<&Path>,
) -> Result<FormatOutput, Failure> {
    let names = document.get("filenames").and_then(Value::as_array);
    let names = names.map(Vec::as_slice).unwrap_or_default();
    let mut pieces: BTreeMap<usize, Vec<[u64; 2]>> = BTreeMap::new();
    let mut nodes: Vec<&Value> = document.get("tree").into_iter().collect();
    while let Some(node) = nodes.pop() {
        let children = node.get("children").and_then(Value::as_array);
        nodes.extend(children.into_iter().flatten());
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
        let mut piece = load(&names[file], folder, &mut read)?;
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
            let part_of = piece.numbers().map(|element| {
                while open.next_if(|[_, end]| *end <= element).is_some() {}
                u32::from(open.peek().is_none_or(|[first, _]| *first > element))
            });
            let part_of: Vec<u32> = part_of.collect();
            let numbered = piece.numbers().zip(&part_of);
            let left_out: Vec<u64> = numbered
                .filter(|(_, part)| **part == 1)
                .map(|(element, _)| element)
                .collect();
            piece.dropped.extend(left_out);
            piece.dropped.sort_unstable();
            let parts = std::mem::take(&mut piece.gaussians).into_parts(&part_of, 2)?;
            piece.gaussians = parts.into_iter().next().unwrap_or_default().gaussians;
        }
        whole.append(piece)?;
    }
    if let Some(surroundings) = document.get("environment").filter(|name| !name.is_null()) {
        whole.append(load(surroundings, folder, &mut read)?)?;
    }
    Ok(whole)
}

/// A folder of SOG, by the name of its `meta.json`, which may not have been read before.
fn load(
    name: &Value,
    folder: Option<&Path>,
    read: &mut HashSet<PathBuf>,
) -> Result<FormatOutput, Failure> {
    let name = name.as_str().ok_or_else(|| {
        "a file name in lod-meta.json is no text; export the scene again".to_owned()
    })?;
    // Its parts, since there are many ways to write one path.
    if !read.insert(Path::new(name).components().collect()) {
        return Err(Failure::Format(format!(
            "lod-meta.json names the file \"{}\" twice; export the scene again",
            rara_base::error::shortened(name)
        )));
    }
    let document = json(&beside(name, folder)?)?;
    let own = folder.and_then(|folder| Some(folder.join(name).parent()?.to_owned()));
    super::read_folder(&document, own.as_deref())
}
