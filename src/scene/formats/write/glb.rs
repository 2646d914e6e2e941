//! Writing `.glb` with `KHR_gaussian_splatting`, all in single precision.

use std::ops::Range;

use glam::DVec3;
use serde_json::{Value, json};

use super::super::super::{Annotations, Gaussians, SortBy, Training};
use super::super::gltf::{ANTIALIASED, EXTENSION, LINEAR, MARKS, STORED, turn};
use super::corners;
use crate::annotations::Words;
use crate::placement::Placement;
use rara_base::error::{Error, Result};

pub(super) fn encode(gaussians: &Gaussians, annotations: Option<&Annotations>) -> Result<Vec<u8>> {
    let usual;
    let annotations = match annotations {
        Some(annotations) => annotations,
        None => {
            usual = Annotations::of(gaussians);
            &usual
        }
    };
    annotations.check(gaussians)?;
    let mut turned = gaussians.clone();
    turned.set_origin(DVec3::ZERO)?;
    // The reader turns the other way, which gives the same bits again.
    let _all_fit = turned.place(&Placement::new(DVec3::ZERO, turn().inverse(), 1.0)?);
    let mut parts = Parts::default();
    let marks = marks(gaussians.training());
    let translation = turn().inverse() * gaussians.origin();
    let (mut nodes, mut meshes, mut roots) = (Vec::<Value>::new(), Vec::new(), Vec::new());
    let mut first = 0;
    for (number, node) in annotations.nodes.iter().enumerate() {
        let mut primitives = Vec::new();
        for one in &node.primitives {
            let range = first..first + one.count;
            first = range.end;
            // glTF knows no primitive of nothing; where there is nothing else, our reader takes it.
            if !range.is_empty() || turned.is_empty() {
                let extras = with_marks(one.extras.as_ref(), &marks);
                primitives.push(parts.primitive(&turned, range, extras));
            }
        }
        let mut made = node.words.clone();
        if !primitives.is_empty() {
            made.insert("mesh".into(), json!(meshes.len()));
            let mut mesh = node.mesh.clone();
            mesh.insert("primitives".into(), json!(primitives));
            meshes.push(mesh);
        }
        match node.parent {
            Some(parent) => {
                let parent = &mut nodes[parent];
                match parent.get_mut("children").and_then(Value::as_array_mut) {
                    Some(children) => children.push(json!(number)),
                    None => parent["children"] = json!([number]),
                }
            }
            None => {
                roots.push(number);
                if translation != DVec3::ZERO {
                    made.insert("translation".into(), json!(translation.to_array()));
                }
            }
        }
        nodes.push(made.into());
    }
    let mut asset = annotations.asset.clone();
    asset.insert("version".into(), json!("2.0"));
    let generator = concat!("rara ", env!("CARGO_PKG_VERSION"));
    asset.insert("generator".into(), json!(generator));
    let mut scene = annotations.scene.clone();
    scene.insert("nodes".into(), json!(roots));
    let document = json!({
        "asset": asset,
        "extensionsUsed": [EXTENSION],
        "scene": 0,
        "scenes": [scene],
        "nodes": nodes,
        "meshes": meshes,
        "buffers": [{ "byteLength": parts.bytes.len() }],
        "bufferViews": parts.views,
        "accessors": parts.accessors,
    });
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

/// What glTF has no property for in how Gaussians were trained.
fn marks(training: Training) -> Words {
    let usual = Training::default()
        .sort_by(SortBy::Distance)
        .alpha_max(1.0)
        .linear(training.linear);
    let mut marks: Words = training
        .marks(usual)
        .map(|(name, value)| (name.into(), json!(value)))
        .collect();
    if training.antialiased {
        marks.insert(ANTIALIASED.into(), json!(true));
    }
    marks
}

/// The extras of a primitive with the marks in them. Extras that are no object, which glTF advises against, become a member.
fn with_marks(extras: Option<&Value>, marks: &Words) -> Option<Value> {
    if marks.is_empty() {
        return extras.cloned();
    }
    let mut all = match extras {
        Some(Value::Object(extras)) => extras.clone(),
        Some(other) => Words::from_iter([("extras".into(), other.clone())]),
        None => Words::new(),
    };
    all.insert(MARKS.into(), json!(marks));
    Some(all.into())
}

/// The buffer and what describes it.
#[derive(Default)]
struct Parts {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Parts {
    /// Adds Gaussians, and returns the primitive of them.
    fn primitive(
        &mut self,
        gaussians: &Gaussians,
        range: Range<usize>,
        extras: Option<Value>,
    ) -> Value {
        let first = self.accessors.len();
        let mut attributes = Words::new();
        let mut add = |name: String, kind: &str, values: &mut dyn Iterator<Item = f32>| {
            attributes.insert(name, json!(self.views.len()));
            self.add(kind, values, range.len());
        };
        let own = |name: &str| format!("{EXTENSION}:{name}");
        let centres = &gaussians.positions()[range.clone()];
        let [low, high] = corners(centres);
        let mut numbers = centres.iter().flat_map(|centre| centre.to_array());
        add("POSITION".into(), "VEC3", &mut numbers);
        let rotations = gaussians.rotations()[range.clone()].iter();
        add(
            own("ROTATION"),
            "VEC4",
            &mut rotations.flat_map(|q| q.to_array()),
        );
        let scales = gaussians.scales()[range.clone()].iter();
        add(own("SCALE"), "VEC3", &mut scales.flat_map(|s| s.to_array()));
        let opacities = gaussians.opacities()[range.clone()].iter();
        add(own("OPACITY"), "SCALAR", &mut opacities.copied());
        let mut number = 0;
        for band in 0..=gaussians.sh_degree() {
            for coefficient in 0..=2 * band {
                let name = own(&format!("SH_DEGREE_{band}_COEF_{coefficient}"));
                let mut numbers = range.clone().flat_map(|at| {
                    let rgb = &gaussians.sh_of(at)[3 * number..];
                    [rgb[0], rgb[1], rgb[2]]
                });
                add(name, "VEC3", &mut numbers);
                number += 1;
            }
        }
        let centres = &mut self.accessors[first];
        centres["min"] = json!(low.to_array());
        centres["max"] = json!(high.to_array());
        let mut primitive = json!({
            "mode": 0,
            "attributes": attributes,
            "extensions": { EXTENSION: {
                "kernel": "ellipse",
                "colorSpace": match gaussians.training().linear {
                    true => LINEAR,
                    false => STORED,
                },
                "sortingMethod": "cameraDistance",
                "projection": "perspective",
            } },
        });
        if let Some(extras) = extras {
            primitive["extras"] = extras;
        }
        primitive
    }

    fn add(&mut self, kind: &str, values: &mut dyn Iterator<Item = f32>, count: usize) {
        let first = self.bytes.len();
        values.for_each(|value| self.bytes.extend(value.to_le_bytes()));
        let view = self.views.len();
        self.views.push(
            json!({ "buffer": 0, "byteOffset": first, "byteLength": self.bytes.len() - first }),
        );
        self.accessors.push(
            json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind }),
        );
    }
}
