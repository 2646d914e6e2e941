//! Files of cameras that other programs write and that are not read: each is named, with what can be done.

use std::collections::BTreeMap;

use rara_base::rows;
use serde::de::IgnoredAny;

/// The members of a JSON document: of its object, or of the first one of its list.
pub(super) struct Members(BTreeMap<String, IgnoredAny>);

impl Members {
    pub(super) fn of(json: &[u8]) -> Self {
        let object = || serde_json::from_slice(json).ok();
        let list = || {
            serde_json::from_slice::<Vec<_>>(json)
                .ok()?
                .into_iter()
                .next()
        };
        Self(object().or_else(list).unwrap_or_default())
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }
}

enum Mark {
    /// A JSON document with all of these members.
    Members(&'static [&'static str]),
    /// A file that begins so.
    Begin(&'static [u8]),
}

use Mark::{Begin, Members as With};

const TO_COLMAP: &str = "export its cameras as a COLMAP model, and give that folder";
const TO_GLTF: &str = "export its cameras as glTF, and give the .glb";
const BY_NERFSTUDIO: &str = "ns-process-data of nerfstudio makes a transforms.json of it";
const AS_A_SCENE: &str = "give the file of its cameras";

/// What tells a kind, what it is, and what to do.
const KINDS: [(Mark, &str, &str); 30] = rows! {
    With(&["shots"]), "a reconstruction of OpenSfM", "opensfm export_colmap makes a COLMAP model of it";
    With(&["sfm_data_version"]), "a scene of OpenMVG", "openMVG_main_openMVG2Colmap makes a COLMAP model of it";
    With(&["views", "intrinsics"]), "a scene of Meshroom (AliceVision)", TO_COLMAP;
    With(&["t_00", "t_23"]), "a camera of Polycam", BY_NERFSTUDIO;
    With(&["K", "poses"]), "a recording of Record3D", BY_NERFSTUDIO;
    With(&["cameraPoseARFrame"]), "a frame of ARKit, as the 3D Scanner App writes it", BY_NERFSTUDIO;
    With(&["transform", "intrinsics"]), "a frame of ARKit", BY_NERFSTUDIO;
    With(&["orientation", "focal_length"]), "a camera of Nerfies", TO_COLMAP;
    With(&["features", "type"]), "GeoJSON, which has places and no cameras", TO_COLMAP;
    With(&["root", "geometricError"]), "a tileset of 3D Tiles", AS_A_SCENE;
    With(&["metadata", "object"]), "a scene of three.js", TO_GLTF;
    With(&["format", "version"]), "a part of a Pix4D project (OPF)", "give the .opf that names it";
    Begin(b"# Bundle file"), "a reconstruction of Bundler", TO_COLMAP;
    Begin(b"NVM_V3"), "a reconstruction of VisualSFM (NVM)", TO_COLMAP;
    Begin(b"#name,"), "a table of RealityCapture (RealityScan)", TO_COLMAP;
    Begin(b"extrinsic"), "a camera of MVSNet", TO_COLMAP;
    Begin(b"<?xml"), "XML, as Metashape and others write cameras", TO_COLMAP;
    Begin(b"<x:xmpmeta"), "XMP, as RealityCapture writes cameras", TO_COLMAP;
    Begin(b"<document"), "XML of Metashape", TO_COLMAP;
    Begin(b"\x93NUMPY"), "an array of NumPy, as LLFF has poses in", "give the COLMAP model that they were made of";
    Begin(b"SQLite format 3"), "a database of COLMAP, which has no poses", "give the sparse folder next to it";
    Begin(b"BLENDER"), "a file of Blender", TO_GLTF;
    Begin(b"\x28\xb5\x2f\xfd"), "a compressed file, as Blender writes them", TO_GLTF;
    Begin(b"Kaydara FBX"), "a file of FBX", TO_GLTF;
    Begin(b"Ogawa"), "a file of Alembic", TO_GLTF;
    Begin(b"#usda"), "a file of USD", TO_GLTF;
    Begin(b"PXR-USDC"), "a file of USD", TO_GLTF;
    Begin(b"PK"), "a ZIP archive", "unpack it, and give the file of cameras in it";
    Begin(b"ply"), "a PLY file", AS_A_SCENE;
    Begin(b"\x1f\x8b"), "a compressed file", "unpack it";
};

/// The sentence on a file that is none of those that are read.
pub(super) fn named(text: &[u8], members: &Members) -> String {
    let is_it = |mark: &Mark| match mark {
        Mark::Members(all) => all.iter().all(|name| members.has(name)),
        Begin(begin) => text.starts_with(begin),
    };
    let kind = KINDS.iter().find(|(mark, ..)| is_it(mark));
    if let Some((_, what, remedy)) = kind {
        return format!("this is {what}, which is not read as cameras; {remedy}");
    }
    if let Some(what) = trajectory(text) {
        return format!(
            "this is {what}, which has no lenses; write a transforms.json with its poses, the size of the pictures and an \
             angle, or give another file"
        );
    }
    "rara does not read cameras from a file of this kind; give a cameras.json of 3DGS, a transforms.json or camera_path.json of nerfstudio, a \
     settings.json of SuperSplat, a project.opf of Pix4D, a glTF with cameras, a COLMAP folder or a file of --save-camera"
        .into()
}

/// What a text of poses is, by how many numbers its first line has.
fn trajectory(text: &[u8]) -> Option<&'static str> {
    let mut lines = text.split(|byte| *byte == b'\n').take(100);
    let first = lines.find(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"))?;
    let line = std::str::from_utf8(first.get(..first.len().min(4096))?).ok()?;
    let words = line
        .split([' ', '\t', ',', '\r'])
        .filter(|word| !word.is_empty());
    let numbers: Vec<bool> = words.map(|word| word.parse::<f64>().is_ok()).collect();
    match (numbers.iter().all(|is| *is), numbers.len()) {
        (true, 8) => Some("a trajectory as those of TUM's benchmarks"),
        (true, 12) => Some("a trajectory as those of KITTI"),
        (true, 3..) => Some("a list of poses or numbers"),
        _ => None,
    }
}
