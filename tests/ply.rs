//! Reading and writing `.ply` scenes: what must load, what must be refused with a sentence, and that nothing panics.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{Quat, Vec3};
use proptest::prelude::*;
use rara::scene::{Gaussians, Loaded, load, save_ply, sh_coefficients};

/// Writes `bytes` to a file of its own, loads it and removes it.
fn load_bytes(bytes: &[u8]) -> rara::Result<Loaded> {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let path = std::env::temp_dir().join(format!("rara-ply-{}-{number}.ply", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let loaded = load(&path, &mut |done, total| assert!(done <= total));
    std::fs::remove_file(&path).unwrap();
    loaded
}

/// The message of a refused file, which must be a format error.
fn refusal(bytes: &[u8]) -> String {
    match load_bytes(bytes) {
        Err(rara::Error::Format { message, .. }) => message,
        other => panic!("not refused: {other:?}"),
    }
}

const FIXED: &[&str] = &[
    "x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
    "rot_0", "rot_1", "rot_2", "rot_3",
];

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Ascii,
    Little,
    Big,
}

const FORMATS: [Format; 3] = [Format::Ascii, Format::Little, Format::Big];

/// A file under construction: declarations and numbers side by side, in any of the encodings.
struct File {
    format: Format,
    header: String,
    payload: Vec<u8>,
}

impl File {
    fn new(format: Format) -> Self {
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

    fn element(&mut self, name: &str, count: usize, properties: &[(&str, &str)]) {
        writeln!(self.header, "element {name} {count}").unwrap();
        for (kind, name) in properties {
            writeln!(self.header, "property {kind} {name}").unwrap();
        }
    }

    fn number(&mut self, kind: &str, value: f64) {
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

    fn end_element(&mut self) {
        if self.format == Format::Ascii {
            self.payload.push(b'\n');
        }
    }

    fn bytes(&self) -> Vec<u8> {
        [self.header.as_bytes(), b"end_header\n", &self.payload].concat()
    }
}

use std::io::Write as _;

/// Value of a property of Gaussian `i` in the made files; integers where `whole`.
fn value(name: &str, i: usize, whole: bool) -> f64 {
    let name_number: usize = name.bytes().map(usize::from).sum();
    let value = ((i * 31 + name_number * 17) % 23) as f64 - 7.0;
    if whole { value.abs() } else { value / 4.0 }
}

/// A scene whose properties have the given order and types.
fn scene_file(format: Format, count: usize, properties: &[(&str, &str)]) -> File {
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

fn floats<'a>(names: &[&'a str]) -> Vec<(&'static str, &'a str)> {
    names.iter().map(|name| ("float", *name)).collect()
}

fn check_scene(scene: &Gaussians, count: usize) {
    assert_eq!(scene.len(), count);
    for i in 0..count {
        let v = |name: &str| value(name, i, false);
        assert_eq!(
            scene.positions[i],
            Vec3::new(v("x") as f32, v("y") as f32, v("z") as f32)
        );
        assert_eq!(scene.scales[i].y, v("scale_1").exp() as f32);
        assert_eq!(
            scene.opacities[i],
            (1.0 / (1.0 + (-v("opacity")).exp())) as f32
        );
        let q = Quat::from_xyzw(
            v("rot_1") as f32,
            v("rot_2") as f32,
            v("rot_3") as f32,
            v("rot_0") as f32,
        );
        assert!(scene.rotations[i].abs_diff_eq(q.normalize(), 1e-6));
        let rest = scene.sh_coefficients() - 1;
        let sh = scene.sh_of(i);
        for channel in 0..3 {
            assert_eq!(sh[channel], v(&format!("f_dc_{channel}")) as f32);
            for coefficient in 0..rest {
                let name = format!("f_rest_{}", channel * rest + coefficient);
                assert_eq!(sh[3 * (coefficient + 1) + channel], v(&name) as f32);
            }
        }
    }
}

#[test]
fn every_degree_order_and_encoding() {
    for format in FORMATS {
        for degree in 0..4 {
            let rest: Vec<_> = (0..3 * (sh_coefficients(degree) - 1))
                .map(|i| format!("f_rest_{i}"))
                .collect();
            let mut names: Vec<&str> = FIXED.to_vec();
            names.extend(rest.iter().map(String::as_str));
            names.extend(["nx", "confidence"]);
            for turn in [0, 5, 13] {
                names.rotate_left(turn);
                names.reverse();
                let loaded = load_bytes(&scene_file(format, 7, &floats(&names)).bytes()).unwrap();
                assert!(loaded.report.is_clean(), "{}", loaded.report);
                assert_eq!(loaded.gaussians.sh_degree, degree);
                check_scene(&loaded.gaussians, 7);
            }
        }
    }
}

#[test]
fn doubles_and_lists_and_other_types() {
    for format in FORMATS {
        let mut properties = vec![
            ("list uchar int", "seen_by"),
            ("uchar", "red"),
            ("int16", "label"),
        ];
        properties.extend(FIXED.iter().map(|name| ("double", *name)));
        properties.push(("list uint float64", "history"));
        check_scene(
            &load_bytes(&scene_file(format, 9, &properties).bytes())
                .unwrap()
                .gaussians,
            9,
        );
        properties.retain(|(kind, _)| !kind.starts_with("list"));
        check_scene(
            &load_bytes(&scene_file(format, 9, &properties).bytes())
                .unwrap()
                .gaussians,
            9,
        );
        // Positions as integers of each type.
        for kind in ["char", "uint8", "short", "ushort", "int32", "uint"] {
            let whole: Vec<_> = FIXED
                .iter()
                .map(|n| (if *n == "x" { kind } else { "float" }, *n))
                .collect();
            let loaded = load_bytes(&scene_file(format, 3, &whole).bytes()).unwrap();
            assert_eq!(loaded.gaussians.positions[2].x, value("x", 2, true) as f32);
        }
    }
}

#[test]
fn other_elements_before_and_after() {
    for format in FORMATS {
        let mut file = File::new(format);
        file.element("camera", 2, &[("float", "x"), ("uchar", "y")]);
        file.element(
            "face",
            3,
            &[("list uchar int", "vertex_indices"), ("short", "label")],
        );
        file.element("vertex", 4, &floats(FIXED));
        file.element("edge", 1, &[("int", "a")]);
        for i in 0..2 {
            file.number("float", f64::from(i));
            file.number("uchar", 3.0);
            file.end_element();
        }
        for i in 0..3 {
            file.number("uchar", f64::from(i));
            (0..i).for_each(|_| file.number("int", 1.0));
            file.number("short", -1.0);
            file.end_element();
        }
        let vertices = scene_file(format, 4, &floats(FIXED));
        file.payload.extend(vertices.payload);
        file.number("int", 1.0);
        file.end_element();
        let loaded = load_bytes(&file.bytes()).unwrap();
        check_scene(&loaded.gaussians, 4);
        assert!(loaded.report.is_clean(), "{}", loaded.report);
    }
}

#[test]
fn line_ends_and_missing_last_one() {
    let file = scene_file(Format::Ascii, 3, &floats(FIXED)).bytes();
    let text = String::from_utf8(file).unwrap();
    for text in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace('\n', "\n\n").replacen("\n\n", "\n", 18),
        text.trim_end().into(),
    ] {
        check_scene(&load_bytes(text.as_bytes()).unwrap().gaussians, 3);
    }
    let binary = scene_file(Format::Little, 3, &floats(FIXED));
    let bytes = [
        binary.header.replace('\n', "\r\n").as_bytes(),
        b"end_header\r\n",
        &binary.payload,
    ]
    .concat();
    check_scene(&load_bytes(&bytes).unwrap().gaussians, 3);
}

#[test]
fn trailing_bytes_are_reported() {
    for format in FORMATS {
        let mut file = scene_file(format, 2, &floats(FIXED));
        file.payload.extend(b"tail");
        let loaded = load_bytes(&file.bytes()).unwrap();
        assert_eq!(loaded.report.trailing_bytes, 4);
        assert!(loaded.report.to_string().contains("4 byte"));
    }
}

#[test]
fn bad_elements_are_dropped_and_counted() {
    let mut file = File::new(Format::Ascii);
    file.element("vertex", 4, &floats(FIXED));
    file.payload.extend(b"nan 0 0 0 0 0 0 0 0 0 1 0 0 0\n0 0 0 0 0 0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0 1e3 0 1 0 0 0\n");
    file.payload.extend(b"0 0 0 0 0 0 1e39 0 0 0 1 0 0 0\n");
    let loaded = load_bytes(&file.bytes()).unwrap();
    let report = &loaded.report;
    assert_eq!(
        (loaded.gaussians.len(), report.dropped, report.repaired),
        (1, 3, 1)
    );
    assert_eq!(
        report
            .first_dropped
            .iter()
            .map(|r| r.element)
            .collect::<Vec<_>>(),
        [0, 2, 3]
    );
    assert_eq!(report.lines().len(), 2);
}

#[test]
fn an_empty_scene_is_a_scene() {
    for format in FORMATS {
        assert!(
            load_bytes(&scene_file(format, 0, &floats(FIXED)).bytes())
                .unwrap()
                .gaussians
                .is_empty()
        );
    }
}

#[test]
fn headers_that_are_refused() {
    let with = |line: &str| {
        let mut file = scene_file(Format::Ascii, 1, &floats(FIXED));
        file.header += line;
        file.bytes()
    };
    let without = |name: &str| {
        let names: Vec<_> = FIXED.iter().copied().filter(|n| *n != name).collect();
        scene_file(Format::Ascii, 1, &floats(&names)).bytes()
    };
    let rest = |numbers: &[&str]| {
        with(
            &numbers
                .iter()
                .map(|n| format!("property float f_rest_{n}\n"))
                .collect::<String>(),
        )
    };
    let compressed = b"ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 1\n\
        property uint packed_position\nend_header\n";
    let mesh = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
        element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n";
    for (bytes, words) in [
        (b"".to_vec(), "empty"),
        (b"plywood\n".to_vec(), "not a PLY"),
        (b"\x1f\x8b\x08".to_vec(), "gzip"),
        (b"ply\nformat ascii 1.0\n".to_vec(), "cut off"),
        (b"ply\nend_header\n".to_vec(), "format"),
        (
            b"ply\nformat ascii 1.0\nend_header\n".to_vec(),
            "no `vertex`",
        ),
        (
            b"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n".to_vec(),
            "line 3",
        ),
        (
            b"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n".to_vec(),
            "line 3",
        ),
        (
            b"ply\nformat ascii 1.0\nelement a 1000000000\nend_header\n".to_vec(),
            "without any property",
        ),
        (compressed.to_vec(), "compressed PLY"),
        (mesh.to_vec(), "mesh"),
        (without("opacity"), "lacks opacity"),
        (without("rot_3"), "lacks rot_3"),
        (
            with("property float x\n"),
            "line 19 of the header declares the property `x` a second time",
        ),
        (with("element vertex 1\n"), "a second time"),
        (with("property list float int a\n"), "not an integer"),
        (with("bogus\n"), "line 19"),
        (rest(&["0", "1"]), "2 f_rest"),
        (rest(&["0", "2", "3"]), "no f_rest_1"),
        (rest(&["0", "1x", "2"]), "f_rest_1x"),
        (rest(&["0", "01", "2"]), "f_rest_01"),
        (rest(&["0", "18446744073709551616"]), "not a valid"),
    ] {
        let message = refusal(&bytes);
        assert!(message.contains(words), "{message:?} lacks {words:?}");
        assert!(
            !message.contains('\n') && message.contains([';', ',']),
            "{message:?}"
        );
    }
    let mut file = File::new(Format::Ascii);
    let properties: Vec<_> = FIXED
        .iter()
        .map(|n| {
            (
                if *n == "opacity" {
                    "list uchar float"
                } else {
                    "float"
                },
                *n,
            )
        })
        .collect();
    file.element("vertex", 1, &properties);
    file.payload.extend([b'1', b' '].repeat(40));
    assert!(refusal(&file.bytes()).contains("`opacity` is a list"));
}

#[test]
fn counts_beyond_the_file_are_refused_before_anything_is_allocated() {
    for format in FORMATS {
        for count in [3, 1_000_000_000, u32::MAX as usize, u64::MAX as usize] {
            for before in [false, true] {
                let mut file = File::new(format);
                if before {
                    file.element("face", count, &[("list uint double", "a")]);
                }
                file.element("vertex", if before { 2 } else { count }, &floats(FIXED));
                file.payload = scene_file(format, 2, &floats(FIXED)).payload;
                file.payload.truncate(file.payload.len() - 1);
                refusal(&file.bytes());
            }
        }
    }
    // A list whose length leads out of the file.
    for kind in ["uint", "int"] {
        let mut file = File::new(Format::Little);
        let mut properties = floats(FIXED);
        properties.push((
            if kind == "int" {
                "list int double"
            } else {
                "list uint double"
            },
            "a",
        ));
        file.element("vertex", 1, &properties);
        FIXED.iter().for_each(|_| file.number("float", 1.0));
        file.number(kind, if kind == "int" { -1.0 } else { 4e9 });
        refusal(&file.bytes());
    }
}

#[test]
fn ascii_errors_name_the_line() {
    let cases = [
        ("0 0 0", "too few"),
        ("x", "\"x\" is not a number"),
        (&"0 ".repeat(15), "more numbers"),
        ("", "cut off"),
    ];
    for (line, words) in cases {
        let mut file = scene_file(Format::Ascii, 1, &floats(FIXED));
        file.header = file.header.replace("vertex 1", "vertex 2");
        file.payload.extend(line.as_bytes());
        file.payload.extend([b' '; 60]);
        let message = refusal(&file.bytes());
        assert!(
            message.starts_with("line 2") && message.contains(words),
            "{message}"
        );
    }
}

#[test]
fn folders_and_missing_files_are_errors() {
    assert!(load(&std::env::temp_dir(), &mut |_, _| ()).is_err());
    assert!(
        load(Path::new("no/such/file.ply"), &mut |_, _| ())
            .unwrap_err()
            .to_string()
            .contains("no/such")
    );
}

#[test]
fn saving_and_loading_gives_the_scene_back() {
    for degree in 0..4 {
        let file = scene_file(Format::Little, 50, &floats(FIXED));
        let mut scene = load_bytes(&file.bytes()).unwrap().gaussians;
        scene.set_sh_degree(degree);
        scene
            .sh
            .iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v = i as f32 * 0.01);
        scene.scales[3].x = 0.0;
        scene.opacities[4] = 1.0;
        scene.opacities[5] = 0.0;
        let path =
            std::env::temp_dir().join(format!("rara-ply-save-{}-{degree}.ply", std::process::id()));
        save_ply(&path, &scene).unwrap();
        let loaded = load(&path, &mut |_, _| ()).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(loaded.report.is_clean());
        let back = loaded.gaussians;
        assert_eq!(
            (&back.positions, &back.sh, back.sh_degree),
            (&scene.positions, &scene.sh, degree)
        );
        for i in 0..50 {
            assert!(
                back.scales[i].abs_diff_eq(scene.scales[i], 1e-6 * scene.scales[i].max_element())
            );
            assert!(back.rotations[i].abs_diff_eq(scene.rotations[i], 1e-6));
            assert!((back.opacities[i] - scene.opacities[i]).abs() < 1e-6);
        }
        assert_eq!(
            (back.scales[3].x, back.opacities[4], back.opacities[5]),
            (0.0, 1.0, 0.0)
        );
    }
}

