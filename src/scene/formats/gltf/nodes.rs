//! The meshes that a document's scene draws, and where.

use glam::{DMat3, DQuat, DVec3};
use serde_json::Value;

use super::super::Failure;
use super::list;
use crate::placement::Placement;

/// How far the sides of a node's axes may be from each other, or from a right angle, to be one scale and a turn.
const EVEN: f64 = 1e-4;

/// The number of each mesh that the scene draws, with its placement in the scene.
pub(super) fn meshes(document: &Value) -> Result<Vec<(usize, Placement)>, Failure> {
    let nodes = list(document, "nodes");
    let scenes = list(document, "scenes");
    if scenes.is_empty() {
        // A document without a scene is a library of meshes.
        let all = 0..list(document, "meshes").len();
        return Ok(all.map(|mesh| (mesh, Placement::IDENTITY)).collect());
    }
    let scene = document
        .get("scene")
        .map_or(Some(0), number)
        .and_then(|scene| scenes.get(scene));
    let scene = scene.ok_or_else(|| {
        format!(
            "the glTF shows a scene that there is not, of {}; export the scene again",
            scenes.len()
        )
    })?;
    let mut found = Vec::new();
    let mut seen = vec![false; nodes.len()];
    let roots = indices(scene, "nodes")?.into_iter().rev();
    let mut open: Vec<(usize, Placement)> = roots.map(|node| (node, Placement::IDENTITY)).collect();
    while let Some((at, parent)) = open.pop() {
        let wrong = |what: &str| {
            Failure::Format(format!(
                "node {at} of the glTF {what}; export the scene again"
            ))
        };
        let node = nodes.get(at).ok_or_else(|| wrong("is not there"))?;
        if std::mem::replace(&mut seen[at], true) {
            return Err(wrong("is in the scene twice, or its own child"));
        }
        let own = placement(node).map_err(wrong)?;
        let own = joined(&parent, &own)?;
        if let Some(mesh) = node.get("mesh") {
            let mesh = number(mesh).ok_or_else(|| wrong("has a mesh that is no number"))?;
            found.push((mesh, own));
        }
        open.extend(
            indices(node, "children")?
                .into_iter()
                .rev()
                .map(|child| (child, own)),
        );
    }
    Ok(found)
}

/// A number of something in a list.
fn number(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

fn indices(object: &Value, key: &str) -> Result<Vec<usize>, Failure> {
    let all: Option<Vec<usize>> = list(object, key).iter().map(number).collect();
    all.ok_or_else(|| {
        Failure::Format(format!(
            "the \"{key}\" of the glTF's scene are not all numbers of nodes; export the scene again"
        ))
    })
}

/// The placement of something within what is placed itself.
pub(super) fn joined(outer: &Placement, inner: &Placement) -> rara_base::error::Result<Placement> {
    if *inner == Placement::IDENTITY {
        return Ok(*outer);
    }
    Placement::new(
        outer.to_world(inner.position()),
        outer.rotation() * inner.rotation(),
        outer.scale() * inner.scale(),
    )
}

/// So many numbers; nothing where there are none.
fn numbers<const N: usize>(node: &Value, key: &str) -> Result<Option<[f64; N]>, &'static str> {
    let Some(value) = node.get(key) else {
        return Ok(None);
    };
    let all = value.as_array().and_then(|all| {
        let all: Option<Vec<f64>> = all.iter().map(Value::as_f64).collect();
        all?.try_into().ok()
    });
    let wrong = "has a matrix, translation, rotation or scale that is not of 16, 3, 4 or 3 numbers";
    all.map(Some).ok_or(wrong)
}

/// A node's own transform, or what is wrong with it.
fn placement(node: &Value) -> Result<Placement, &'static str> {
    const UNEVEN: &str = "scales unlike in different directions or shears, which Gaussians cannot follow: apply its transform";
    const MIRRORED: &str =
        "mirrors or is scaled to nothing, which is not read: apply its transform";
    let made = |position: DVec3, rotation: DQuat, scale: f64| {
        if scale <= 0.0 {
            return Err(MIRRORED);
        }
        let made = Placement::new(position, rotation, scale);
        made.map_err(|_| "has a rotation of length 0, or numbers beyond all that is sensible")
    };
    if let Some(matrix) = numbers::<16>(node, "matrix")? {
        let axes = DMat3::from_cols_array(&[
            matrix[0], matrix[1], matrix[2], matrix[4], matrix[5], matrix[6], matrix[8], matrix[9],
            matrix[10],
        ]);
        let scale = axes.determinant().cbrt();
        let turn = axes * scale.recip();
        if scale > 0.0 && !(turn * turn.transpose()).abs_diff_eq(DMat3::IDENTITY, EVEN) {
            return Err(UNEVEN);
        }
        let position = DVec3::new(matrix[12], matrix[13], matrix[14]);
        let rotation = match scale > 0.0 {
            true => DQuat::from_mat3(&turn),
            false => DQuat::IDENTITY,
        };
        return made(position, rotation, scale);
    }
    let position = numbers::<3>(node, "translation")?.unwrap_or_default();
    let rotation = numbers::<4>(node, "rotation")?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let [x, y, z] = numbers::<3>(node, "scale")?.unwrap_or([1.0; 3]);
    if [x, y, z].iter().any(|scale| *scale <= 0.0) {
        return Err(MIRRORED);
    }
    if (x - y).abs() > EVEN * x || (x - z).abs() > EVEN * x {
        return Err(UNEVEN);
    }
    made(DVec3::from(position), DQuat::from_array(rotation), x)
}
