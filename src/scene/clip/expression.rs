//! Expressions of shapes, as `all(box:0,0,0,1,1,1, not(any(sphere:0,0,0,.5, plane:0,0,1,0)))`.

use std::str::FromStr;
use std::{fmt, slice};

use super::shape_text::kind;
use super::solid::KINDS;
use super::{Clip, ClipOp, MeshShape, Plane, Prism, Shape, Solid};
use crate::bounds::Bounds;
use crate::text_reader::{ShapeTree, TextReader, joined};
use rara_base::error::{Error, Result, shortened};

/// A region as a tree of shapes: what people write, and what a file keeps. It parses from text: `all(...)` keeps what all of
/// its operands keep, `any(...)` what any of them does, `not(...)` or a leading `!` what the operand does not. Operands have
/// commas between them.
///
/// ```
/// # use rara_scene as rara;
/// use rara::{clip::Expression, glam::DVec3};
///
/// let bitten: Expression = "all(box:0,0,0,1,1,1, not(any(sphere:1,1,1,1, plane:0,0,1,0)))".parse()?;
/// let clip = bitten.clip();
/// assert!(clip.keeps(DVec3::new(-0.5, -0.5, -0.5)) && !clip.keeps(DVec3::new(-0.5, -0.5, 0.5)));
/// # Ok::<(), rara::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Expression {
    /// A shape.
    Shape(Shape),
    /// The prism of a polygon.
    Prism(Prism),
    /// The inside of a mesh.
    Mesh(MeshShape),
    /// Keeps the points that all of these expressions keep. The list is not empty.
    All(Vec<Expression>),
    /// Keeps the points that at least one of these expressions keeps. The list is not empty.
    Any(Vec<Expression>),
    /// Keeps the points that this expression does not keep.
    Not(Box<Expression>),
}

/// The word with which the text of a prism begins.
pub(super) const POLYGON: &str = "polygon";
/// The word with which the text of a mesh begins.
pub(super) const MESH: &str = "mesh";

/// The kinds of shapes that are not solids: the word with which their text begins, and their usage.
const OTHERS: &[(&str, &str)] = &[(POLYGON, Prism::USAGE), (MESH, MeshShape::USAGE)];

/// The names of all kinds of shapes, for messages.
pub(super) fn names() -> String {
    let solids = KINDS.iter().map(|kind| kind.name);
    let others = OTHERS.iter().map(|(name, _)| *name);
    solids.chain(others).collect::<Vec<_>>().join(", ")
}

impl Expression {
    /// The plane, if it is a shape that is a half-space.
    pub fn as_plane(&self) -> Option<Plane> {
        match self {
            Self::Shape(shape) => shape.as_plane(),
            _ => None,
        }
    }

    /// How each kind of shape is written as text, and what that means: a few sentences each.
    pub fn usages() -> impl Iterator<Item = &'static str> {
        Solid::usages().chain(OTHERS.iter().map(|(_, usage)| *usage))
    }

    /// Reads the text of one shape, prism or mesh, perhaps with a `!` before it, as [`ShapeTree::read`] reads expressions.
    #[cfg(all(feature = "formats", feature = "json"))] // for layers' regions
    pub(crate) fn read_leaf(text: &str, bounds: Option<Bounds>) -> Result<(Self, bool)> {
        let text = text.trim();
        let bare = text.strip_prefix('!').unwrap_or(text).trim_start();
        let name = bare.split_once(':').map(|(name, _)| name.trim());
        let is_other = |name: &str| OTHERS.iter().any(|(other, _)| *other == name);
        match name {
            Some(name) if is_other(name) => Self::read(text, bounds),
            Some(name) if kind(name).is_none() => Err(Error::Invalid(format!(
                "'{}' is not a shape; use {}",
                shortened(name),
                names()
            ))),
            _ => {
                let (shape, at_shares) = Shape::read(text, bounds.as_ref())?;
                Ok((Self::Shape(shape), at_shares))
            }
        }
    }

    /// The region that it keeps.
    pub fn clip(&self) -> Clip {
        match self {
            Self::Shape(shape) => shape.clip(),
            Self::Prism(prism) => prism.clip(),
            Self::Mesh(mesh) => Clip::of([mesh.inside().clone()], ClipOp::And),
            Self::All(all) => Clip::joined(all.iter().map(Self::clip), ClipOp::And),
            Self::Any(any) => Clip::joined(any.iter().map(Self::clip), ClipOp::Or),
            Self::Not(expression) => expression.clip().complement(),
        }
    }

    /// Returns the shapes of the expression in the order of its text, to move or replace them, without its prisms and meshes.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::clip::Expression;
    ///
    /// let mut region: Expression = "any(sphere:0,0,0,1, not(plane:1,0,0,0))".parse()?;
    /// for shape in region.shapes_mut() {
    ///     *shape = shape.complement();
    /// }
    /// assert_eq!(region.to_string(), "any(!sphere:0,0,0,1, not(!plane:1,0,0,0))");
    /// # Ok::<(), rara::Error>(())
    /// ```
    pub fn shapes_mut(&mut self) -> Vec<&mut Shape> {
        let leaves = self.leaves_mut().into_iter();
        leaves
            .filter_map(|leaf| match leaf {
                Self::Shape(shape) => Some(shape),
                _ => None,
            })
            .collect()
    }

    /// Returns the shapes of the expression in the order of its text.
    pub fn shapes(&self) -> Vec<Shape> {
        let shape = |leaf: &Self| match leaf {
            Self::Shape(shape) => Some(*shape),
            _ => None,
        };
        self.leaves().into_iter().filter_map(shape).collect()
    }

    /// Returns the shapes, prisms and meshes of the expression in the order of its text, each as an expression.
    pub fn leaves(&self) -> Vec<&Self> {
        match self {
            Self::Shape(_) | Self::Prism(_) | Self::Mesh(_) => vec![self],
            Self::All(all) | Self::Any(all) => all.iter().flat_map(Self::leaves).collect(),
            Self::Not(expression) => expression.leaves(),
        }
    }

    /// Returns the same to move or replace them.
    pub fn leaves_mut(&mut self) -> Vec<&mut Self> {
        match self {
            Self::Shape(_) | Self::Prism(_) | Self::Mesh(_) => vec![self],
            Self::All(all) | Self::Any(all) => all.iter_mut().flat_map(Self::leaves_mut).collect(),
            Self::Not(expression) => expression.leaves_mut(),
        }
    }
}

