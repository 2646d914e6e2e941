//! Files of other projects, whole ones and such with one defect.

use rara::scene::{Format, load};

use super::distance::Distance;
use crate::files::shared::{files, shared};

use crate::files::ply::made::assert_sound;

#[test]
fn other_projects_files_read() {
    for folder in ["formats", "general", "medical"] {
        let Some(folder) = shared(folder) else { return };
        for path in files(&folder) {
            let ending = path
                .extension()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let is_scene =
                ["ply", "splat", "ksplat", "spz", "sog", "glb", "gltf"].contains(&&*ending);
            // Its scales are logarithms, which no other .splat has: its Gaussians would be negative.
            if !is_scene || path.ends_with("gaussian-splat-tools/TestData/test.splat") {
                continue;
            }
            let loaded = load(&path, &mut |_, _| ()).unwrap();
            assert!(
                !loaded.gaussians.is_empty() && loaded.report.dropped == 0,
                "{}",
                path.display()
            );
            assert_sound(&loaded.gaussians);
        }
    }
}

/// The defects that are no more than a remark, or none.
const READ: [&str; 26] = [
    "decode-degree1",
    "decode-degree1-v2",
    "decode-degree3-v2",
    "decode-degree4-v2",
    "decode-nonfinite-v1",
    "decode-v1",
    "decode-v3",
    "degree3-v2",
    "empty-count",
    "empty-points-v2",
    "equiv-degree1-offgrid",
    "equiv-degree1-offgrid-v2",
    "equiv-degree3-exact",
    "equiv-degree3-exact-v2",
    "equiv-degree3-exact-v3",
    "extensions-v2",
    "header-fields-v2",
    "kit-multi-degree3",
    "kit-multi-degree3-deflated",
    "kit-one-degree0",
    "minimal-v1",
    "minimal-v2",
    "minimal-v3",
    "plaintext-v2",
    "three-points-degree1-v2",
    "version-1",
];

/// Those of which something is left over, which is said.
const TRAILING: [&str; 2] = ["trailing-after-member-v2", "trailing-decompressed-v2"];

#[test]
fn single_defects_are_errors_that_name_the_file() {
    let Some(folder) = shared("malformed") else {
        return;
    };
    let mut seen = 0;
    for path in files(&folder) {
        let ending = path.extension().unwrap_or_default();
        if ending != "spz" && ending != "sog" {
            continue;
        }
        seen += 1;
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let result = load(&path, &mut |_, _| ());
        match &result {
            Ok(loaded) => assert_sound(&loaded.gaussians),
            Err(error) => {
                let text = error.to_string();
                assert!(text.starts_with(&*path.to_string_lossy()), "{text}");
                assert!(
                    !text.chars().any(char::is_control) && text.len() < 700,
                    "{text}"
                );
            }
        }
        let is_read = READ.contains(&&*name);
        let is_trailing = TRAILING.contains(&&*name);
        assert_eq!(result.is_ok(), is_read || is_trailing, "{name}: {result:?}");
        if let Ok(loaded) = result {
            assert_eq!(
                loaded.report.trailing_bytes > 0,
                is_trailing,
                "{name}: {}",
                loaded.report
            );
            let has_remark =
                ["decode-degree4-v2", "decode-nonfinite-v1"].contains(&&*name) || is_trailing;
            assert_eq!(
                !loaded.report.is_clean(),
                has_remark,
                "{name}: {}",
                loaded.report
            );
        }
    }
    assert_eq!(seen, 65, "a fixture is new or gone");
}

