//! One model in many encodings, made by splat-transform, against the file that they were made of.

use std::path::{Path, PathBuf};

use rara::scene::{Format, load};

use super::distance::Distance;
use crate::files::shared::shared;

/// Scales below this are as good as zero: `.spz` holds none below e^-10.
const LEAST: f32 = 4.54e-5;

/// The model's extent and its largest centre, world units, and the largest range of its scales' logarithms.
const EXTENT: f32 = 32.0;
const FARTHEST: f32 = 24.5;
const LOGS: f32 = 20.0;

/// What the format's steps allow, half a step each; where a format clamps, what it clamps to counts. A step of three parts
/// of a quaternion turns by 3.5 steps at most: twice their length, and the fourth may change as much as all three.
fn bounds(name: &str) -> Distance {
    let byte = 0.5 / 255.0 + 1e-5;
    let exact = Distance {
        position: 1e-5,
        scale: 1e-5,
        rotation: 1e-3,
        opacity: 1e-6,
        colour: f32::INFINITY,
        shown: 1e-5,
        harmonics: 1e-6,
    };
    // Truncated to bytes, not rounded.
    let in_bytes = Distance {
        opacity: 2.0 * byte,
        shown: 2.0 * byte,
        ..exact
    };
    match name {
        // Ranges of 256 neighbours are at most the whole model's, in 1023 steps.
        "compressed.ply" => Distance {
            position: EXTENT / 1023.0 / 2.0,
            scale: LOGS / 1023.0 / 2.0 * 1.1,
            rotation: 4.0 * std::f32::consts::SQRT_2 / 1023.0,
            opacity: byte,
            shown: 8.0 * byte,
            harmonics: 8.0 / 256.0,
            ..exact
        },
        // Logarithms of centres in 65535 steps; rotations' bytes are truncated; codebooks have no bound but what they were
        // made for.
        "sog" => Distance {
            position: 5.7 / 65535.0 * (1.0 + FARTHEST),
            scale: 0.15,
            rotation: 7.0 * std::f32::consts::SQRT_2 / 255.0,
            opacity: 2.0 * byte,
            shown: 0.02,
            harmonics: 0.05,
            ..exact
        },
        // Eight bits of each part of the quaternion.
        "splat" => Distance {
            rotation: 4.0 / 128.0,
            ..in_bytes
        },
        "c0_sh0.ksplat" => in_bytes,
        // Buckets of 5 units in 65534 steps; scales and rotations are halves, truncated, whose steps are 6e-8 at the least,
        // and so are coefficients below 1.
        "c1_sh2.ksplat" | "c2_sh2.ksplat" => Distance {
            position: 5.0 / 65534.0,
            scale: 6e-8 / LEAST,
            rotation: 4e-3,
            // The file's range of bytes ends at 0.66, and its largest coefficients are up to 0.9.
            harmonics: if name.starts_with("c1") { 5e-4 } else { 0.236 },
            ..in_bytes
        },
        // 12 bits behind the point, sixteenths of a logarithm, nine bits of each part; harmonics of four or five bits.
        "v3.spz" | "v4.spz" => Distance {
            position: 0.5 / 4096.0 + 1e-6,
            scale: 0.5 / 16.0,
            rotation: 4.0 / 511.0,
            opacity: byte,
            shown: 0.5 / 255.0 / 0.15 * 0.2821 + 1e-5,
            harmonics: 16.5 / 128.0,
            ..exact
        },
        "glb" => exact,
        _ => panic!("{name} has no bounds"),
    }
}

fn paths(folder: &Path) -> [(PathBuf, &'static str, Format); 10] {
    let at = |name: &str| folder.join(format!("leica_8192{name}"));
    [
        (at(".glb"), "glb", Format::Gltf),
        (at(".splat"), "splat", Format::Splat),
        (at("_c0_sh0.ksplat"), "c0_sh0.ksplat", Format::Ksplat),
        (at("_c1_sh2.ksplat"), "c1_sh2.ksplat", Format::Ksplat),
        (at("_c2_sh2.ksplat"), "c2_sh2.ksplat", Format::Ksplat),
        (
            at(".compressed.ply"),
            "compressed.ply",
            Format::CompressedPly,
        ),
        (at(".sog"), "sog", Format::Sog),
        (folder.join("sog_unbundled"), "sog", Format::Sog),
        (at("_v3.spz"), "v3.spz", Format::Spz),
        (at("_v4.spz"), "v4.spz", Format::Spz),
    ]
}

#[test]
fn one_model_in_all_encodings() {
    let (Some(general), Some(folder)) = (shared("general"), shared("formats/leica_8192")) else {
        return;
    };
    let truth = load(&general.join("leica_8192_inria.ply"), &mut |_, _| ())
        .unwrap()
        .gaussians;
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide/formats.md");
    let guide = std::fs::read_to_string(guide).unwrap();
    let mut missing = Vec::new();
    for (path, name, format) in paths(&folder) {
        let loaded = load(&path, &mut |_, _| ()).unwrap();
        assert_eq!(loaded.format, format);
        assert!(loaded.report.is_clean(), "{}", loaded.report);
        let bounds = bounds(name);
        let near = 2.0 * bounds.position;
        let distance = Distance::between(&truth, &loaded.gaussians, near, LEAST);
        let row = format!(
            "| `{name}` | {} | {distance} |",
            loaded.gaussians.sh_degree()
        );
        for (what, found, bound) in [
            ("position", distance.position, bounds.position),
            ("scale", distance.scale, bounds.scale),
            ("rotation", distance.rotation, bounds.rotation),
            ("opacity", distance.opacity, bounds.opacity),
            ("colour", distance.colour, bounds.colour),
            ("shown colour", distance.shown, bounds.shown),
            ("harmonics", distance.harmonics, bounds.harmonics),
        ] {
            assert!(
                found <= bound,
                "{name}: {what} is off by {found}, over {bound}"
            );
        }
        if !guide.contains(&row) {
            missing.push(row);
        }
    }
    assert!(
        missing.is_empty(),
        "the guide's table does not have\n{}",
        missing.join("\n")
    );
}