impl FromStr for Expression {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::read(text, None).map(|(read, _)| read)
    }
}

impl ShapeTree for Expression {
    fn read(text: &str, bounds: Option<Bounds>) -> Result<(Self, bool)> {
        let is_of_word = |c: char| c.is_ascii_alphabetic();
        let reader = TextReader::new("clip expression", text, is_of_word, bounds);
        reader.all(TextReader::expression, "join shapes by all( ) or any( )")
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, operands) = match self {
            Self::Shape(shape) => return shape.fmt(f),
            Self::Prism(prism) => return write!(f, "{POLYGON}:{prism}"),
            Self::Mesh(mesh) => return write!(f, "{MESH}:{mesh}"),
            Self::All(all) => ("all", all.as_slice()),
            Self::Any(any) => ("any", any.as_slice()),
            Self::Not(expression) => ("not", slice::from_ref(&**expression)),
        };
        write!(f, "{word}({})", joined(operands, ", ", Self::to_string))
    }
}

impl<'a> TextReader<'a> {
    fn expression(&mut self) -> Result<Expression> {
        if self.takes("!") {
            return Ok(match self.deeper(Self::expression)? {
                Expression::Shape(shape) => Expression::Shape(shape.complement()),
                other => Expression::Not(Box::new(other)),
            });
        }
        match self.word() {
            "all" => self.operands("all").map(Expression::All),
            "any" => self.operands("any").map(Expression::Any),
            "not" => match <[Expression; 1]>::try_from(self.operands("not")?) {
                Ok([operand]) => Ok(Expression::Not(Box::new(operand))),
                Err(_) => self.refuse("not(...) has one operand; put several into any(...)"),
            },
            "" => self.refuse("a shape, all(...), any(...) or not(...) is missing"),
            POLYGON => {
                let text = self.numbers();
                self.part(text, |text| prism(behind_word(text)))
            }
            MESH => {
                let text = self.numbers();
                self.part(text, |text| {
                    MeshShape::parse(behind_word(text)).map(Expression::Mesh)
                })
            }
            name if kind(name).is_some() => self.shape(),
            name => self.refuse(format!(
                "'{}' is neither a shape ({}) nor all, any or not",
                shortened(name),
                names()
            )),
        }
    }

    fn operands(&mut self, word: &str) -> Result<Vec<Expression>> {
        self.enclosed(word, "its operands", |reader| {
            reader.list(",", |reader| reader.deeper(Self::expression))
        })
    }

    /// The text of a shape, whose numbers end where no number follows a comma.
    fn numbers(&self) -> &'a str {
        let rest = self.rest;
        let begins_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
        let ends = |&(at, sign): &(usize, &str)| {
            sign == ")" || !rest[at + 1..].trim_start().starts_with(begins_number)
        };
        let end = rest.match_indices([',', ')']).find(ends);
        &rest[..end.map_or(rest.len(), |(at, _)| at)]
    }

    fn shape(&mut self) -> Result<Expression> {
        let shape = self.numbers();
        let bounds = self.bounds;
        let (shape, at_shares) = self.part(shape, |text| Shape::read(text, bounds.as_ref()))?;
        self.has_shares |= at_shares;
        Ok(Expression::Shape(shape))
    }
}

/// The text of a prism or a mesh behind its word.
fn behind_word(text: &str) -> &str {
    text.split_once(':').map_or("", |(_, rest)| rest)
}

/// Reads a prism, or those of a file's polygons.
fn prism(text: &str) -> Result<Expression> {
    #[cfg(feature = "json")]
    if let Some(prisms) = super::geojson::of_file(text) {
        let mut prisms: Vec<_> = prisms?.into_iter().map(Expression::Prism).collect();
        return Ok(match prisms.len() {
            1 => prisms.remove(0),
            _ => Expression::Any(prisms),
        });
    }
    Prism::read(text).map(Expression::Prism)
}

#[cfg(test)]
mod tests;
