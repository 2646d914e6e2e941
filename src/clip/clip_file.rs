//! Clips in JSON: a list of planes, or of regions with names,
//! `[{"name": "core", "clip": {"all": [{"sphere": {"centre": [0, 0, 0], "radius": 1}}, {"not": ...}]}}, ...]`.

use std::fmt;
use std::path::Path;

use glam::{DQuat, DVec3};
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::{Expression, Plane, Shape, Solid};
use crate::error::{Error, Result};
use crate::json;

/// A clip and what its file calls it.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedClip {
    /// Its name in the file, or its number there, from 0. Several clips may share one.
    pub name: String,
    /// The clip. One that keeps everything is [`Expression::All`] of nothing.
    pub clip: Expression,
    /// The layer whose own clip it is; `None` for the clip of all layers that have none.
    pub layer: Option<String>,
}

#[derive(Deserialize)]
struct Entry {
    name: Option<String>,
    layer: Option<String>,
    clip: Option<Node>,
    normal: Option<[f64; 3]>,
    d: Option<f64>,
}

#[derive(Serialize)]
struct Saved<'a> {
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    layer: Option<&'a str>,
    clip: Node,
}

/// An expression as JSON has it.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Node {
    /// Keeps everything.
    Whole,
    All(Vec<Node>),
    Any(Vec<Node>),
    Not(Box<Node>),
    Plane {
        normal: [f64; 3],
        d: f64,
    },
    Slab {
        normal: [f64; 3],
        d: f64,
        thickness: f64,
    },
    Box {
        centre: [f64; 3],
        half: [f64; 3],
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rotation: Option<[f64; 4]>,
    },
    Sphere {
        centre: [f64; 3],
        radius: f64,
    },
    Ellipsoid {
        centre: [f64; 3],
        radii: [f64; 3],
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rotation: Option<[f64; 4]>,
    },
    Cylinder {
        from: [f64; 3],
        to: [f64; 3],
        radius: f64,
    },
    Capsule {
        from: [f64; 3],
        to: [f64; 3],
        radius: f64,
    },
    Cone {
        apex: [f64; 3],
        base: [f64; 3],
        radius: f64,
    },
}

/// Quaternions are w, x, y, z.
fn quaternion(rotation: Option<[f64; 4]>) -> DQuat {
    rotation.map_or(DQuat::IDENTITY, |[w, x, y, z]| DQuat::from_xyzw(x, y, z, w))
}

fn numbers(rotation: DQuat) -> Option<[f64; 4]> {
    (rotation != DQuat::IDENTITY).then_some([rotation.w, rotation.x, rotation.y, rotation.z])
}

/// As a node of the tree of [`load_clips`].
impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: serde::Deserializer<'de>>(
        deserializer: D,
    ) -> std::result::Result<Self, D::Error> {
        let node = Node::deserialize(deserializer)?;
        node.expression().map_err(serde::de::Error::custom)
    }
}

