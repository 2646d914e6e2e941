//! The meshes that a document's scene draws, and where.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::Value;

use super::super::{Failure, list};
use super::accessor::Accessor;
use super::buffers::Buffers;
use super::{attribute, count_of};
use crate::placement::Placement;

/// The extension of a node that draws its mesh several times, each time with a transform of its own.
pub(super) const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// The extension of a node by which it hides itself and what is below it.
pub(super) const VISIBILITY: &str = "KHR_node_visibility";

/// How far the sides of a node's axes may be from each other, or from a right angle, to be one scale and a turn.
const EVEN: f64 = 1e-4;

/// Where something stands in what it is a part of.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Transform {
    Similar(Placement),
    /// A transform that shears, mirrors, or scales non-uniformly.
    Other(DAffine3),
}

impl Transform {
    pub(super) const IDENTITY: Self = Self::Similar(Placement::IDENTITY);

    /// The transform of something within what is transformed itself.
    pub(super) fn of_inner(&self, inner: &Self) -> rara_base::error::Result<Self> {
        match (self, inner) {
            (_, Self::Similar(inner)) if *inner == Placement::IDENTITY => Ok(*self),
            (Self::Similar(outer), Self::Similar(inner)) => Placement::new(
                outer.to_world(inner.position()),
                outer.rotation() * inner.rotation(),
                outer.scale() * inner.scale(),
            )
            .map(Self::Similar),
            _ => Ok(Self::Other(self.affine() * inner.affine())),
        }
    }

    fn affine(&self) -> DAffine3 {
        match self {
            Self::Similar(placement) => DAffine3::from_scale_rotation_translation(
                DVec3::splat(placement.scale()),
                placement.rotation(),
                placement.position(),
            ),
            Self::Other(affine) => *affine,
        }
    }

    /// Where a point within it stands.
    pub(super) fn of_point(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Similar(placement) => placement.to_world(point),
            Self::Other(affine) => affine.transform_point3(point),
        }
    }

    /// True where it makes a left hand of a right one.
    pub(super) fn mirrors(&self) -> bool {
        matches!(self, Self::Other(affine) if affine.matrix3.determinant() < 0.0)
    }

    /// True where nothing is left of what it is of, by which a file hides it.
    pub(super) fn hides(&self) -> bool {
        matches!(self, Self::Other(affine) if affine.matrix3 == DMat3::ZERO)
    }
}

/// A mesh that the scene draws.
pub(super) struct Drawn {
    /// The node that has it; none where the document has no scene.
    pub(super) node: Option<usize>,
    pub(super) mesh: usize,
    /// Where it stands in the scene.
    pub(super) transform: Transform,
    /// False where its node, or one above that, is hidden.
    pub(super) is_visible: bool,
}

/// The meshes that the scene draws, and the parent of each node that has one.
pub(super) fn meshes(
    document: &Value,
    buffers: &mut Buffers<'_>,
) -> Result<(Vec<Drawn>, Vec<Option<usize>>), Failure> {
    let nodes = list(document, "nodes");
    let scenes = list(document, "scenes");
    if scenes.is_empty() {
        // A document without a scene is a library of meshes.
        let all = 0..list(document, "meshes").len();
        let drawn = all.map(|mesh| Drawn {
            node: None,
            mesh,
            transform: Transform::IDENTITY,
            is_visible: true,
        });
        return Ok((drawn.collect(), Vec::new()));
    }
    let scene = document
        .get("scene")
        .map_or(Some(0), number)
        .and_then(|scene| scenes.get(scene));
    let scene = scene.ok_or_else(|| {
        format!(
            "the glTF names a scene that the file does not have, of {}; export the scene again",
            scenes.len()
        )
    })?;
    let mut found = Vec::new();
    let mut seen = vec![false; nodes.len()];
    let mut parents = vec![None; nodes.len()];
    let roots = indices(scene, "nodes")?.into_iter().rev();
    let mut open: Vec<(usize, Transform, bool)> = roots
        .map(|node| (node, Transform::IDENTITY, true))
        .collect();
    while let Some((at, parent, is_shown)) = open.pop() {
        let wrong = |what: &str| {
            Failure::Format(format!(
                "node {at} of the glTF {what}; export the scene again"
            ))
        };
        let node = nodes.get(at).ok_or_else(|| wrong("is not there"))?;
        if std::mem::replace(&mut seen[at], true) {
            return Err(wrong("is in the scene twice, or its own child"));
        }
        let visibility = node
            .get("extensions")
            .and_then(|all| all.get(VISIBILITY)?.get("visible"));
        let is_visible = is_shown && visibility.and_then(Value::as_bool) != Some(false);
        let own = parent.of_inner(&transform(node).map_err(wrong)?)?;
        if let Some(mesh) = node.get("mesh") {
            let mesh = number(mesh).ok_or_else(|| wrong("has a mesh that is not a number"))?;
            let mut add = |transform| {
                found.push(Drawn {
                    node: Some(at),
                    mesh,
                    transform,
                    is_visible,
                });
            };
            match node.get("extensions").and_then(|all| all.get(INSTANCES)) {
                Some(instances) => {
                    for instance in instance_transforms(document, buffers, instances, &wrong)? {
                        add(own.of_inner(&instance)?);
                    }
                }
                None => add(own),
            }
        }
        for child in indices(node, "children")?.into_iter().rev() {
            if let Some(parent) = parents.get_mut(child) {
                *parent = Some(at);
            }
            open.push((child, own, is_visible));
        }
    }
    Ok((found, parents))
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

/// So many numbers; nothing where there are none.
fn numbers<const N: usize>(node: &Value, key: &str) -> Result<Option<[f64; N]>, &'static str> {
    let Some(value) = node.get(key) else {
        return Ok(None);
    };
    let all = super::super::numbers(value).and_then(|all| all.try_into().ok());
    let wrong = "has a matrix, translation, rotation or scale that is not of 16, 3, 4 or 3 numbers";
    all.map(Some).ok_or(wrong)
}

