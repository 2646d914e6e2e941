//! Streamed SOG: a tree of places, each with Gaussians of several levels of detail in folders of SOG.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use serde_json::Value;

use super::super::{Failure, Made, beside, json};
use crate::scene::{Gaussians, LoadReport};

/// Reads the finest level that each place has, and the surroundings.
pub(in super::super) fn read(document: &Value, folder: Option<&Path>) -> Result<Made, Failure> {
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
            (Some(file), Some(offset), Some(count)) if (file as usize) < names.len() => {
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
    let mut whole = Made {
        gaussians: Gaussians::default(),
        report: LoadReport::default(),
    };
    let mut read = HashSet::new();
    for (file, mut ranges) in pieces {
        if !read.insert(names[file].as_str()) {
            return Err(Failure::Format(format!(
                "lod-meta.json names file {file} twice; export the scene again"
            )));
        }
        let mut piece = load(&names[file], folder)?;
        ranges.sort_unstable();
        let count = piece.gaussians.len() as u64 + piece.report.dropped;
        let next = ranges.iter().try_fold(0, |next, &[first, end]| {
            (first >= next && end <= count).then_some(end)
        });
        if next.is_none() {
            return Err(Failure::Format(format!(
                "lod-meta.json asks for Gaussians of file {file} twice, or for more than its {count}; export the scene again"
            )));
        }
        // Where some were dropped, numbers have moved: the whole file is as near as can be.
        let all = ranges.iter().map(|[first, end]| end - first).sum::<u64>() == count;
        if !all && piece.report.dropped == 0 {
            let mut part_of = vec![0; piece.gaussians.len()];
            for [first, end] in ranges {
                part_of[first as usize..end as usize].fill(1);
            }
            let parts = std::mem::take(&mut piece.gaussians).into_parts(&part_of, 2)?;
            piece.gaussians = parts.into_iter().nth(1).unwrap_or_default().gaussians;
        }
        whole.append(piece);
    }
    if let Some(surroundings) = document.get("environment").filter(|name| !name.is_null()) {
        whole.append(load(surroundings, folder)?);
    }
    Ok(whole)
}

/// A folder of SOG, by the name of its `meta.json`.
fn load(name: &Value, folder: Option<&Path>) -> Result<Made, Failure> {
    let name = name.as_str().ok_or_else(|| {
        "a file name in lod-meta.json is no text; export the scene again".to_owned()
    })?;
    let document = json(&beside(name, folder)?)?;
    let own = folder.and_then(|folder| Some(folder.join(name).parent()?.to_owned()));
    super::read_folder(&document, own.as_deref())
}
