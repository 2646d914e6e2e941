//! `KHR_gaussian_splatting`, row by row: each test has an asset of its own that differs from the plain one in one thing.

use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    ExpMode, VertexEncoding, encode_filter_exp, encode_filter_quat, encode_vertex_buffer,
};
use rara::glam::{DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};
use rara::scene::{
    Annotations, LoadReport, Property, SaveOptions, SceneFile, load, load_from_with, save_with,
};
use rara::{Gaussians, SortBy, Training};
use serde_json::{Value, json};

use super::variants::base64;
use crate::common::folder::Folder;
use std::io::Cursor;
use std::path::Path;

/// The extension, with whose name its attributes begin.
const OWN: &str = "KHR_gaussian_splatting";

/// Elements of so many parts, less one.
const KINDS: [&str; 4] = ["SCALAR", "VEC2", "VEC3", "VEC4"];

/// An asset of two Gaussians of degree 1, which tests change.
struct Asset {
    document: Value,
    bytes: Vec<u8>,
}

/// The plain asset's Gaussians in glTF's axes.
fn stored() -> Gaussians {
    let mut stored = Gaussians::default();
    stored.set_sh_degree(1);
    let sh: Vec<f32> = (0..12).map(|at| 0.1 * at as f32 - 0.5).collect();
    let turn = Quat::from_xyzw(0.1, 0.7, -0.1, 0.7).normalize();
    stored.push(
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::new(0.5, 0.02, 1.0),
        turn,
        0.25,
        &sh,
    );
    let turn = Quat::from_xyzw(-0.5, 0.5, 0.5, 0.5);
    stored.push(
        Vec3::new(-1.0, 0.5, 4.0),
        Vec3::new(0.1, 0.2, 0.3),
        turn,
        1.0,
        &sh,
    );
    stored
}

impl Asset {
    fn new() -> Self {
        let mut asset = Self {
            document: json!({
                "asset": {"version": "2.0"},
                "extensionsUsed": [OWN],
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"mode": 0, "attributes": {}, "extensions": {OWN: {
                    "kernel": "ellipse", "colorSpace": "srgb_rec709_display",
                }}}]}],
                "buffers": [],
                "bufferViews": [],
                "accessors": [],
            }),
            bytes: Vec::new(),
        };
        let stored = stored();
        let sh = |at: usize| [0, 1].map(|of: usize| stored.sh_of(of)[3 * at..][..3].to_vec());
        let floats = [
            (
                "POSITION".to_owned(),
                flat(stored.positions().iter().map(Vec3::to_array)),
            ),
            (
                format!("{OWN}:ROTATION"),
                flat(stored.rotations().iter().map(|q| q.to_array())),
            ),
            (
                format!("{OWN}:SCALE"),
                flat(stored.scales().iter().map(Vec3::to_array)),
            ),
            (format!("{OWN}:OPACITY"), stored.opacities().to_vec()),
            (format!("{OWN}:SH_DEGREE_0_COEF_0"), sh(0).concat()),
            (format!("{OWN}:SH_DEGREE_1_COEF_0"), sh(1).concat()),
            (format!("{OWN}:SH_DEGREE_1_COEF_1"), sh(2).concat()),
            (format!("{OWN}:SH_DEGREE_1_COEF_2"), sh(3).concat()),
        ];
        for (name, values) in floats {
            asset.set(&name, &values);
        }
        asset
    }

    /// Adds bytes to the buffer; returns the number of their view.
    fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.document["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        views.len() - 1
    }

    /// Adds an accessor; returns its number.
    fn accessor(&mut self, accessor: Value) -> usize {
        let accessors = self.document["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.document["meshes"][0]["primitives"][0]
    }

    /// An attribute of floats in place of what the asset has.
    fn set(&mut self, name: &str, values: &[f32]) {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let view = self.view(&bytes);
        let kind = KINDS[values.len() / 2 - 1];
        let accessor = self
            .accessor(json!({"bufferView": view, "componentType": 5126, "count": 2, "type": kind}));
        self.primitive()["attributes"][name] = json!(accessor);
    }

    fn load(&self) -> rara::Result<(Gaussians, LoadReport)> {
        let found = self.file()?;
        Ok((found.gaussians, found.report))
    }

    fn file(&self) -> rara::Result<SceneFile> {
        self.asked(&[]).map(|(file, _)| file)
    }

    /// With the properties of these names.
    fn asked(&self, names: &[&str]) -> rara::Result<(SceneFile, Vec<Property>)> {
        let mut document = self.document.clone();
        document["buffers"] = json!([{
            "byteLength": self.bytes.len(),
            "uri": format!("data:application/octet-stream;base64,{}", base64(&self.bytes)),
        }]);
        let text = document.to_string();
        load_from_with(
            Cursor::new(text),
            Path::new("a.gltf"),
            names,
            &mut |_, _| (),
        )
    }
}

