//! Expressions of shapes, as `all(box:0,0,0,1,1,1, not(any(sphere:0,0,0,.5, plane:0,0,1,0)))`.

use std::fmt;
use std::str::FromStr;

use super::shape_text::{kind, names};
use super::{Clip, ClipOp, Plane, Shape};
use rara_base::error::{Error, Result, shortened};

/// How deep an expression may be nested.
/// A file has it twice as deep, of which JSON's reader takes 128 levels.
const DEPTH: usize = 48;

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
    /// What all of them keep; at least one.
    All(Vec<Expression>),
    /// What any of them keeps; at least one.
    Any(Vec<Expression>),
    /// What it does not keep.
    Not(Box<Expression>),
}

impl Expression {
    /// The plane, if it is a shape that is a half-space.
    pub fn as_plane(&self) -> Option<Plane> {
        match self {
            Self::Shape(shape) => shape.as_plane(),
            _ => None,
        }
    }

    /// The region that it keeps.
    pub fn clip(&self) -> Clip {
        match self {
            Self::Shape(shape) => shape.clip(),
            Self::All(all) => Clip::joined(all.iter().map(Self::clip), ClipOp::And),
            Self::Any(any) => Clip::joined(any.iter().map(Self::clip), ClipOp::Or),
            Self::Not(expression) => expression.clip().complement(),
        }
    }

    /// Its shapes, in the order in which they are written, to be moved or replaced.
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
        match self {
            Self::Shape(shape) => vec![shape],
            Self::All(all) | Self::Any(all) => all.iter_mut().flat_map(Self::shapes_mut).collect(),
            Self::Not(expression) => expression.shapes_mut(),
        }
    }

    /// Its shapes, in the order in which they are written.
    pub fn shapes(&self) -> Vec<Shape> {
        match self {
            Self::Shape(shape) => vec![*shape],
            Self::All(all) | Self::Any(all) => all.iter().flat_map(Self::shapes).collect(),
            Self::Not(expression) => expression.shapes(),
        }
    }
}

impl FromStr for Expression {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let mut parser = Parser {
            text,
            at: 0,
            what: "clip expression",
        };
        let expression = parser.expression(0)?;
        match parser.rest() {
            "" => Ok(expression),
            rest => Err(parser.error(&format!("'{}' is left over", shortened(rest)))),
        }
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, name: &str, operands: &[Self]| {
            write!(f, "{name}(")?;
            for (number, operand) in operands.iter().enumerate() {
                f.write_str(if number > 0 { ", " } else { "" })?;
                operand.fmt(f)?;
            }
            f.write_str(")")
        };
        match self {
            Self::Shape(shape) => shape.fmt(f),
            Self::All(all) => list(f, "all", all),
            Self::Any(any) => list(f, "any", any),
            Self::Not(expression) => write!(f, "not({expression})"),
        }
    }
}

/// A reader of a text. What there is to be read is said where that is defined.
pub(crate) struct Parser<'a> {
    pub(crate) text: &'a str,
    /// Bytes that are read.
    pub(crate) at: usize,
    /// What the text is called.
    pub(crate) what: &'static str,
}

impl<'a> Parser<'a> {
    /// The rest of the text, from its first character that is not blank.
    pub(crate) fn rest(&mut self) -> &'a str {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        rest.trim_end()
    }

    pub(crate) fn takes(&mut self, token: &str) -> bool {
        let takes = self.rest().starts_with(token);
        self.at += if takes { token.len() } else { 0 };
        takes
    }

    pub(crate) fn error(&self, what: &str) -> Error {
        let column = self.text[..self.at].chars().count() + 1;
        Error::Invalid(format!("column {column} of the {}: {what}", self.what))
    }
}

