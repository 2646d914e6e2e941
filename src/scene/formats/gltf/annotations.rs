//! Reading what a document says around its Gaussians.

use std::collections::BTreeMap;

use serde_json::Value;

use super::super::list;
use super::MARKS;
use super::nodes::Drawn;
use crate::annotations::{AnnotatedNode, Annotations, Words};

/// The annotations of the Gaussians that have been read.
pub(super) struct AnnotationsReader<'a> {
    document: &'a Value,
    /// The parent of each node.
    parents: Vec<Option<usize>>,
    /// The places of nodes in the annotations; of meshes, where the document has no scene.
    places: BTreeMap<usize, usize>,
    annotations: Annotations,
}

impl<'a> AnnotationsReader<'a> {
    pub(super) fn new(document: &'a Value, parents: Vec<Option<usize>>) -> Self {
        let scene = super::index(document, "scene").unwrap_or(0);
        let scene = list(document, "scenes").get(scene as usize);
        Self {
            document,
            parents,
            places: BTreeMap::new(),
            annotations: Annotations {
                asset: words(document.get("asset"), &["copyright", "extras"]),
                scene: words(scene, NAMED),
                nodes: Vec::new(),
            },
        }
    }

    /// Adds Gaussians of a primitive.
    pub(super) fn add(&mut self, drawn: &Drawn, primitive: &Value, count: usize) {
        let place = self.place(drawn.node.unwrap_or(drawn.mesh), drawn.node.is_some());
        let mut extras = primitive.get("extras").cloned();
        let own = extras.as_mut().and_then(Value::as_object_mut);
        // These are written anew.
        if own.is_some_and(|own| own.remove(MARKS).is_some() && own.is_empty()) {
            extras = None;
        }
        let node = &mut self.annotations.nodes[place];
        node.mesh = words(list(self.document, "meshes").get(drawn.mesh), NAMED);
        node.add(extras, count);
    }

    pub(super) fn finish(self) -> Annotations {
        self.annotations
    }

    /// The place of a node in the annotations, after those that lead to it.
    fn place(&mut self, node: usize, is_node: bool) -> usize {
        let mut path = Vec::new();
        let mut at = Some(node);
        let mut parent = None;
        while let Some(node) = at {
            parent = self.places.get(&node).copied();
            if parent.is_some() {
                break;
            }
            path.push(node);
            at = self.parents.get(node).copied().flatten();
        }
        for node in path.into_iter().rev() {
            let place = self.annotations.nodes.len();
            let named = list(self.document, "nodes").get(node).filter(|_| is_node);
            self.annotations.nodes.push(AnnotatedNode {
                parent,
                words: words(named, NAMED),
                ..AnnotatedNode::default()
            });
            self.places.insert(node, place);
            parent = Some(place);
        }
        parent.unwrap_or_default()
    }
}

/// The members that most objects of glTF may have.
const NAMED: &[&str] = &["name", "extras"];

/// Those of an object's members that have these names.
fn words(object: Option<&Value>, names: &[&str]) -> Words {
    let found = |name: &&str| Some(((*name).to_owned(), object?.get(*name)?.clone()));
    names.iter().filter_map(found).collect()
}
