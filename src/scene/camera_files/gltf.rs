//! Cameras of glTF 2.0: where the nodes of the scene put them, in the coordinates in which its Gaussians are read.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::Deserialize;

use super::{Entry, Outcome, Parts, Pose};
use crate::camera::Projection;
use rara_base::error::{Error, Result, shortened};
use rara_base::json;

/// A glTF says no size of pictures, and perhaps their aspect.
const HEIGHT: f64 = 1024.0;
/// What a `.glb` begins with, and how long that and the head of its first chunk are.
pub(super) const MAGIC: &[u8] = b"glTF";
const HEAD: usize = 20;
/// The kind of the chunk that is JSON.
const JSON: &[u8] = b"JSON";

#[derive(Deserialize)]
struct Document {
    #[serde(default)]
    scene: usize,
    #[serde(default)]
    scenes: Vec<SceneNodes>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    cameras: Vec<GltfCamera>,
}

#[derive(Deserialize)]
struct SceneNodes {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    name: Option<String>,
    camera: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    /// x, y, z, w.
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct GltfCamera {
    name: Option<String>,
    perspective: Option<Perspective>,
    orthographic: Option<Orthographic>,
}

#[derive(Deserialize)]
struct Perspective {
    /// Radians.
    yfov: f64,
    #[serde(rename = "aspectRatio")]
    aspect: Option<f64>,
}

/// Half of what is seen along x and along y.
#[derive(Deserialize)]
struct Orthographic {
    xmag: f64,
    ymag: f64,
}

/// The JSON of a `.glb`, which may be longer than files of cameras are; `None` for other files.
pub(super) fn json_of(path: &Path) -> Result<Option<Vec<u8>>> {
    let mut file = File::open(path).map_err(Error::io(path))?;
    let mut head = Vec::new();
    let mut begin = (&mut file).take(HEAD as u64);
    begin.read_to_end(&mut head).map_err(Error::io(path))?;
    if !head.starts_with(MAGIC) {
        return Ok(None);
    }
    let length = length(&head).map_err(|message| Error::format(path, message))?;
    let mut text = Vec::new();
    file.take(length.into())
        .read_to_end(&mut text)
        .map_err(Error::io(path))?;
    Ok(Some(text))
}

/// How long the JSON is that follows a `.glb`'s head.
fn length(head: &[u8]) -> std::result::Result<u32, String> {
    let number = |at: usize| Some(u32::from_le_bytes(head.get(at..at + 4)?.try_into().ok()?));
    match (number(4), number(12), head.get(16..20)) {
        (Some(2), Some(length), Some(JSON)) => Ok(length),
        _ => Err("this is not a .glb of glTF 2 that begins with its JSON; export it again".into()),
    }
}

/// The cameras of a `.glb` in memory.
pub(super) fn parse_binary(bytes: &[u8]) -> std::result::Result<Vec<Entry>, String> {
    let length = length(bytes)? as usize;
    let text = bytes[HEAD..].get(..length);
    parse(text.ok_or("the .glb ends inside its JSON; get it again")?)
}

/// The cameras of a document.
pub(super) fn parse(text: &[u8]) -> std::result::Result<Vec<Entry>, String> {
    let document: Document = json::parse(text)?;
    let mut entries = Vec::new();
    let mut seen = vec![false; document.nodes.len()];
    let roots = match document.scenes.get(document.scene) {
        Some(scene) => scene.nodes.clone(),
        // A document without a scene is a library, in which nodes that are no children stand by themselves.
        None => {
            let mut is_child = vec![false; document.nodes.len()];
            let children = document.nodes.iter().flat_map(|node| &node.children);
            children.for_each(|&child| {
                is_child
                    .get_mut(child)
                    .into_iter()
                    .for_each(|is| *is = true)
            });
            (0..is_child.len())
                .filter(|&node| !is_child[node])
                .collect()
        }
    };
    let begin = roots
        .into_iter()
        .rev()
        .map(|node| (node, DAffine3::IDENTITY));
    let mut open: Vec<(usize, DAffine3)> = begin.collect();
    while let Some((at, parent)) = open.pop() {
        let node = document
            .nodes
            .get(at)
            .filter(|_| !std::mem::replace(&mut seen[at], true));
        let node = node.ok_or_else(|| {
            format!("node {at} of the glTF is not there, in the scene twice, or its own child; export the scene again")
        })?;
        let whole = parent * node.transform();
        if let Some(number) = node.camera {
            let camera = document.cameras.get(number);
            let name = node
                .name
                .as_ref()
                .or(camera.and_then(|camera| camera.name.as_ref()));
            let name = name.cloned().unwrap_or_else(|| entries.len().to_string());
            let what = format!("the camera `{}` of node {at}", shortened(&name));
            let pinhole = |what: &str| match camera {
                Some(camera) => camera.camera(whole, what),
                None => Err(format!("{what} is not in the glTF; export the scene again")),
            };
            entries.push(Entry::new(name, what, pinhole));
        }
        open.extend(node.children.iter().rev().map(|&child| (child, whole)));
    }
    match entries.is_empty() {
        true => Err("the glTF has no cameras in its scene; export it with them".into()),
        false => Ok(entries),
    }
}

impl Node {
    fn transform(&self) -> DAffine3 {
        if let Some(m) = self.matrix {
            return DAffine3::from_cols_array(&[
                m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10], m[12], m[13], m[14],
            ]);
        }
        DAffine3::from_scale_rotation_translation(
            self.scale.map_or(DVec3::ONE, DVec3::from),
            self.rotation
                .map_or(DQuat::IDENTITY, DQuat::from_array)
                .normalize(),
            self.translation.unwrap_or_default().into(),
        )
    }
}

impl GltfCamera {
    /// The camera at a place in the scene, whose scales do not concern it.
    fn camera(&self, place: DAffine3, what: &str) -> Outcome {
        // As Gaussians are turned from left, up and forward: half a turn about the direction of view.
        let turned = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
        let [right, up, back] = place
            .matrix3
            .to_cols_array_2d()
            .map(|axis| DVec3::from(axis).normalize());
        let aspect = match (&self.perspective, &self.orthographic) {
            (Some(lens), _) => lens.aspect.unwrap_or(1.0),
            (_, Some(lens)) => lens.xmag / lens.ymag,
            _ => {
                return Err(format!(
                    "{what} is neither perspective nor orthographic; export the scene again"
                ));
            }
        };
        let focal = match (&self.perspective, &self.orthographic) {
            (Some(lens), _) => HEIGHT / 2.0 / (lens.yfov / 2.0).tan(),
            (_, Some(lens)) => HEIGHT / 2.0 / lens.ymag.abs(),
            _ => f64::NAN,
        };
        let parts = Parts {
            width: (HEIGHT * aspect).round(),
            height: HEIGHT,
            focal: (focal, focal),
            centre: (None, None),
            pose: Pose::CameraToWorld {
                axes: turned * DMat3::from_cols(right, -up, -back),
                eye: turned * place.translation,
            },
        };
        let mut made = parts.camera(what)?;
        if self.perspective.is_none() {
            made.camera = made.camera.projection(Projection::Orthographic);
        }
        Ok(made)
    }
}