impl Parser<'_> {
    fn expression(&mut self, depth: usize) -> Result<Expression> {
        if depth > DEPTH {
            return Err(self.error(&format!("it is nested deeper than {DEPTH} levels")));
        }
        if self.takes("!") {
            let operand = self.expression(depth + 1)?;
            return Ok(match operand {
                Expression::Shape(shape) => Expression::Shape(shape.complement()),
                other => Expression::Not(Box::new(other)),
            });
        }
        let rest = self.rest();
        let end = rest.find(|c: char| !c.is_ascii_alphabetic());
        let name = &rest[..end.unwrap_or(rest.len())];
        match name {
            "all" | "any" | "not" => {
                self.at += name.len();
                let mut operands = self.operands(name, depth)?;
                Ok(match name {
                    "all" => Expression::All(operands),
                    "any" => Expression::Any(operands),
                    _ if operands.len() > 1 => {
                        return Err(
                            self.error("not(...) has one operand; put several into any(...)")
                        );
                    }
                    _ => Expression::Not(Box::new(operands.remove(0))),
                })
            }
            _ if kind(name).is_some() => self.shape(rest),
            "" => Err(self.error("a shape, all(...), any(...) or not(...) is missing")),
            _ => Err(self.error(&format!(
                "'{}' is neither a shape ({}) nor all, any or not",
                shortened(name),
                names()
            ))),
        }
    }

    fn operands(&mut self, name: &str, depth: usize) -> Result<Vec<Expression>> {
        if !self.takes("(") {
            return Err(self.error(&format!("{name} needs its operands in ( )")));
        }
        let mut operands = vec![self.expression(depth + 1)?];
        while self.takes(",") {
            operands.push(self.expression(depth + 1)?);
        }
        match self.takes(")") {
            true => Ok(operands),
            false => Err(self.error(&format!("the ) of {name}( is missing"))),
        }
    }

    /// A shape, whose numbers end where no number follows a comma.
    fn shape(&mut self, rest: &str) -> Result<Expression> {
        let is_number = |text: &str| {
            let first = text.trim_start().chars().next();
            first.is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c))
        };
        let end = rest.find(')').unwrap_or(rest.len());
        let commas = rest[..end].match_indices(',').map(|(at, _)| at);
        let end = commas
            .into_iter()
            .find(|&at| !is_number(&rest[at + 1..end]));
        let end = end.unwrap_or_else(|| rest.find(')').unwrap_or(rest.len()));
        let shape = rest[..end]
            .parse()
            .map_err(|e: Error| self.error(&e.to_string()))?;
        self.at += end;
        Ok(Expression::Shape(shape))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use glam::DVec3;

    fn random(random: &mut Random, depth: u32) -> Expression {
        let pick = (random.unit() * if depth == 0 { 2.0 } else { 5.0 }) as u32;
        let mut operands = || {
            let count = 1 + (random.unit() * 3.0) as usize;
            (0..count)
                .map(|_| self::random(random, depth - 1))
                .collect()
        };
        match pick {
            2 => Expression::All(operands()),
            3 => Expression::Any(operands()),
            4 => Expression::Not(Box::new(self::random(random, depth - 1))),
            _ => {
                let [x, y, z] = [(); 3].map(|()| 2.0 * random.unit() - 1.0);
                let text = match pick {
                    0 => format!("sphere:{x},{y},{z},{}", 0.3 + random.unit()),
                    _ => format!("!plane:{x},{y},{z},{}", random.unit() - 0.5),
                };
                Expression::Shape(text.parse().unwrap())
            }
        }
    }

    fn keeps(expression: &Expression, point: DVec3) -> bool {
        match expression {
            Expression::Shape(shape) => shape.clip().keeps(point),
            Expression::All(all) => all.iter().all(|e| keeps(e, point)),
            Expression::Any(any) => any.iter().any(|e| keeps(e, point)),
            Expression::Not(expression) => !keeps(expression, point),
        }
    }

    #[test]
    fn a_region_keeps_what_its_expression_means_and_text_round_trips() {
        let mut source = Random::new(9);
        for _ in 0..300 {
            let expression = random(&mut source, 4);
            let back: Expression = expression.to_string().parse().unwrap();
            assert_eq!(back, expression);
            let clip = expression.clip();
            for _ in 0..20 {
                let point = DVec3::from_array([(); 3].map(|()| 3.0 * source.unit() - 1.5));
                assert_eq!(clip.keeps(point), keeps(&expression, point), "{expression}");
                assert_eq!(clip.complement().keeps(point), !clip.keeps(point));
            }
        }
    }

    #[test]
    fn nonsense_is_refused_with_its_place() {
        for (text, words) in [
            ("", "column 1"),
            ("all()", "column 5"),
            ("all(plane:1,0,0,0", "the ) of all("),
            ("all(plane:1,0,0,0,sphere:0,0,0)", "column 19"),
            ("not(plane:1,0,0,0, plane:0,1,0,0)", "one operand"),
            ("some(plane:1,0,0,0)", "'some'"),
            ("plane:1,0,0,0 )", "left over"),
            ("all plane:1,0,0,0", "( )"),
        ] {
            let message = text.parse::<Expression>().unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
        let deep = format!("{}plane:1,0,0,0{}", "not(".repeat(100), ")".repeat(100));
        assert!(
            deep.parse::<Expression>()
                .unwrap_err()
                .to_string()
                .contains("48")
        );
    }
}
