//! The meshes that a document's scene draws, and where.

use glam::{DMat3, DQuat, DVec3};
use serde_json::Value;

use super::super::Failure;
use super::{index, list};
use crate::placement::Placement;

/// How far the sides of a node's axes may be from each other, or from a right angle, to be one scale and a turn.
const EVEN: f64 = 1e-4;

/// The number of each mesh that the scene draws, with its placement in the scene.
pub(super) fn meshes(document: &Value) -> Result<Vec<(usize, Placement)>, Failure> {
    let nodes = list(document, "nodes");
    let scene = index(document, "scene").unwrap_or(0);
    let scene = usize::try_from(scene)
        .ok()
        .and_then(|scene| list(document, "scenes").get(scene));
    let Some(scene) = scene else {
        // A document without a scene is a library of meshes.
        let all = 0..list(document, "meshes").len();
        return Ok(all.map(|mesh| (mesh, Placement::IDENTITY)).collect());
    };
    let number = |value: &Value| {
        value
            .as_u64()
            .and_then(|number| usize::try_from(number).ok())
    };
    let numbers = |object: &Value, key: &str| {
        list(object, key)
            .iter()
            .filter_map(number)
            .collect::<Vec<_>>()
    };
    let mut found = Vec::new();
    let mut seen = vec![false; nodes.len()];
    let roots = numbers(scene, "nodes").into_iter().rev();
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
        let own = placement(node).ok_or_else(|| {
            wrong("does not turn and scale alike in all directions, which Gaussians cannot follow: apply its transform")
        })?;
        let own = joined(&parent, &own)?;
        if let Some(mesh) = node.get("mesh").and_then(number) {
            found.push((mesh, own));
        }
        open.extend(
            numbers(node, "children")
                .into_iter()
                .rev()
                .map(|child| (child, own)),
        );
    }
    Ok(found)
}

/// The placement of something within what is placed itself.
pub(super) fn joined(outer: &Placement, inner: &Placement) -> crate::error::Result<Placement> {
    if *inner == Placement::IDENTITY {
        return Ok(*outer);
    }
    Placement::new(
        outer.to_world(inner.position()),
        outer.rotation() * inner.rotation(),
        outer.scale() * inner.scale(),
    )
}

fn numbers<const N: usize>(node: &Value, key: &str) -> Option<Option<[f64; N]>> {
    let Some(value) = node.get(key) else {
        return Some(None);
    };
    let all: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    Some(Some(all?.try_into().ok()?))
}

/// A node's own transform; `None` for one that is no placement.
fn placement(node: &Value) -> Option<Placement> {
    if let Some(matrix) = numbers::<16>(node, "matrix")? {
        let axes = DMat3::from_cols_array(&[
            matrix[0], matrix[1], matrix[2], matrix[4], matrix[5], matrix[6], matrix[8], matrix[9],
            matrix[10],
        ]);
        let scale = axes.determinant().cbrt();
        let turn = axes * scale.recip();
        let is_turn = (turn * turn.transpose()).abs_diff_eq(DMat3::IDENTITY, EVEN);
        let position = DVec3::new(matrix[12], matrix[13], matrix[14]);
        let made = Placement::new(position, DQuat::from_mat3(&turn), scale);
        return made.ok().filter(|_| is_turn);
    }
    let position = numbers::<3>(node, "translation")?.unwrap_or_default();
    let rotation = numbers::<4>(node, "rotation")?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let [x, y, z] = numbers::<3>(node, "scale")?.unwrap_or([1.0; 3]);
    let is_even = (x - y).abs() <= EVEN * x.abs() && (x - z).abs() <= EVEN * x.abs();
    let made = Placement::new(DVec3::from(position), DQuat::from_array(rotation), x);
    made.ok().filter(|_| is_even)
}