/// The transform of each instance of a node; `wrong` says what is wrong with the node.
fn instance_transforms(
    document: &Value,
    buffers: &mut Buffers<'_>,
    instances: &Value,
    wrong: &dyn Fn(&str) -> Failure,
) -> Result<Vec<Transform>, Failure> {
    let attributes = instances.get("attributes");
    const PARTS: [(&str, usize); 3] = [("TRANSLATION", 3), ("ROTATION", 4), ("SCALE", 3)];
    let count = PARTS
        .iter()
        .find_map(|(name, _)| count_of(document, attributes, name))
        .ok_or_else(|| wrong("has instances without a count"))?;
    let mut parts = Vec::new();
    for (name, size) in PARTS {
        parts.push(match attribute(attributes, name) {
            Some(at) => Some(Accessor::from_json(
                document, buffers, at, name, count, size,
            )?),
            None => None,
        });
    }
    let made = |instance: u64| {
        let value = |part: usize, at: usize, otherwise: f64| match &parts[part] {
            Some(accessor) => accessor.at(instance, at),
            None => otherwise,
        };
        transform_of(
            [0, 1, 2].map(|axis| value(0, axis, 0.0)),
            [0, 1, 2, 3].map(|at| value(1, at, if at == 3 { 1.0 } else { 0.0 })),
            [0, 1, 2].map(|axis| value(2, axis, 1.0)),
        )
    };
    let all: Result<_, _> = (0..count).map(made).collect();
    all.map_err(|what| wrong(&format!("has an instance that {what}")))
}

const NOT_SENSIBLE: &str = "has a rotation of length 0, or numbers beyond all that is sensible";

/// The transform by a translation, a rotation and scales, or what is wrong with them.
fn transform_of(
    position: [f64; 3],
    rotation: [f64; 4],
    scales: [f64; 3],
) -> Result<Transform, &'static str> {
    let position = DVec3::from(position);
    let [x, y, z] = scales;
    if x > 0.0 && (x - y).abs() <= EVEN * x && (x - z).abs() <= EVEN * x {
        let placement = Placement::new(position, DQuat::from_array(rotation), x);
        return placement.map(Transform::Similar).map_err(|_| NOT_SENSIBLE);
    }
    let rotation = Placement::new(position, DQuat::from_array(rotation), 1.0)
        .map_err(|_| NOT_SENSIBLE)?
        .rotation();
    affine(DAffine3::from_scale_rotation_translation(
        scales.into(),
        rotation,
        position,
    ))
}

fn affine(affine: DAffine3) -> Result<Transform, &'static str> {
    match affine.is_finite() {
        true => Ok(Transform::Other(affine)),
        false => Err(NOT_SENSIBLE),
    }
}

/// A node's own transform, or what is wrong with it.
fn transform(node: &Value) -> Result<Transform, &'static str> {
    if let Some(matrix) = numbers::<16>(node, "matrix")? {
        let columns = DAffine3::from_cols_array(&[
            matrix[0], matrix[1], matrix[2], matrix[4], matrix[5], matrix[6], matrix[8], matrix[9],
            matrix[10], matrix[12], matrix[13], matrix[14],
        ]);
        let scale = columns.matrix3.determinant().cbrt();
        let turn = columns.matrix3 * scale.recip();
        let is_similar =
            scale > 0.0 && (turn * turn.transpose()).abs_diff_eq(DMat3::IDENTITY, EVEN);
        return match is_similar {
            true => transform_of(
                columns.translation.to_array(),
                DQuat::from_mat3(&turn).to_array(),
                [scale; 3],
            ),
            false => affine(columns),
        };
    }
    let position = numbers::<3>(node, "translation")?.unwrap_or_default();
    let rotation = numbers::<4>(node, "rotation")?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    transform_of(
        position,
        rotation,
        numbers::<3>(node, "scale")?.unwrap_or([1.0; 3]),
    )
}
