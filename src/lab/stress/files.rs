//! Files with numbers that no trainer should write, read by the loader like a user's scene.

use std::path::Path;

use glam::DVec3;

use super::make::{PLAIN, any_normal};
use super::{Case, Regime};
use rara::scene::load;
use rara::{Clip, ClipOp, Gaussians, Plane};
use rara_scene::Random;

pub fn regimes() -> Vec<Regime> {
    vec![
        Regime::new(
            "file: logits of +-1000, quaternions of 1e-25 to 1e25",
            || vec![from_file(&extreme_rows())],
        ),
        Regime::new("file: NaN and infinities in every field", || {
            vec![from_file(&broken_rows())]
        }),
    ]
}

/// Numbers of one splat in the file's order.
const FIELDS: [&str; 14] = [
    "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
    "rot_0", "rot_1", "rot_2", "rot_3",
];
type FileRow = [f32; FIELDS.len()];

/// A sound splat about the origin.
fn row(random: &mut Random) -> FileRow {
    let mut within = |low, high| random.range(low, high) as f32;
    let mut row = [0.0; FIELDS.len()];
    row[..3].fill_with(|| within(-1.0, 1.0));
    row[3..6].fill_with(|| within(-1.5, 1.5));
    row[6] = within(-2.0, 4.0);
    row[7..10].fill_with(|| within(-5.0, -2.0));
    row[10..].fill_with(|| within(-1.0, 1.0));
    row
}

fn extreme_rows() -> Vec<FileRow> {
    let mut random = Random::new(50);
    let lengths = [1e-25, 1e-20, 1e-10, 1e10, 1e20, 1e25];
    let logits = [-1000.0, 1000.0, 0.0, -90.0, 90.0];
    let one = |index: usize| {
        let mut row = row(&mut random);
        row[6] = logits[index % logits.len()];
        for value in &mut row[10..] {
            *value *= lengths[index % lengths.len()];
        }
        row
    };
    (0..240).map(one).collect()
}

fn broken_rows() -> Vec<FileRow> {
    let mut random = Random::new(51);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.4e38, -3.4e38];
    let one = |index: usize| {
        let mut row = row(&mut random);
        // Every other splat is sound.
        if index.is_multiple_of(2) {
            row[index / 2 % FIELDS.len()] = bad[index / 2 / FIELDS.len() % bad.len()];
        }
        row
    };
    (0..4 * FIELDS.len() * bad.len()).map(one).collect()
}

/// Writes the rows, loads them back, and cuts what the loader kept.
fn from_file(rows: &[FileRow]) -> Case {
    let name = format!("rara-stress-{}-{}.ply", std::process::id(), rows.len());
    let path = std::env::temp_dir().join(name);
    let scene = written(&path, rows);
    // It does not matter whether the file could be removed.
    let _ = std::fs::remove_file(&path);
    let mut random = Random::new(52);
    let camera = PLAIN.camera(&mut random);
    let normal = any_normal(&mut random, &camera);
    let plane = Plane::new(normal, -normal.dot(DVec3::splat(0.1))).expect("a finite normal");
    Case {
        scene,
        camera,
        clip: Clip::of([plane], ClipOp::And),
        apart: false,
    }
}

fn written(path: &Path, rows: &[FileRow]) -> Gaussians {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n",
        rows.len()
    );
    for field in FIELDS {
        bytes += &format!("property float {field}\n");
    }
    bytes += "end_header\n";
    let mut bytes = bytes.into_bytes();
    bytes.extend(rows.iter().flatten().flat_map(|value| value.to_le_bytes()));
    std::fs::write(path, bytes).expect("the folder for temporary files is writable");
    load(path, &mut |_, _| {})
        .expect("a file whose numbers are bad is still a scene")
        .gaussians
}
