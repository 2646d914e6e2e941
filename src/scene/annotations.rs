//! Names, `extras` and nodes of a glTF file, around its Gaussians.

use serde_json::{Map, Value};

use super::Gaussians;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// Members of an object of glTF, such as its `name` and its `extras`.
pub(super) type Words = Map<String, Value>;

/// The annotations of a glTF file: names, `extras`, the copyright, and the nodes that lead to Gaussians. No picture shows them.
/// [`SceneFile::annotations`](super::SceneFile::annotations) has the annotations of a file, and
/// [`SaveOptions::annotations`](super::SaveOptions::annotations) writes them to another one.
///
/// They count the Gaussians of each primitive, so that whoever drops some, or joins files, does the same to them by
/// [`keep`](Self::keep) and [`append`](Self::append).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Annotations {
    /// Members of the document's `asset`, and of its scene.
    pub(super) asset: Words,
    pub(super) scene: Words,
    /// Parents come before their children, and what the Gaussians are of in their order.
    pub(super) nodes: Vec<AnnotatedNode>,
}

/// A node, with the mesh of its Gaussians.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct AnnotatedNode {
    pub(super) parent: Option<usize>,
    pub(super) words: Words,
    pub(super) mesh: Words,
    pub(super) primitives: Vec<AnnotatedPrimitive>,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct AnnotatedPrimitive {
    pub(super) extras: Option<Value>,
    /// The number of its Gaussians.
    pub(super) count: usize,
}

impl Annotations {
    /// Makes annotations of Gaussians, without any names or `extras`.
    pub fn of(gaussians: &Gaussians) -> Self {
        let mut node = AnnotatedNode::default();
        node.add(None, gaussians.len());
        Self {
            nodes: vec![node],
            ..Self::default()
        }
    }

    /// Returns true if there is neither a name nor `extras` nor a copyright.
    pub fn is_silent(&self) -> bool {
        let is_silent = |node: &AnnotatedNode| {
            let all = &node.primitives;
            node.words.is_empty()
                && node.mesh.is_empty()
                && all.iter().all(|one| one.extras.is_none())
        };
        self.asset.is_empty() && self.scene.is_empty() && self.nodes.iter().all(is_silent)
    }

    /// Returns the number of Gaussians that the annotations belong to.
    pub fn count(&self) -> usize {
        let all = self.nodes.iter().flat_map(|node| &node.primitives);
        all.map(|one| one.count).sum()
    }

    /// Keeps the annotations of the Gaussians of these numbers, which ascend.
    pub fn keep(&mut self, numbers: &[u32]) {
        let (mut end, mut done) = (0, 0);
        let all = self.nodes.iter_mut().flat_map(|node| &mut node.primitives);
        for one in all {
            end += one.count;
            one.count = numbers[done..].partition_point(|&number| (number as usize) < end);
            done += one.count;
        }
    }

    /// Appends the annotations of Gaussians that are [appended](Gaussians::append). What both say of the asset and the scene
    /// is joined.
    pub fn append(&mut self, other: Self) {
        join(&mut self.asset, other.asset);
        join(&mut self.scene, other.scene);
        let before = self.nodes.len();
        self.nodes
            .extend(other.nodes.into_iter().map(|node| AnnotatedNode {
                parent: node.parent.map(|parent| before + parent),
                ..node
            }));
    }

    /// Refuses Gaussians that they are not of.
    pub(super) fn check(&self, gaussians: &Gaussians) -> Result<()> {
        let (own, count) = (self.count(), gaussians.len());
        match own == count {
            true => Ok(()),
            false => Err(Error::Invalid(format!(
                "the annotations are of {}, and there are {count} to write; drop the same ones from both",
                counted(own, "Gaussian")
            ))),
        }
    }
}

impl AnnotatedNode {
    /// Adds Gaussians to its mesh: to its last primitive, where that has the same `extras`.
    pub(super) fn add(&mut self, extras: Option<Value>, count: usize) {
        match self.primitives.last_mut() {
            Some(last) if last.extras == extras => last.count += count,
            _ => self.primitives.push(AnnotatedPrimitive { extras, count }),
        }
    }
}

/// Adds members; of two that differ both stay, texts one behind the other and others as a list.
fn join(words: &mut Words, others: Words) {
    for (name, other) in others {
        match words.remove(&name) {
            Some(own) if own != other => {
                let both = match (&own, &other) {
                    (Value::String(own), Value::String(other)) => format!("{own}; {other}").into(),
                    _ => Value::from(vec![own, other]),
                };
                words.insert(name, both);
            }
            _ => drop(words.insert(name, other)),
        }
    }
}