/// What the renderer relies on, whatever the file held.
fn assert_sound(scene: &Gaussians) {
    let n = scene.len();
    assert_eq!(
        (
            scene.scales.len(),
            scene.rotations.len(),
            scene.opacities.len()
        ),
        (n, n, n)
    );
    assert_eq!(scene.sh.len(), 3 * n * scene.sh_coefficients());
    assert!(scene.positions.iter().all(|p| p.is_finite()));
    assert!(
        scene
            .scales
            .iter()
            .all(|s| s.is_finite() && s.min_element() >= 0.0)
    );
    assert!(
        scene
            .rotations
            .iter()
            .all(|q| (q.length() - 1.0).abs() < 1e-5)
    );
    assert!(scene.opacities.iter().all(|o| (0.0..=1.0).contains(o)));
    assert!(scene.sh.iter().all(|v| v.is_finite()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), ply in any::<bool>()) {
        let start: &[u8] = if ply { b"ply\nformat ascii 1.0\nelement vertex 1\n" } else { b"" };
        if let Ok(loaded) = load_bytes(&[start, &bytes].concat()) {
            assert_sound(&loaded.gaussians);
        }
    }

    #[test]
    fn mutations_never_panic(
        format in 0..3_usize,
        list in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..8),
    ) {
        let mut properties = floats(FIXED);
        if list {
            properties.insert(3, ("list uint double", "a"));
        }
        let mut bytes = scene_file(FORMATS[format], 5, &properties).bytes();
        for (at, byte, how) in edits {
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        if let Ok(loaded) = load_bytes(&bytes) {
            assert_sound(&loaded.gaussians);
        }
    }

    /// Beyond the last number at least: digits that are missing from it nobody can notice.
    #[test]
    fn truncation_is_always_noticed(format in 0..3_usize, cut in 9..440_usize) {
        let bytes = scene_file(FORMATS[format], 8, &floats(FIXED)).bytes();
        refusal(&bytes[..bytes.len() - cut]);
    }
}

