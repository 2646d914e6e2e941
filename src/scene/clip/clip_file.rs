//! Clips in JSON: a list of planes, or of regions with names,
//! `[{"name": "core", "clip": {"all": [{"sphere": {"centre": [0, 0, 0], "radius": 1}}, {"not": ...}]}}, ...]`.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use glam::DVec2;
use serde::de::{EnumAccess, Error as _, MapAccess, SeqAccess, Unexpected, VariantAccess, Visitor};
use serde::ser::SerializeStructVariant;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::expression::{MESH, POLYGON, names};
use super::mesh_shape::MeshRecord;
use super::shape_text::kind;
use super::solid::Kind;
use super::{Expression, MeshShape, Plane, Prism, PrismBase, Shape};
use rara_base::error::{Error, Result};
use rara_base::json;

/// A clip and its name in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedClip {
    /// The name of the clip in the file, or its number there, from 0. Several clips may have the same name.
    pub name: String,
    /// The clip. One that keeps everything is [`Expression::All`] of nothing.
    pub clip: Expression,
    /// The layer that this clip belongs to; `None` for the clip of all layers that have no clip of their own.
    pub layer: Option<String>,
}

/// True for several clips that have names, of which one is meant. The clips of single layers are none of these.
pub fn are_alternatives(clips: &[NamedClip]) -> bool {
    let of_all = clips.iter().filter(|clip| clip.layer.is_none()).count();
    let mut named = clips.iter().enumerate();
    of_all > 1 && named.any(|(number, clip)| clip.name != number.to_string())
}

#[derive(Deserialize)]
struct ClipFileEntry {
    name: Option<String>,
    layer: Option<String>,
    clip: Option<Node>,
    normal: Option<[f64; 3]>,
    d: Option<f64>,
}

#[derive(Serialize)]
struct ClipRecord<'a> {
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    layer: Option<&'a str>,
    clip: &'a Expression,
}

/// A prism as JSON has it: the polygon and its holes, each as its corners.
#[derive(Serialize, Deserialize)]
struct PrismRecord {
    axis: BaseRecord,
    rings: Vec<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    heights: Option<[f64; 2]>,
}

/// The space of its corners: the name of an axis, a direction, or an eye.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "an axis is one of x, y and z, a direction of three numbers, or an object of eye, right and down"
)]
enum BaseRecord {
    Axis(String),
    Direction([f64; 3]),
    Eye {
        eye: [f64; 3],
        right: [f64; 3],
        down: [f64; 3],
    },
}

impl From<&PrismBase> for BaseRecord {
    fn from(base: &PrismBase) -> Self {
        match base {
            PrismBase::Axis(name) => Self::Axis(name.clone()),
            PrismBase::Direction(direction) => Self::Direction(direction.to_array()),
            PrismBase::Eye { eye, right, down } => Self::Eye {
                eye: eye.to_array(),
                right: right.to_array(),
                down: down.to_array(),
            },
        }
    }
}

impl From<BaseRecord> for PrismBase {
    fn from(record: BaseRecord) -> Self {
        match record {
            BaseRecord::Axis(name) => Self::Axis(name),
            BaseRecord::Direction(direction) => Self::Direction(direction.into()),
            BaseRecord::Eye { eye, right, down } => Self::Eye {
                eye: eye.into(),
                right: right.into(),
                down: down.into(),
            },
        }
    }
}

impl From<&Prism> for PrismRecord {
    fn from(prism: &Prism) -> Self {
        let ring = |ring: &Vec<DVec2>| ring.iter().map(|corner| corner.to_array()).collect();
        Self {
            axis: prism.base().into(),
            rings: prism.rings().iter().map(ring).collect(),
            heights: prism.heights(),
        }
    }
}

/// An expression as JSON has it, of which nothing but its form is known.
enum Node {
    Whole,
    All(Vec<Node>),
    Any(Vec<Node>),
    Not(Box<Node>),
    Prism(PrismRecord),
    Mesh(MeshRecord),
    /// The kind of a solid, and its numbers.
    Solid(&'static Kind, Vec<f64>),
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        from.deserialize_enum("Node", &[], NodeVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "whole, all, any, not or a shape ({})", names())
    }

