//! Made-up scene files: declarations and numbers side by side, in any of the encodings.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::atomic::{AtomicU32, Ordering};

use rara::scene::{Gaussians, SceneFile, load};

/// Writes `bytes` to a file of its own, loads it and removes it.
pub(crate) fn load_bytes(bytes: &[u8]) -> rara::Result<SceneFile> {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("rara-ply-{}-{number}.ply", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let loaded = load(&path, &mut |done, total| assert!(done <= total));
    std::fs::remove_file(&path).unwrap();
    loaded
}

/// The message of a refused file, which must be a format error.
pub(crate) fn refusal(bytes: &[u8]) -> String {
    match load_bytes(bytes) {
        Err(rara::Error::Format { message, .. }) => message,
        other => panic!("not refused: {other:?}"),
    }
}

pub(crate) const FIXED: &[&str] = &[
    "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
    "rot_0", "rot_1", "rot_2", "rot_3",
];

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Format {
    Ascii,
    Little,
    Big,
}

pub(crate) const FORMATS: [Format; 3] = [Format::Ascii, Format::Little, Format::Big];

/// A file under construction: declarations and numbers side by side, in any of the encodings.
pub(crate) struct File {
    pub(crate) format: Format,
    pub(crate) header: String,
    pub(crate) payload: Vec<u8>,
}

impl File {
    pub(crate) fn new(format: Format) -> Self {
        let name = match format {
            Format::Ascii => "ascii",
            Format::Little => "binary_little_endian",
            Format::Big => "binary_big_endian",
        };
        Self {
            format,
            header: format!("ply\nformat {name} 1.0\ncomment made by a test\n"),
            payload: Vec::new(),
        }
    }

    pub(crate) fn element(&mut self, name: &str, count: usize, properties: &[(&str, &str)]) {
        writeln!(self.header, "element {name} {count}").unwrap();
        for (kind, name) in properties {
            writeln!(self.header, "property {kind} {name}").unwrap();
        }
    }

    pub(crate) fn number(&mut self, kind: &str, value: f64) {
        if self.format == Format::Ascii {
            write!(self.payload, "{value} ").unwrap();
            return;
        }
        let mut bytes = match kind {
            "char" | "int8" => (value as i8).to_le_bytes().to_vec(),
            "uchar" | "uint8" => (value as u8).to_le_bytes().to_vec(),
            "short" | "int16" => (value as i16).to_le_bytes().to_vec(),
            "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
            "int" | "int32" => (value as i32).to_le_bytes().to_vec(),
            "uint" | "uint32" => (value as u32).to_le_bytes().to_vec(),
            "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
            "double" | "float64" => value.to_le_bytes().to_vec(),
            _ => panic!("{kind}"),
        };
        if self.format == Format::Big {
            bytes.reverse();
        }
        self.payload.extend(bytes);
    }

    pub(crate) fn end_element(&mut self) {
        if self.format == Format::Ascii {
            self.payload.push(b'\n');
        }
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        [self.header.as_bytes(), b"end_header\n", &self.payload].concat()
    }
}

/// Value of a property of Gaussian `i` in the made-up files; an integer if `whole`.
pub(crate) fn value(name: &str, i: usize, whole: bool) -> f64 {
    let name_number: usize = name.bytes().map(usize::from).sum();
    let value = ((i * 31 + name_number * 17) % 23) as f64 - 7.0;
    if whole { value.abs() } else { value / 4.0 }
}

/// A scene whose properties have the given order and types.
pub(crate) fn scene_file(format: Format, count: usize, properties: &[(&str, &str)]) -> File {
    let mut file = File::new(format);
    file.element("vertex", count, properties);
    for i in 0..count {
        for (kind, name) in properties {
            if let Some(list) = kind.strip_prefix("list ") {
                let (length, item) = list.split_once(' ').unwrap();
                file.number(length, (i % 3) as f64);
                (0..i % 3).for_each(|_| file.number(item, 9.0));
            } else {
                file.number(
                    kind,
                    value(name, i, !kind.starts_with("float") && *kind != "double"),
                );
            }
        }
        file.end_element();
    }
    file
}

pub(crate) fn floats<'a>(names: &[&'a str]) -> Vec<(&'static str, &'a str)> {
    names.iter().map(|name| ("float", *name)).collect()
}

/// Asserts what the renderer relies on, whatever the file held.
pub(crate) fn assert_sound(scene: &Gaussians) {
    let n = scene.len();
    assert_eq!(
        (
            scene.scales().len(),
            scene.rotations().len(),
            scene.opacities().len()
        ),
        (n, n, n)
    );
    assert_eq!(scene.sh().len(), 3 * n * scene.sh_coefficients());
    assert!(scene.positions().iter().all(|p| p.is_finite()));
    assert!(
        scene
            .scales()
            .iter()
            .all(|s| s.is_finite() && s.min_element() >= 0.0)
    );
    assert!(
        scene
            .rotations()
            .iter()
            .all(|q| (q.length() - 1.0).abs() < 1e-5)
    );
    assert!(scene.opacities().iter().all(|o| (0.0..=1.0).contains(o)));
    assert!(scene.sh().iter().all(|v| v.is_finite()));
}