/// The collected files of other projects, where this machine has them.
fn shared(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("RARA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let folder = root.join("data").join(folder);
    if !folder.is_dir() {
        eprintln!(
            "SKIPPED: {} is not there (set RARA_SHARED)",
            folder.display()
        );
        return None;
    }
    Some(folder)
}

fn ply_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            ply_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "ply") {
            found.push(path);
        }
    }
}

#[test]
fn collected_malformed_files() {
    let Some(folder) = shared("malformed") else {
        return;
    };
    let mut files = Vec::new();
    ply_files(&folder, &mut files);
    assert!(!files.is_empty());
    for path in files {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let result = load(&path, &mut |_, _| ());
        match &result {
            Ok(loaded) => eprintln!(
                "{name}: {} Gaussians, {}",
                loaded.gaussians.len(),
                loaded.report
            ),
            Err(error) => eprintln!("{error}"),
        }
        if let Ok(loaded) = &result {
            assert_sound(&loaded.gaussians);
        }
        let bad_header = [
            "degree-4-sh",
            "duplicate-sh-index",
            "invalid-sh-name",
            "list-property",
            "mesh-not-gaussian",
            "missing-opacity",
            "non-contiguous-sh",
            "sh-count-not-rgb",
            "sh-invalid-degree",
            "truncated-binary-le",
        ];
        let bad_element = [
            "nan-opacity-binary-le",
            "out-of-range-double",
            "overflow-scale",
        ];
        let foreign = path.iter().any(|part| part == "ply-rs");
        if bad_header.contains(&name.as_str()) || foreign {
            assert!(matches!(result, Err(rara::Error::Format { .. })), "{name}");
        } else if bad_element.contains(&name.as_str()) {
            assert!(result.unwrap().report.dropped > 0, "{name}");
        } else {
            assert!(result.unwrap().report.is_clean(), "{name}");
        }
    }
}

#[test]
fn collected_formats_and_scenes() {
    for folder in ["formats", "general", "medical"] {
        let Some(folder) = shared(folder) else { return };
        let mut files = Vec::new();
        ply_files(&folder, &mut files);
        for path in files {
            let result = load(&path, &mut |_, _| ());
            if path.to_string_lossy().contains(".compressed.") {
                assert!(result.unwrap_err().to_string().contains("compressed PLY"));
            } else {
                let loaded = result.unwrap();
                eprintln!(
                    "{}: {} Gaussians, {}",
                    path.display(),
                    loaded.gaussians.len(),
                    loaded.report
                );
                assert!(!loaded.gaussians.is_empty());
                assert_sound(&loaded.gaussians);
            }
        }
    }
}
