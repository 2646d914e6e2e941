//! `KHR_gaussian_splatting`, row by row: each test has an asset of its own that differs from the plain one in one thing.

use rara::Gaussians;
use rara::glam::{DAffine3, DMat3, DQuat, DVec3, Quat, Vec3};
use rara::scene::{LoadReport, load_from};
use serde_json::{Value, json};

use super::variants::base64;
use std::io::Cursor;
use std::path::Path;

/// The extension, with whose name its attributes begin.
const OWN: &str = "KHR_gaussian_splatting";

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
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][values.len() / 2 - 1];
        let accessor = self
            .accessor(json!({"bufferView": view, "componentType": 5126, "count": 2, "type": kind}));
        self.primitive()["attributes"][name] = json!(accessor);
    }

    fn load(&self) -> rara::Result<(Gaussians, LoadReport)> {
        let mut document = self.document.clone();
        document["buffers"] = json!([{
            "byteLength": self.bytes.len(),
            "uri": format!("data:application/octet-stream;base64,{}", base64(&self.bytes)),
        }]);
        let text = document.to_string();
        let found = load_from(Cursor::new(text), Path::new("a.gltf"), &mut |_, _| ())?;
        Ok((found.gaussians, found.report))
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
fn nodes_scale_unlike_in_different_directions() {
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

/// A turn below unlike scales is a shear. The harmonics follow the rotation that is nearest to it.
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
