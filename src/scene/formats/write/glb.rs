//! Writing `.glb` with `KHR_gaussian_splatting`, all in single precision.

use glam::DVec3;
use serde_json::{Value, json};

use super::super::super::{Gaussians, SortBy, Training};
use super::super::gltf::{ANTIALIASED, EXTENSION, LINEAR, MARKS, STORED, turn};
use super::corners;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

pub(super) fn encode(gaussians: &Gaussians) -> Result<Vec<u8>> {
    let mut turned = gaussians.clone();
    turned.set_origin(DVec3::ZERO)?;
    // The reader turns the other way, which gives the same bits again.
    let _all_fit = turned.place(&Placement::new(DVec3::ZERO, turn().inverse(), 1.0)?);
    let count = turned.len();
    let mut parts = Parts::default();
    let [low, high] = corners(&turned);
    parts.add(
        "POSITION".into(),
        "VEC3",
        turned.positions().iter().flat_map(|p| p.to_array()),
        count,
    );
    if let Some(first) = parts.accessors.first_mut() {
        first["min"] = json!(low.to_array());
        first["max"] = json!(high.to_array());
    }
    let own = |name: &str| format!("{EXTENSION}:{name}");
    let rotations = turned.rotations().iter().flat_map(|q| q.to_array());
    parts.add(own("ROTATION"), "VEC4", rotations, count);
    let scales = turned.scales().iter().flat_map(|scale| scale.to_array());
    parts.add(own("SCALE"), "VEC3", scales, count);
    parts.add(
        own("OPACITY"),
        "SCALAR",
        turned.opacities().iter().copied(),
        count,
    );
    let mut number = 0;
    for band in 0..=turned.sh_degree() {
        for coefficient in 0..=2 * band {
            let name = own(&format!("SH_DEGREE_{band}_COEF_{coefficient}"));
            let values = (0..count).flat_map(|at| {
                let rgb = &turned.sh_of(at)[3 * number..];
                [rgb[0], rgb[1], rgb[2]]
            });
            parts.add(name, "VEC3", values, count);
            number += 1;
        }
    }
    let training = gaussians.training();
    let usual = Training::default()
        .sort_by(SortBy::Distance)
        .alpha_max(1.0)
        .linear(training.linear);
    let mut marks: serde_json::Map<String, Value> = training
        .marks(usual)
        .map(|(name, value)| (name.into(), json!(value)))
        .collect();
    if training.antialiased {
        marks.insert(ANTIALIASED.into(), json!(true));
    }
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("rara ", env!("CARGO_PKG_VERSION")) },
        "extensionsUsed": [EXTENSION],
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{
            "mode": 0,
            "attributes": parts.attributes,
            "extensions": { EXTENSION: {
                "kernel": "ellipse",
                "colorSpace": match turned.training().linear {
                    true => LINEAR,
                    false => STORED,
                },
                "sortingMethod": "cameraDistance",
                "projection": "perspective",
            } },
        }] }],
        "buffers": [{ "byteLength": parts.bytes.len() }],
        "bufferViews": parts.views,
        "accessors": parts.accessors,
    });
    if gaussians.origin() != DVec3::ZERO {
        let translation = turn().inverse() * gaussians.origin();
        document["nodes"][0]["translation"] = json!(translation.to_array());
    }
    if !marks.is_empty() {
        document["meshes"][0]["primitives"][0]["extras"] = json!({ MARKS: marks });
    }
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = u32::try_from(28 + text.len() + parts.bytes.len());
    let total =
        total.map_err(|_| Error::Invalid("the scene is too large for a .glb; divide it".into()))?;
    let mut file = b"glTF".to_vec();
    [2, total, text.len() as u32]
        .iter()
        .for_each(|number| file.extend(number.to_le_bytes()));
    file.extend(b"JSON");
    file.append(&mut text);
    file.extend((parts.bytes.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.append(&mut parts.bytes);
    Ok(file)
}

/// The buffer and what describes it.
#[derive(Default)]
struct Parts {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    attributes: serde_json::Map<String, Value>,
}

impl Parts {
    fn add(&mut self, name: String, kind: &str, values: impl Iterator<Item = f32>, count: usize) {
        let first = self.bytes.len();
        values.for_each(|value| self.bytes.extend(value.to_le_bytes()));
        let view = self.views.len();
        self.views.push(
            json!({ "buffer": 0, "byteOffset": first, "byteLength": self.bytes.len() - first }),
        );
        self.accessors.push(
            json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind }),
        );
        self.attributes.insert(name, json!(view));
    }
}