    fn visit_enum<A: EnumAccess<'de>>(self, node: A) -> std::result::Result<Node, A::Error> {
        let (name, content) = node.variant::<String>()?;
        match name.as_str() {
            "whole" => content.unit_variant().map(|()| Node::Whole),
            "all" => content.newtype_variant().map(Node::All),
            "any" => content.newtype_variant().map(Node::Any),
            "not" => content.newtype_variant().map(Node::Not),
            POLYGON => content.newtype_variant().map(Node::Prism),
            MESH => content.newtype_variant().map(Node::Mesh),
            _ => match kind(&name) {
                Some(kind) => {
                    let numbers = content.struct_variant(&[], kind)?;
                    Ok(Node::Solid(kind, numbers))
                }
                None => Err(A::Error::invalid_value(Unexpected::Str(&name), &self)),
            },
        }
    }
}

/// Reads the numbers of a solid of its kind.
impl<'de> Visitor<'de> for &'static Kind {
    type Value = Vec<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fields: Vec<&str> = self.fields().map(|(field, _)| field).collect();
        write!(f, "the fields {} of a {}", fields.join(", "), self.name)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> std::result::Result<Vec<f64>, A::Error> {
        let mut values = HashMap::new();
        while let Some(name) = map.next_key::<String>()? {
            let field = self.fields().find(|(field, _)| *field == name);
            let (field, count) =
                field.ok_or_else(|| A::Error::invalid_value(Unexpected::Str(&name), &self))?;
            let value = match count {
                1 => vec![map.next_value()?],
                3 => map.next_value::<[f64; 3]>()?.to_vec(),
                _ => map
                    .next_value::<Option<[f64; 4]>>()?
                    .map_or(Vec::new(), Vec::from),
            };
            if values.insert(field, value).is_some() {
                return Err(A::Error::duplicate_field(field));
            }
        }
        let mut numbers = Vec::new();
        for (field, count) in self.fields() {
            match values.remove(field) {
                Some(value) => numbers.extend(value),
                None if count == 4 => {}
                None => return Err(A::Error::missing_field(field)),
            }
        }
        Ok(numbers)
    }
}

/// As a node of the tree of [`load_clips`].
impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        let node = Node::deserialize(from)?;
        node.expression().map_err(D::Error::custom)
    }
}

/// As a node of the tree of [`load_clips`].
impl Serialize for Expression {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::All(all) if all.is_empty() => to.serialize_unit_variant("Node", 0, "whole"),
            Self::All(all) => to.serialize_newtype_variant("Node", 0, "all", all),
            Self::Any(any) => to.serialize_newtype_variant("Node", 0, "any", any),
            Self::Not(operand) => to.serialize_newtype_variant("Node", 0, "not", operand),
            Self::Prism(prism) => {
                to.serialize_newtype_variant("Node", 0, POLYGON, &PrismRecord::from(prism))
            }
            Self::Mesh(mesh) => {
                to.serialize_newtype_variant("Node", 0, MESH, &MeshRecord::from(mesh))
            }
            Self::Shape(shape) if shape.is_outside() => {
                let inside = Self::Shape(shape.complement());
                to.serialize_newtype_variant("Node", 0, "not", &inside)
            }
            Self::Shape(shape) => {
                let (solid, numbers) = (shape.solid(), shape.solid().numbers());
                let mut node =
                    to.serialize_struct_variant("Node", 0, solid.name(), numbers.len())?;
                let mut rest = &numbers[..];
                for (name, count) in solid.kind().fields() {
                    // A rotation that turns nothing has no numbers.
                    let (own, others) = rest.split_at(count.min(rest.len()));
                    match own {
                        [] => {}
                        [number] => node.serialize_field(name, number)?,
                        list => node.serialize_field(name, list)?,
                    }
                    rest = others;
                }
                node.end()
            }
        }
    }
}