fn flat<const N: usize>(all: impl Iterator<Item = [f32; N]>) -> Vec<f32> {
    all.flatten().collect()
}

fn covariance(gaussians: &Gaussians, at: usize) -> DMat3 {
    let turn = DMat3::from_quat(gaussians.rotations()[at].as_dquat());
    let scales = gaussians.scales()[at].as_dvec3();
    turn * DMat3::from_diagonal(scales * scales) * turn.transpose()
}

/// The colour that a Gaussian of degree 1 has in a direction.
fn colour(gaussians: &Gaussians, at: usize, to: DVec3) -> DVec3 {
    let sh = gaussians.sh_of(at);
    let part = |at: usize| {
        DVec3::new(
            sh[3 * at].into(),
            sh[3 * at + 1].into(),
            sh[3 * at + 2].into(),
        )
    };
    0.282_094_8 * part(0) + 0.488_602_5 * (part(2) * to.z - part(1) * to.y - part(3) * to.x)
}

/// From glTF's left, up and forward to right, down and forward.
fn to_ours() -> DMat3 {
    DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0))
}

/// Asserts that the Gaussians from `first` on are those of the plain asset by a transform in glTF's axes, of which the
/// harmonics follow `turn`.
fn assert_transformed(found: &Gaussians, first: usize, by: DAffine3, turn: DMat3) {
    let stored = stored();
    let to_ours = to_ours();
    for at in 0..2 {
        let place = to_ours * by.transform_point3(stored.positions()[at].as_dvec3());
        let there = found.positions()[first + at].as_dvec3();
        assert!(
            place.distance(there) < 1e-5 * (1.0 + place.length()),
            "{place} {there}"
        );
        let linear = to_ours * by.matrix3;
        let expected = linear * covariance(&stored, at) * linear.transpose();
        let size = expected.to_cols_array().into_iter().fold(0.0, f64::max);
        let ours = covariance(found, first + at);
        assert!(ours.abs_diff_eq(expected, 1e-5 * size), "{ours} {expected}");
        for to in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, -0.8)] {
            let expected = colour(&stored, at, to);
            let seen = colour(found, first + at, to_ours * turn * to);
            assert!(seen.distance(expected) < 1e-5, "{seen} {expected}");
        }
    }
}

#[test]
fn nodes_scale_non_uniformly() {
    let mut asset = Asset::new();
    let turn = DQuat::from_xyzw(0.5, -0.5, 0.5, 0.5);
    asset.document["nodes"] = json!([{
        "mesh": 0, "scale": [4, 0.2, 4], "rotation": turn.to_array(), "translation": [1, 2, 3],
    }]);
    let by = DAffine3::from_scale_rotation_translation(
        DVec3::new(4.0, 0.2, 4.0),
        turn,
        DVec3::new(1.0, 2.0, 3.0),
    );
    let (found, report) = asset.load().unwrap();
    assert!(report.is_clean(), "{report}");
    assert_transformed(&found, 0, by, DMat3::from_quat(turn));

    // The same as a matrix.
    let [a, b, c] = by.matrix3.to_cols_array_2d();
    asset.document["nodes"] = json!([{"mesh": 0, "matrix": [
        a[0], a[1], a[2], 0, b[0], b[1], b[2], 0, c[0], c[1], c[2], 0, 1, 2, 3, 1,
    ]}]);
    assert_transformed(&asset.load().unwrap().0, 0, by, DMat3::from_quat(turn));
}

