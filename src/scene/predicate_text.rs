//! The text of predicates, as `label in 3,4 and not inside(sphere:0,0,0,1)`.

use std::fmt;
use std::str::FromStr;

use super::predicate::{Attribute, Comparison, Predicate};
use crate::bounds::Bounds;
use crate::clip::Expression;
use crate::text_reader::{ShapeTree, TextReader, joined, number};
use rara_base::error::{Error, Result};

/// The attributes that every Gaussian has.
const ATTRIBUTES: [(&str, Attribute); 6] = [
    ("opacity", Attribute::Opacity),
    ("size", Attribute::Size),
    ("cluster_size", Attribute::ClusterSize),
    ("red", Attribute::Red),
    ("green", Attribute::Green),
    ("blue", Attribute::Blue),
];

/// The words that are no names of properties by themselves.
const WORDS: [&str; 6] = ["and", "or", "not", "in", "inside", "property"];

/// The signs of comparisons; of two that begin alike the longer comes first.
const SIGNS: [(&str, Comparison); 6] = [
    ("<=", Comparison::LessOrEqual),
    (">=", Comparison::GreaterOrEqual),
    ("!=", Comparison::NotEqual),
    ("<", Comparison::Less),
    (">", Comparison::Greater),
    ("=", Comparison::Equal),
];

/// What is wrong with a word that is no name.
const NO_PREDICATE: &str = "a predicate is missing; give one like opacity>0.5, size<0.01, red>0.6, label in 3,4 or \
                            inside(sphere:0,0,0,1)";

fn is_of_name(letter: char) -> bool {
    !letter.is_whitespace() && !"()<>=!,".contains(letter)
}

/// The attribute that a word is, if it is one without `property( )` around it.
fn attribute(word: &str) -> Option<Attribute> {
    let begins_number = word.starts_with(|letter: char| letter.is_ascii_digit());
    let is_name = !word.is_empty() && word.chars().all(is_of_name) && !begins_number;
    let known = ATTRIBUTES.into_iter().find(|(name, _)| *name == word);
    match known {
        Some((_, known)) => Some(known),
        None => (is_name && !WORDS.contains(&word)).then(|| Attribute::Property(word.into())),
    }
}

impl FromStr for Predicate {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::read(text, None).map(|(read, _)| read)
    }
}

impl ShapeTree for Predicate {
    fn read(text: &str, bounds: Option<Bounds>) -> Result<(Self, bool)> {
        let reader = TextReader::new("selection", text, is_of_name, bounds);
        reader.all(TextReader::predicate, "join predicates by 'and' or 'or'")
    }
}

/// What predicates are together; a single one is itself.
fn together(mut all: Vec<Predicate>, join: fn(Vec<Predicate>) -> Predicate) -> Predicate {
    match all.len() {
        1 => all.remove(0),
        _ => join(all),
    }
}

impl<'a> TextReader<'a> {
    fn predicate(&mut self) -> Result<Predicate> {
        let any = self.list("or", |reader| {
            let all = reader.list("and", Self::one)?;
            Ok(together(all, Predicate::All))
        })?;
        Ok(together(any, Predicate::Any))
    }

    fn one(&mut self) -> Result<Predicate> {
        if self.takes("not") {
            // Its text has parentheses behind every `not`: they are one level together.
            let one = match self.rest.starts_with('(') {
                true => self.one(),
                false => self.deeper(Self::one),
            };
            return one.map(|one| Predicate::Not(Box::new(one)));
        }
        if self.rest.starts_with('(') {
            return self.enclosed("", "", |reader| reader.deeper(Self::predicate));
        }
        if self.word() == "inside" {
            let what = "a shape or an expression of shapes";
            let (rest, region) = self.argument("inside", what)?;
            let (region, has_shares) = Expression::read(region, self.bounds).map_err(|error| {
                let place = self.place(rest);
                Error::Invalid(format!("inside(...) from {place} on: {error}"))
            })?;
            self.has_shares |= has_shares;
            return Ok(Predicate::Inside(region));
        }
        let attribute = self.attribute()?;
        if self.takes("in") {
            let ranges = self.list(",", |reader| reader.part(reader.word(), range))?;
            return Ok(Predicate::In(attribute, ranges));
        }
        let Some(&(_, comparison)) = SIGNS.iter().find(|(sign, _)| self.takes(sign)) else {
            return self.refuse(
                "a comparison is missing; write one of < <= > >= = != and a number, or in and numbers",
            );
        };
        let compared = self.part(self.word(), number)?;
        Ok(Predicate::Compare(attribute, comparison, compared))
    }

    /// The rest of the text behind a word's parenthesis, and the part that stands in it.
    fn argument(&mut self, word: &str, what: &str) -> Result<(&'a str, &'a str)> {
        self.enclosed(word, what, |reader| {
            Ok((reader.rest, reader.before_closing()))
        })
    }

    fn attribute(&mut self) -> Result<Attribute> {
        let word = self.word();
        if word == "property" {
            let (_, name) = self.argument(word, "a name")?;
            return match name.trim() {
                "" => self.refuse("property( ) has no name in it"),
                name => Ok(Attribute::Property(name.into())),
            };
        }
        self.part(word, |word| {
            attribute(word).ok_or_else(|| Error::Invalid(NO_PREDICATE.into()))
        })
    }
}

/// Both ends of a range, or a number twice.
fn range(text: &str) -> Result<[f64; 2]> {
    let (low, high) = text.split_once("..").unwrap_or((text, text));
    let range = [number(low)?, number(high)?];
    match range[0] <= range[1] {
        true => Ok(range),
        false => Err(Error::Invalid(format!(
            "{low}..{high} holds nothing; put the smaller end first"
        ))),
    }
}

/// The text that it parses from.
impl fmt::Display for Predicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // `and` goes before `or` without parentheses; with them the text would be deeper than the one that was read.
        let operand = |one: &Self| match (self, one) {
            (_, Self::Any(_)) | (Self::All(_), Self::All(_)) => format!("({one})"),
            _ => one.to_string(),
        };
        match self {
            Self::Inside(region) => write!(f, "inside({region})"),
            Self::Compare(attribute, comparison, number) => {
                let sign = SIGNS.iter().find(|(_, known)| known == comparison);
                let sign = sign.map_or("=", |(sign, _)| sign);
                write!(f, "{attribute}{sign}{number}")
            }
            Self::In(attribute, ranges) => {
                let ranges = joined(ranges, ",", |[low, high]| match low == high {
                    true => low.to_string(),
                    false => format!("{low}..{high}"),
                });
                write!(f, "{attribute} in {ranges}")
            }
            Self::All(all) => f.write_str(&joined(all, " and ", operand)),
            Self::Any(any) => f.write_str(&joined(any, " or ", operand)),
            Self::Not(one) => write!(f, "not ({one})"),
        }
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = ATTRIBUTES.iter().find(|(_, attribute)| attribute == self);
        match self {
            Self::Property(name) if attribute(name).as_ref() != Some(self) => {
                write!(f, "property({name})")
            }
            Self::Property(name) => f.write_str(name),
            _ => f.write_str(known.map_or("", |(name, _)| name)),
        }
    }
}

#[cfg(test)]
mod tests;