impl Node {
    fn expression(self) -> Result<Expression> {
        let list = |name: &str, nodes: Vec<Self>| match nodes.is_empty() {
            true => Err(Error::Invalid(format!(
                "\"{name}\" has no operand; give it one or leave it out"
            ))),
            false => nodes
                .into_iter()
                .map(Self::expression)
                .collect::<Result<Vec<_>>>(),
        };
        Ok(match self {
            Self::Whole => Expression::All(Vec::new()),
            Self::All(all) => Expression::All(list("all", all)?),
            Self::Any(any) => Expression::Any(list("any", any)?),
            Self::Not(node) => match node.expression()? {
                Expression::Shape(shape) if !shape.is_outside() => {
                    Expression::Shape(shape.complement())
                }
                other => Expression::Not(Box::new(other)),
            },
            Self::Prism(PrismRecord {
                axis,
                rings,
                heights,
            }) => {
                let rings: Vec<Vec<DVec2>> = rings
                    .into_iter()
                    .map(|ring| ring.into_iter().map(DVec2::from).collect())
                    .collect();
                Expression::Prism(Prism::new(axis.into(), &rings, heights)?)
            }
            Self::Mesh(record) => Expression::Mesh(MeshShape::try_from(record)?),
            Self::Solid(kind, numbers) => Expression::Shape(Shape::new(kind.solid(&numbers)?)?),
        })
    }
}

/// Loads the clips of a JSON file: a list whose elements have a `"name"` or not, and either `"clip"`, an expression as a
/// tree, or `"normal"` and `"d"`, a plane. An element with a `"layer"` is the clip of that layer, and `"whole"` as a clip keeps
/// everything. A node of the tree is `{"all": [...]}`, `{"any": [...]}`, `{"not": ...}` or a shape,
/// as `{"sphere": {"centre": [x, y, z], "radius": r}}`; quaternions are w, x, y, z. A [`Prism`] is
/// `{"polygon": {"axis": "z", "rings": [[[x, y], ...], ...], "heights": [low, high]}}`; its axis may be a direction `[x, y, z]`, or
/// `{"eye": [x, y, z], "right": [x, y, z], "down": [x, y, z]}`. A [`MeshShape`] is
/// `{"mesh": {"file": "cutter.stl", "rule": "closed", "scale": 1, "turn": [1, 0, 0, 0], "at": [0, 0, 0]}}`, of which only the file must be
/// given.
///
/// # Errors
/// [`Error::Io`] if the file can't be read, [`Error::Format`] if it is no such list or empty, or has a shape without size.
pub fn load_clips(path: &Path) -> Result<Vec<NamedClip>> {
    clips_from_json(&json::read(path, "clips")?, path)
}

/// Like [`load_clips`] for text in memory; `name` stands for the file in messages.
///
/// # Errors
/// [`Error::Format`] as there.
pub fn clips_from_json(json: &[u8], name: &Path) -> Result<Vec<NamedClip>> {
    let format = |message: String| Error::format(name, message);
    let List(clips) = json::parse(json::bare(json)).map_err(format)?;
    if clips.is_empty() {
        let message = "there is no clip in it; save the clips again";
        return Err(format(message.into()));
    }
    Ok(clips)
}

/// The list of a file. Each element becomes a clip as it is read, so that the first bad one ends it.
struct List(Vec<NamedClip>);

impl<'de> Deserialize<'de> for List {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        from.deserialize_seq(Self(Vec::new()))
    }
}

impl<'de> Visitor<'de> for List {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of clips")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> std::result::Result<Self, A::Error> {
        while let Some(entry) = list.next_element::<ClipFileEntry>()? {
            let clip = entry.named(self.0.len()).map_err(A::Error::custom)?;
            self.0.push(clip);
        }
        Ok(self)
    }
}

impl ClipFileEntry {
    /// The clip of the element of this number.
    fn named(self, number: usize) -> std::result::Result<NamedClip, String> {
        let clip = match (self.clip, self.normal, self.d) {
            (Some(node), None, None) => node.expression(),
            (None, Some(normal), Some(d)) => {
                Plane::new(normal.into(), d).map(|plane| Expression::Shape(plane.into()))
            }
            _ => {
                return Err(format!(
                    "element {number} needs either \"clip\", or \"normal\" and \"d\""
                ));
            }
        };
        Ok(NamedClip {
            clip: clip.map_err(|error| format!("element {number}: {error}"))?,
            name: self.name.unwrap_or_else(|| number.to_string()),
            layer: self.layer,
        })
    }
}

/// The JSON that [`clips_from_json`] reads.
pub fn clips_to_json(clips: &[NamedClip]) -> String {
    let saved = clips.iter().map(|named| ClipRecord {
        name: &named.name,
        layer: named.layer.as_deref(),
        clip: &named.clip,
    });
    let saved: Vec<_> = saved.collect();
    // Numbers and strings always have a form in JSON.
    serde_json::to_string_pretty(&saved).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests;