#[test]
fn nodes_mirror_what_they_have() {
    for mirror in [
        DVec3::new(1.0, 1.0, -1.0),
        DVec3::NEG_ONE,
        DVec3::new(-2.0, 1.0, 0.5),
    ] {
        let mut asset = Asset::new();
        asset.document["nodes"] = json!([{"mesh": 0, "scale": mirror.to_array()}]);
        let by = DAffine3::from_scale(mirror);
        let turn = DMat3::from_diagonal(mirror.signum());
        assert_transformed(&asset.load().unwrap().0, 0, by, turn);
    }
    // Two mirrors are half a turn.
    let mut asset = Asset::new();
    asset.document["nodes"] =
        json!([{"children": [1], "scale": [-1, 1, 1]}, {"mesh": 0, "scale": [1, -1, 1]}]);
    let turn = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
    let (found, _) = asset.load().unwrap();
    assert_transformed(&found, 0, DAffine3::from_mat3(turn), turn);
}

/// A rotation below a non-uniform scale is a shear. The harmonics follow the rotation that is nearest to it.
#[test]
fn nodes_within_each_other_shear() {
    let mut asset = Asset::new();
    let (sin, cos) = std::f64::consts::FRAC_PI_8.sin_cos();
    asset.document["nodes"] = json!([
        {"children": [1], "scale": [3, 1, 1], "translation": [0, 0, 5]},
        {"mesh": 0, "rotation": [0, 0, sin, cos]},
    ]);
    let outer = DAffine3::from_scale_rotation_translation(
        DVec3::new(3.0, 1.0, 1.0),
        DQuat::IDENTITY,
        DVec3::new(0.0, 0.0, 5.0),
    );
    let by = outer * DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_4);
    // In the plane: the angle whose tangent is the difference of the off-diagonal elements over the trace.
    let m = by.matrix3;
    let angle = (m.x_axis.y - m.y_axis.x).atan2(m.x_axis.x + m.y_axis.y);
    assert_transformed(
        &asset.load().unwrap().0,
        0,
        by,
        DMat3::from_rotation_z(angle),
    );
}

#[test]
fn instances_have_transforms_of_their_own() {
    let mut asset = Asset::new();
    let values = [1.0_f32, 2.0, 3.0, 1.0, 1.0, -1.0];
    let view = asset.view(&values.map(f32::to_le_bytes).concat());
    let scales = asset
        .accessor(json!({"bufferView": view, "componentType": 5126, "count": 2, "type": "VEC3"}));
    asset.document["nodes"] = json!([{"mesh": 0, "translation": [0, 1, 0], "extensions": {
        "EXT_mesh_gpu_instancing": {"attributes": {"SCALE": scales}},
    }}]);
    let (found, _) = asset.load().unwrap();
    assert_eq!(found.len(), 4);
    for (number, scales) in [
        (0, DVec3::new(1.0, 2.0, 3.0)),
        (1, DVec3::new(1.0, 1.0, -1.0)),
    ] {
        let by = DAffine3::from_scale_rotation_translation(scales, DQuat::IDENTITY, DVec3::Y);
        assert_transformed(
            &found,
            2 * number,
            by,
            DMat3::from_diagonal(scales.signum()),
        );
    }
}

/// A scale of zero in all directions hides a node; in one it makes discs.
#[test]
fn nodes_flatten_and_hide() {
    let mut asset = Asset::new();
    asset.document["scenes"] = json!([{"nodes": [0, 1]}]);
    asset.document["nodes"] =
        json!([{"mesh": 0, "scale": [0, 0, 0]}, {"mesh": 0, "scale": [1, 0, 1]}]);
    let (found, report) = asset.load().unwrap();
    assert!(
        report.to_string().contains("1 primitive of the glTF that"),
        "{report}"
    );
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert_transformed(&found, 0, flat, DMat3::IDENTITY);
    assert!(
        found
            .scales()
            .iter()
            .all(|scale| scale.min_element() < 1e-7)
    );
}