/// Two scenes that another project wrote in three formats, one of them with numbers that all of them hold exactly.
#[test]
fn equal_scenes_are_equal_in_all_formats() {
    let Some(folder) = shared("malformed/usd-3dgs-plugins/tests/equivalence/fixtures") else {
        return;
    };
    let read = |name: &str| load(&folder.join(name), &mut |_, _| ()).unwrap();
    for (truth, others) in [
        ("equiv-degree3-exact", &["-v2.spz", "-v3.spz", ".sog"][..]),
        ("equiv-degree1-offgrid", &["-v2.spz", ".sog"]),
    ] {
        let expected = read(&format!("{truth}-binary-le.ply"));
        assert_eq!(expected.format, Format::Ply);
        for other in others {
            let loaded = read(&format!("{truth}{other}"));
            let distance = Distance::between(&expected.gaussians, &loaded.gaussians, 0.1, 1e-6);
            eprintln!("{truth}{other}: {distance:?}");
            let most = if truth.ends_with("exact") { 2e-3 } else { 0.04 };
            assert!(
                distance.position < 5e-4 && distance.opacity < 3e-3,
                "{other}: {distance:?}"
            );
            assert!(
                distance.scale < most && distance.colour < most,
                "{other}: {distance:?}"
            );
            assert!(
                distance.harmonics < most.max(1e-2) && distance.rotation < 0.02,
                "{other}: {distance:?}"
            );
        }
    }
}

/// The same streamed scene has to be found by its folder and by its list.
#[test]
fn the_finest_level_of_a_streamed_scene_is_read() {
    let Some(sog) = shared("formats/leica_8192/sog_unbundled") else {
        return;
    };
    let folder = crate::common::folder::Folder::new("formats-streamed");
    for level in ["0_0", "1_0"] {
        std::fs::create_dir(folder.join(level)).unwrap();
        for path in files(&sog) {
            std::fs::copy(&path, folder.join(level).join(path.file_name().unwrap())).unwrap();
        }
    }
    let piece = |file: u32, offset: u32, count: u32| {
        format!(r#"{{"file":{file},"offset":{offset},"count":{count}}}"#)
    };
    let write = |first: &str, second: &str| {
        let text = format!(
            r#"{{"version":1,"lodLevels":2,"filenames":["0_0/meta.json","1_0/meta.json"],"tree":{{"children":[
            {{"lods":{{"0":{first},"1":{}}}}},{{"lods":{{"1":{second}}}}}]}}}}"#,
            piece(1, 0, 10)
        );
        std::fs::write(folder.join("lod-meta.json"), text).unwrap();
    };
    write(&piece(0, 100, 50), &piece(1, 8000, 192));
    let whole = load(&sog, &mut |_, _| ()).unwrap().gaussians;
    let loaded = load(&folder, &mut |_, _| ()).unwrap();
    assert_eq!(
        (loaded.format, loaded.gaussians.len()),
        (Format::StreamedSog, 242)
    );
    assert_eq!(
        loaded.gaussians.positions()[..50],
        whole.positions()[100..150]
    );
    assert_eq!(
        loaded.gaussians.positions()[50..],
        whole.positions()[8000..]
    );
    // A null in a codebook drops Gaussians; the others keep their numbers.
    let path = folder.join("0_0/meta.json");
    let text = std::fs::read(&path).unwrap();
    let mut document: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let book = document["scales"]["codebook"].as_array_mut().unwrap();
    book[100..130].fill(serde_json::Value::Null);
    std::fs::write(&path, document.to_string()).unwrap();
    let loaded = load(&folder, &mut |_, _| ()).unwrap();
    let kept = loaded.gaussians.len() - 192;
    assert!(0 < kept && kept < 50 && loaded.report.dropped > 0, "{kept}");
    let mut asked = whole.positions()[100..150].iter();
    let own = &loaded.gaussians.positions()[..kept];
    assert!(own.iter().all(|own| asked.any(|other| other == own)));

    for (first, second) in [
        (piece(0, 0, 9000), piece(1, 0, 1)),
        (piece(0, 0, 1), piece(2, 0, 1)),
    ] {
        write(&first, &second);
        let error = load(&folder.join("lod-meta.json"), &mut |_, _| ())
            .unwrap_err()
            .to_string();
        assert!(error.contains("lod-meta.json"), "{error}");
    }
}