/// As a node of the tree of [`load_clips`].
impl Serialize for Expression {
    fn serialize<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        Node::of(self).serialize(serializer)
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
        let v = DVec3::from;
        let solid = match self {
            Self::Whole => return Ok(Expression::All(Vec::new())),
            Self::All(all) => return Ok(Expression::All(list("all", all)?)),
            Self::Any(any) => return Ok(Expression::Any(list("any", any)?)),
            Self::Not(node) => {
                return Ok(match node.expression()? {
                    Expression::Shape(shape) if !shape.is_outside() => {
                        Expression::Shape(shape.complement())
                    }
                    other => Expression::Not(Box::new(other)),
                });
            }
            Self::Plane { normal, d } => Solid::Plane(Plane::new(v(normal), d)?),
            Self::Slab {
                normal,
                d,
                thickness,
            } => Solid::Slab {
                plane: Plane::new(v(normal), d)?,
                thickness,
            },
            Self::Box {
                centre,
                half,
                rotation,
            } => Solid::Cuboid {
                centre: v(centre),
                half: v(half),
                rotation: quaternion(rotation),
            },
            Self::Sphere { centre, radius } => Solid::Sphere {
                centre: v(centre),
                radius,
            },
            Self::Ellipsoid {
                centre,
                radii,
                rotation,
            } => Solid::Ellipsoid {
                centre: v(centre),
                radii: v(radii),
                rotation: quaternion(rotation),
            },
            Self::Cylinder { from, to, radius } => Solid::Cylinder {
                from: v(from),
                to: v(to),
                radius,
            },
            Self::Capsule { from, to, radius } => Solid::Capsule {
                from: v(from),
                to: v(to),
                radius,
            },
            Self::Cone { apex, base, radius } => Solid::Cone {
                apex: v(apex),
                base: v(base),
                radius,
            },
        };
        Shape::new(solid).map(Expression::Shape)
    }

    fn of(expression: &Expression) -> Self {
        let list = |all: &[Expression]| all.iter().map(Self::of).collect();
        match expression {
            Expression::All(all) if all.is_empty() => Self::Whole,
            Expression::All(all) => Self::All(list(all)),
            Expression::Any(any) => Self::Any(list(any)),
            Expression::Not(operand) => Self::Not(Box::new(Self::of(operand))),
            Expression::Shape(shape) if shape.is_outside() => {
                Self::Not(Box::new(Self::of_solid(&shape.solid())))
            }
            Expression::Shape(shape) => Self::of_solid(&shape.solid()),
        }
    }

    fn of_solid(solid: &Solid) -> Self {
        let v = |v: DVec3| v.to_array();
        match *solid {
            Solid::Plane(plane) => Self::Plane {
                normal: v(plane.normal()),
                d: plane.offset(),
            },
            Solid::Slab { plane, thickness } => Self::Slab {
                normal: v(plane.normal()),
                d: plane.offset(),
                thickness,
            },
            Solid::Cuboid {
                centre,
                half,
                rotation,
            } => Self::Box {
                centre: v(centre),
                half: v(half),
                rotation: numbers(rotation),
            },
            Solid::Sphere { centre, radius } => Self::Sphere {
                centre: v(centre),
                radius,
            },
            Solid::Ellipsoid {
                centre,
                radii,
                rotation,
            } => Self::Ellipsoid {
                centre: v(centre),
                radii: v(radii),
                rotation: numbers(rotation),
            },
            Solid::Cylinder { from, to, radius } => Self::Cylinder {
                from: v(from),
                to: v(to),
                radius,
            },
            Solid::Capsule { from, to, radius } => Self::Capsule {
                from: v(from),
                to: v(to),
                radius,
            },
            Solid::Cone { apex, base, radius } => Self::Cone {
                apex: v(apex),
                base: v(base),
                radius,
            },
        }
    }
}

/// Loads the clips of a JSON file: a list whose elements have a `"name"` or not, and either `"clip"`, an expression as a
/// tree, or `"normal"` and `"d"`, a plane. An element with a `"layer"` is the clip of that layer, and `"whole"` as a clip keeps
/// everything. A node of the tree is `{"all": [...]}`, `{"any": [...]}`, `{"not": ...}` or a shape,
/// as `{"sphere": {"centre": [x, y, z], "radius": r}}`; quaternions are w, x, y, z.
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
    fn deserialize<D: serde::Deserializer<'de>>(
        deserializer: D,
    ) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_seq(Self(Vec::new()))
    }
}

impl<'de> Visitor<'de> for List {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of clips")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> std::result::Result<Self, A::Error> {
        while let Some(entry) = list.next_element::<Entry>()? {
            let clip = entry.named(self.0.len()).map_err(A::Error::custom)?;
            self.0.push(clip);
        }
        Ok(self)
    }
}

impl Entry {
    /// The clip of the element of this number.
    fn named(self, number: usize) -> std::result::Result<NamedClip, String> {
        let node = match (self.clip, self.normal, self.d) {
            (Some(node), None, None) => node,
            (None, Some(normal), Some(d)) => Node::Plane { normal, d },
            _ => {
                return Err(format!(
                    "element {number} needs either \"clip\", or \"normal\" and \"d\""
                ));
            }
        };
        let clip = node.expression();
        Ok(NamedClip {
            clip: clip.map_err(|error| format!("element {number}: {error}"))?,
            name: self.name.unwrap_or_else(|| number.to_string()),
            layer: self.layer,
        })
    }
}

/// The JSON that [`clips_from_json`] reads.
pub fn clips_to_json(clips: &[NamedClip]) -> String {
    let saved = clips.iter().map(|named| Saved {
        name: &named.name,
        layer: named.layer.as_deref(),
        clip: Node::of(&named.clip),
    });
    let saved: Vec<_> = saved.collect();
    // Numbers and strings always have a form in JSON.
    serde_json::to_string_pretty(&saved).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests;