/// A node is hidden where one above it is.
#[test]
fn nodes_hide_what_is_below_them() {
    let mut asset = Asset::new();
    let hidden = json!({"KHR_node_visibility": {"visible": false}});
    let shown = json!({"KHR_node_visibility": {"visible": true}});
    asset.document["extensionsRequired"] = json!(["KHR_node_visibility"]);
    asset.document["scenes"] = json!([{"nodes": [0, 1]}]);
    asset.document["nodes"] = json!([
        {"children": [2], "extensions": hidden},
        {"mesh": 0, "extensions": shown},
        {"mesh": 0, "extensions": shown},
    ]);
    let (found, report) = asset.load().unwrap();
    assert_eq!(found.len(), stored().len(), "of one node");
    let says = "left out 1 primitive of the glTF that nodes hide";
    assert_eq!(report.lines(), [says]);
    asset.document["scenes"] = json!([{"nodes": [0]}]);
    assert!(asset.load().unwrap().0.is_empty());
}

#[test]
fn attributes_are_properties_that_can_be_asked_for() {
    let mut asset = Asset::new();
    let view = asset.view(&[6, 0, 0, 0, 2, 0, 0, 0]);
    let accessor = asset
        .accessor(json!({"bufferView": view, "componentType": 5125, "count": 2, "type": "SCALAR"}));
    asset.document["meshes"][0]["primitives"][0]["attributes"]["_CLASSIFICATION"] = json!(accessor);
    for asked in ["_CLASSIFICATION", "*"] {
        let (loaded, properties) = asset.asked(&[asked]).unwrap();
        let [property] = &properties[..] else {
            panic!("{properties:?}")
        };
        assert_eq!(
            (&property.name[..], &property.values[..]),
            ("_CLASSIFICATION", &[6.0, 2.0][..])
        );
        assert!(loaded.report.is_clean(), "{}", loaded.report);
    }
    let (loaded, _) = asset.asked(&[]).unwrap();
    assert!(
        loaded
            .report
            .to_string()
            .contains("that drawing does not use: _CLASSIFICATION")
    );
    let error = asset.asked(&["label"]).unwrap_err().to_string();
    assert!(error.contains("no property `label`"), "{error}");
}

/// Changes of elements, and elements of nothing else, which are zero.
#[test]
fn accessors_are_sparse() {
    let scale = format!("{OWN}:SCALE");
    for kind in [5121, 5123, 5125] {
        let mut asset = Asset::new();
        let number = asset.primitive()["attributes"][&scale].as_u64().unwrap() as usize;
        let indices = asset.view(&[1, 0, 0, 0]);
        let values = asset.view(&[3.0_f32, 4.0, 5.0].map(f32::to_le_bytes).concat());
        let sparse = json!({"count": 1, "indices": {"bufferView": indices, "componentType": kind},
            "values": {"bufferView": values}});
        asset.document["accessors"][number]["sparse"] = sparse;
        let scales = asset.load().unwrap().0.scales().to_vec();
        assert_eq!(scales, [stored().scales()[0], Vec3::new(3.0, 4.0, 5.0)]);

        asset.document["accessors"][number]
            .as_object_mut()
            .unwrap()
            .remove("bufferView");
        let scales = asset.load().unwrap().0.scales().to_vec();
        assert_eq!(scales, [Vec3::ZERO, Vec3::new(3.0, 4.0, 5.0)]);
    }
    let mut asset = Asset::new();
    let view = asset.view(&[1, 1, 2, 0]);
    for (sparse, says) in [
        (json!({}), "sparse without a count"),
        (
            json!({"count": 2, "indices": {"bufferView": view, "componentType": 5121},
            "values": {"bufferView": 0}}),
            "do not ascend",
        ),
        (
            json!({"count": 1, "indices": {"bufferView": view, "byteOffset": 2, "componentType": 5121},
            "values": {"bufferView": 0}}),
            "end beyond its elements",
        ),
        (
            json!({"count": 9, "indices": {"bufferView": view, "componentType": 5121},
            "values": {"bufferView": 0}}),
            "has not the bytes of 9 elements",
        ),
    ] {
        asset.document["accessors"][0]["sparse"] = sparse;
        let error = asset.load().unwrap_err().to_string();
        assert!(
            error.contains("POSITION") && error.contains(says),
            "{error}"
        );
    }
    // No bytes are behind this count.
    let mut asset = Asset::new();
    for accessor in asset.document["accessors"].as_array_mut().unwrap() {
        accessor["count"] = json!(4_000_000_000_u64);
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    let error = asset.load().unwrap_err().to_string();
    assert!(error.contains("4000000000 Gaussians"), "{error}");
}

/// The types of components, their bytes and what they stand for, of which one is given.
const TYPES: [(u32, bool, f64); 9] = [
    (5120, false, 1.0),
    (5120, true, 127.0),
    (5121, false, 1.0),
    (5121, true, 255.0),
    (5122, false, 1.0),
    (5122, true, 32767.0),
    (5123, false, 1.0),
    (5123, true, 65535.0),
    (5126, false, 1.0),
];

#[test]
fn attributes_are_of_all_types_that_are_allowed() {
    for (name, parts, negative, types) in [
        // The older text has signed scales and today's unsigned ones; positions are those of KHR_mesh_quantization.
        ("POSITION".to_owned(), 3, true, &TYPES[..]),
        (format!("{OWN}:SCALE"), 3, false, &TYPES[..]),
        (format!("{OWN}:ROTATION"), 4, true, &TYPES[1..]),
        (format!("{OWN}:OPACITY"), 1, false, &TYPES[..]),
    ] {
        for &(kind, normalized, most) in types {
            // Of each element one part is 1, and where there are signs another one -1.
            let mut values = vec![0.0; 2 * parts];
            values[0] = most;
            values[parts] = most;
            if negative && [5120, 5122, 5126].contains(&kind) && !name.ends_with("ROTATION") {
                values[2 * parts - 1] = -most;
            }
            let element: usize = match kind {
                5126 => 4 * parts,
                5122 | 5123 => (2 * parts).next_multiple_of(4),
                _ => parts.next_multiple_of(4),
            };
            let mut bytes = Vec::new();
            for values in values.chunks(parts) {
                for &value in values {
                    match kind {
                        5120 => bytes.extend((value as i8).to_le_bytes()),
                        5121 => bytes.extend((value as u8).to_le_bytes()),
                        5122 => bytes.extend((value as i16).to_le_bytes()),
                        5123 => bytes.extend((value as u16).to_le_bytes()),
                        _ => bytes.extend((value as f32).to_le_bytes()),
                    }
                }
                bytes.resize(bytes.len().next_multiple_of(element), 0);
            }
            let mut asset = Asset::new();
            let view = asset.view(&bytes);
            asset.document["bufferViews"][view]["byteStride"] = json!(element);
            let accessor = asset.accessor(
                json!({"bufferView": view, "componentType": kind, "count": 2,
                "normalized": normalized, "type": KINDS[parts - 1]}),
            );
            asset.primitive()["attributes"][&name] = json!(accessor);
            let (found, report) = asset.load().unwrap();
            assert!(report.is_clean(), "{name} of {kind}: {report}");
            let shares: Vec<f32> = values.iter().map(|value| (value / most) as f32).collect();
            let ours: Vec<f32> = match parts {
                1 => found.opacities().to_vec(),
                4 => flat(found.rotations().iter().map(|q| {
                    // Half a turn about z leads to our axes.
                    (Quat::from_xyzw(0.0, 0.0, -1.0, 0.0) * *q).to_array()
                })),
                _ if name == "POSITION" => flat(
                    found
                        .positions()
                        .iter()
                        .map(|at| (to_ours().as_mat3() * *at).to_array()),
                ),
                _ => flat(found.scales().iter().map(Vec3::to_array)),
            };
            let apart = ours.iter().zip(&shares).map(|(a, b)| (a - b).abs());
            assert!(
                apart.fold(0.0, f32::max) < 1e-6,
                "{name} of {kind}: {ours:?} {shares:?}"
            );
        }
    }
}

/// Views that meshoptimizer compressed, by either extension and every filter that attributes of Gaussians can have.
#[test]
fn views_are_compressed_by_meshoptimizer() {
    let scratch = &mut Workspace::default();
    let (plain, _) = Asset::new().load().unwrap();
    for (extension, version) in [
        ("EXT_meshopt_compression", 0),
        ("KHR_meshopt_compression", 1),
    ] {
        let encoding = VertexEncoding::new(version, 2).unwrap();
        let stored = stored();
        let rotations = flat(stored.rotations().iter().map(|q| q.to_array()));
        let scales = flat(stored.scales().iter().map(Vec3::to_array));
        let mut asset = Asset::new();
        asset.document["extensionsRequired"] = json!([extension, "KHR_mesh_quantization"]);
        let mut compress =
            |name: &str, bytes: &[u8], stride: usize, filter: Option<&str>, kind: u32| {
                let packed = encode_vertex_buffer(bytes, 2, stride, encoding, scratch).unwrap();
                let view = asset.view(&packed);
                // Its place in a buffer of nothing, which stands for what is not compressed.
                let own = asset.document["bufferViews"][view].clone();
                asset.document["bufferViews"][view] = json!({"buffer": 1, "byteLength": 2 * stride,
                "byteStride": stride, "extensions": {extension: {"buffer": 0, "mode": "ATTRIBUTES",
                "byteOffset": own["byteOffset"], "byteLength": own["byteLength"],
                "byteStride": stride, "count": 2}}});
                if let Some(filter) = filter {
                    asset.document["bufferViews"][view]["extensions"][extension]["filter"] =
                        json!(filter);
                }
                let parts = stride / if kind == 5122 { 2 } else { 4 };
                let accessor = asset.accessor(
                    json!({"bufferView": view, "componentType": kind, "count": 2,
                "normalized": true, "type": KINDS[parts - 1]}),
                );
                asset.primitive()["attributes"][name] = json!(accessor);
            };
        let positions = flat(stored.positions().iter().map(Vec3::to_array));
        let bytes = positions
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect::<Vec<_>>();
        compress("POSITION", &bytes, 12, None, 5126);
        let scratch = &mut Workspace::default();
        let bytes = encode_filter_quat(2, 8, 16, &rotations, scratch).unwrap();
        compress(
            &format!("{OWN}:ROTATION"),
            &bytes,
            8,
            Some("QUATERNION"),
            5122,
        );
        let bytes = encode_filter_exp(2, 12, 24, &scales, ExpMode::Separate, scratch).unwrap();
        compress(
            &format!("{OWN}:SCALE"),
            &bytes,
            12,
            Some("EXPONENTIAL"),
            5126,
        );
        let (found, report) = asset.load().unwrap();
        assert!(report.is_clean(), "{report}");
        assert_eq!(found.positions(), plain.positions());
        for at in 0..2 {
            assert!(found.rotations()[at].dot(plain.rotations()[at]).abs() > 1.0 - 1e-6);
            assert!(found.scales()[at].distance(plain.scales()[at]) < 1e-6);
        }
        let views = asset.document["bufferViews"].as_array().unwrap().len();
        for (key, value, says) in [
            (
                "filter",
                json!("CURLY"),
                "with the filter CURLY, which is not read",
            ),
            (
                "mode",
                json!("CURLY"),
                "with the mode CURLY, which is not read",
            ),
            ("count", json!(1_u64 << 40), "as it says"),
            ("byteOffset", json!(1), "as it says"),
            (
                "byteStride",
                json!(null),
                "has no count, byteStride or mode",
            ),
        ] {
            let mut asset = Asset {
                document: asset.document.clone(),
                bytes: asset.bytes.clone(),
            };
            asset.document["bufferViews"][views - 1]["extensions"][extension][key] = value;
            let error = asset.load().unwrap_err().to_string();
            assert!(error.contains(says) && error.contains(extension), "{error}");
        }
    }
}

/// What an asset has beside Gaussians that are drawn is said.
#[test]
fn what_is_left_out_is_said() {
    let mut asset = Asset::new();
    asset.document["skins"] = json!([{"joints": [0]}]);
    let primitive = asset.primitive();
    primitive["attributes"]["_LABEL"] = json!(0);
    primitive["attributes"][format!("{OWN}:SH_DEGREE_4_COEF_0")] = json!(0);
    primitive["attributes"]["COLOR_0"] = json!(0);
    primitive["targets"] = json!([]);
    let (_, report) = asset.load().unwrap();
    let report = report.to_string();
    for says in [
        "left out 1 skin of the glTF",
        "that drawing does not use: KHR_gaussian_splatting:SH_DEGREE_4_COEF_0, _LABEL, morph targets",
    ] {
        assert!(report.contains(says), "{report}");
    }
}

/// Words that only other extensions know: the asset is drawn as the specification has it, and that is said.
#[test]
fn unknown_words_are_said_and_drawn_as_usual() {
    let (plain, _) = Asset::new().load().unwrap();
    for (key, says) in [
        ("kernel", "the kernel \"curly\" is drawn as an ellipse"),
        (
            "projection",
            "the projection \"curly\" is drawn as perspective",
        ),
        ("sortingMethod", "the order \"curly\" is drawn by distance"),
        (
            "colorSpace",
            "colours of the space \"curly\" are drawn as sRGB",
        ),
    ] {
        let mut asset = Asset::new();
        asset.primitive()["extensions"][OWN][key] = json!("curly");
        let (found, report) = asset.load().unwrap();
        assert!(report.to_string().contains(says), "{report}");
        assert_eq!(found, plain);
        // Where it requires what makes the word mean something, it cannot be drawn.
        asset.document["extensionsRequired"] = json!(["EXT_gaussian_splatting_curly"]);
        let error = asset.load().unwrap_err().to_string();
        assert!(error.contains("EXT_gaussian_splatting_curly"), "{error}");
    }
}

#[test]
fn an_asset_says_how_it_is_drawn() {
    let mut asset = Asset::new();
    let usual = Training::default().sort_by(SortBy::Distance).alpha_max(1.0);
    assert_eq!(asset.load().unwrap().0.training(), usual);
    asset.primitive()["extensions"][OWN]["colorSpace"] = json!("lin_rec709_display");
    assert_eq!(asset.load().unwrap().0.training(), usual.linear(true));
    // What is lacking is said by its name.
    for name in [
        "POSITION".to_owned(),
        format!("{OWN}:ROTATION"),
        format!("{OWN}:SCALE"),
        format!("{OWN}:OPACITY"),
        format!("{OWN}:SH_DEGREE_0_COEF_0"),
        format!("{OWN}:SH_DEGREE_1_COEF_2"),
    ] {
        let mut asset = Asset::new();
        asset.primitive()["attributes"]
            .as_object_mut()
            .unwrap()
            .remove(&name);
        let error = asset.load().unwrap_err().to_string();
        assert!(error.contains(&name), "{error}");
    }
}

/// Names and extras are on the nodes, meshes and primitives of the same Gaussians when the scene is written again.
#[test]
fn names_and_extras_are_written_again() {
    let mut asset = Asset::new();
    let primitive = asset.primitive().clone();
    let with = |extras: Value| {
        let mut primitive = primitive.clone();
        primitive["extras"] = extras;
        primitive
    };
    asset.document["asset"]["copyright"] = json!("A. Sculptor");
    asset.document["asset"]["extras"] = json!({"scanner": 7.25});
    asset.document["scenes"] = json!([{"name": "hall", "nodes": [2, 0, 3]}]);
    asset.document["nodes"] = json!([
        {"name": "left", "mesh": 0, "scale": [2, 2, 2], "extras": {"id": [1, 2, {"deep": null}]}},
        {"name": "right", "mesh": 0, "translation": [1, 0, 0]},
        {"name": "rig", "children": [1, 4], "extras": "no object", "rotation": [0, 1, 0, 0]},
        {"name": "a lamp without Gaussians"},
        {"mesh": 1, "translation": [0, 5, 0]},
    ]);
    asset.document["meshes"] = json!([
        {"name": "statue", "extras": {"tint": true},
         "primitives": [with(json!({"part": "head"})), with(json!({"rara": {"lowPass": "0.1"}}))]},
        {"primitives": [primitive.clone(), primitive]},
    ]);
    let file = asset.file().unwrap();
    let annotations = file.annotations.unwrap();
    assert_eq!(annotations.count(), 12);
    let folder = Folder::new("formats-annotations");
    let path = folder.join("again.glb");
    let written = |gaussians: &Gaussians, annotations: &Annotations| {
        let options = SaveOptions::default().annotations(Some(annotations.clone()));
        save_with(&path, gaussians, &options)?;
        rara::Result::Ok((load(&path, &mut |_, _| ())?, json_of_glb(&path)))
    };
    let (again, document) = written(&file.gaussians, &annotations).unwrap();
    assert_eq!(again.annotations.as_ref(), Some(&annotations));
    assert_eq!(again.gaussians.positions(), file.gaussians.positions());
    let asset_found = &document["asset"];
    assert_eq!(asset_found["copyright"], "A. Sculptor");
    assert_eq!(asset_found["extras"], json!({"scanner": 7.25}));
    let scene = &document["scenes"][0];
    assert_eq!(
        (&scene["name"], &scene["nodes"]),
        (&json!("hall"), &json!([0, 3]))
    );
    let nodes = document["nodes"].as_array().unwrap();
    let named = |at: usize| [&nodes[at]["name"], &nodes[at]["mesh"]];
    assert_eq!(nodes.len(), 4, "{document}");
    assert_eq!(nodes[0]["children"], json!([1, 2]));
    assert_eq!(nodes[0]["extras"], "no object");
    assert_eq!(named(1), [&json!("right"), &json!(0)]);
    assert_eq!(named(2), [&Value::Null, &json!(1)]);
    assert_eq!(named(3), [&json!("left"), &json!(2)]);
    assert_eq!(nodes[3]["extras"], json!({"id": [1, 2, {"deep": null}]}));
    for mesh in [0, 2] {
        let mesh = &document["meshes"][mesh];
        assert_eq!(
            (&mesh["name"], &mesh["extras"]),
            (&json!("statue"), &json!({"tint": true}))
        );
        // All are drawn as the first is, which is how rara drew them.
        let marked = json!({"part": "head"});
        assert_eq!(mesh["primitives"][0]["extras"], marked);
        assert_eq!(mesh["primitives"][1].get("extras"), None);
    }
    // What is alike is one primitive.
    let plain = &document["meshes"][1]["primitives"];
    assert_eq!(plain.as_array().unwrap().len(), 1);

    // A node whose Gaussians are dropped keeps its name, and the others keep theirs.
    let kept: Vec<u32> = vec![4, 5, 8, 11];
    let part_of: Vec<u32> = (0..12).map(|at| u32::from(!kept.contains(&at))).collect();
    let part = file
        .gaussians
        .clone()
        .into_parts(&part_of, 2)
        .unwrap()
        .swap_remove(0);
    let mut fewer = annotations.clone();
    fewer.keep(&part.numbers);
    let (again, document) = written(&part.gaussians, &fewer).unwrap();
    assert_eq!(again.gaussians.positions(), part.gaussians.positions());
    assert_eq!(document["nodes"][1], json!({"name": "right"}));
    let counts = |at: usize| {
        let position = &document["meshes"][0]["primitives"][at]["attributes"]["POSITION"];
        document["accessors"][position.as_u64().unwrap() as usize]["count"].clone()
    };
    assert_eq!(document["meshes"].as_array().unwrap().len(), 2);
    assert_eq!(
        (
            counts(0),
            document["meshes"][1]["primitives"]
                .as_array()
                .unwrap()
                .len()
        ),
        (json!(2), 2)
    );
    let error = written(&part.gaussians, &annotations)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("of 12 Gaussians, and there are 4"),
        "{error}"
    );

    // Two files become one.
    let mut both = annotations.clone();
    both.append(annotations.clone());
    let mut twice = file.gaussians.clone();
    twice.append(&file.gaussians);
    let (_, document) = written(&twice, &both).unwrap();
    assert_eq!(document["asset"]["copyright"], "A. Sculptor");
    assert_eq!(document["scenes"][0]["nodes"], json!([0, 3, 4, 7]));
    assert_eq!(document["nodes"][4]["children"], json!([5, 6]));
}

/// The JSON of a `.glb`.
fn json_of_glb(path: &Path) -> Value {
    let bytes = std::fs::read(path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}
