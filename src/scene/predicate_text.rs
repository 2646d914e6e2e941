//! The text of predicates, as `label in 3,4 and not inside(sphere:0,0,0,1)`.

use std::fmt;
use std::str::FromStr;

use super::predicate::{Attribute, Comparison, Predicate};
use crate::clip::{Expression, Parser};
use rara_base::error::{Error, Result, shortened};

/// How deep parentheses may be nested.
const DEPTH: usize = 48;

/// The attributes that every Gaussian has.
const ATTRIBUTES: [(&str, Attribute); 5] = [
    ("opacity", Attribute::Opacity),
    ("size", Attribute::Size),
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

fn is_of_name(letter: char) -> bool {
    !letter.is_whitespace() && !"()<>=!,".contains(letter)
}

impl FromStr for Predicate {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let mut parser = Parser {
            text,
            at: 0,
            what: "selection",
        };
        let predicate = parser.any(0)?;
        match parser.rest() {
            "" => Ok(predicate),
            rest => Err(parser.error(&format!(
                "'{}' is left over; join predicates by 'and' or 'or'",
                shortened(rest)
            ))),
        }
    }
}

impl<'a> Parser<'a> {
    /// The name or the number that is next; it may be empty.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|letter| !is_of_name(letter));
        &rest[..end.unwrap_or(rest.len())]
    }

    fn takes_word(&mut self, word: &str) -> bool {
        let takes = self.word() == word;
        self.at += if takes { word.len() } else { 0 };
        takes
    }

    fn any(&mut self, depth: usize) -> Result<Predicate> {
        let mut any = vec![self.all(depth)?];
        while self.takes_word("or") {
            any.push(self.all(depth)?);
        }
        Ok(match any.len() {
            1 => any.remove(0),
            _ => Predicate::Any(any),
        })
    }

    fn all(&mut self, depth: usize) -> Result<Predicate> {
        let mut all = vec![self.one(depth)?];
        while self.takes_word("and") {
            all.push(self.one(depth)?);
        }
        Ok(match all.len() {
            1 => all.remove(0),
            _ => Predicate::All(all),
        })
    }

    fn one(&mut self, depth: usize) -> Result<Predicate> {
        if depth > DEPTH {
            return Err(self.error(&format!("it is nested deeper than {DEPTH} levels")));
        }
        if self.takes_word("not") {
            return Ok(Predicate::Not(Box::new(self.one(depth + 1)?)));
        }
        if self.takes("(") {
            let predicate = self.any(depth + 1)?;
            return match self.takes(")") {
                true => Ok(predicate),
                false => Err(self.error("a ) is missing")),
            };
        }
        if self.word() == "inside" {
            let (at, text) = self.argument("inside", "a shape or an expression of shapes")?;
            let region = text.parse::<Expression>().map_err(|error| {
                let column = self.text[..at].chars().count() + 1;
                Error::Invalid(format!(
                    "inside(...) from column {column} of the selection on: {error}"
                ))
            });
            return region.map(Predicate::Inside);
        }
        let attribute = self.attribute()?;
        if self.takes_word("in") {
            return self.ranges().map(|ranges| Predicate::In(attribute, ranges));
        }
        let Some(&(_, comparison)) = SIGNS.iter().find(|(sign, _)| self.takes(sign)) else {
            return Err(self.error(
                "a comparison is missing; write one of < <= > >= = != and a number, or in and numbers",
            ));
        };
        let number = self.word();
        let compared = self.number(number)?;
        self.at += number.len();
        Ok(Predicate::Compare(attribute, comparison, compared))
    }

    /// What stands in the parentheses behind a word, and where.
    fn argument(&mut self, word: &str, what: &str) -> Result<(usize, &'a str)> {
        self.at += word.len();
        if !self.takes("(") {
            return Err(self.error(&format!("{word} needs {what} in ( )")));
        }
        let start = self.at;
        let mut open = 1;
        for (at, letter) in self.text[start..].char_indices() {
            open += match letter {
                '(' => 1,
                ')' => -1,
                _ => 0,
            };
            if open == 0 {
                self.at = start + at + 1;
                return Ok((start, &self.text[start..start + at]));
            }
        }
        Err(self.error(&format!("the ) of {word}( is missing")))
    }

    fn attribute(&mut self) -> Result<Attribute> {
        let word = self.word();
        if word == "property" {
            let (_, name) = self.argument("property", "a name")?;
            return match name.trim() {
                "" => Err(self.error("property( ) has no name in it")),
                name => Ok(Attribute::Property(name.into())),
            };
        }
        if word.is_empty()
            || WORDS.contains(&word)
            || word.starts_with(|c: char| c.is_ascii_digit())
        {
            return Err(self.error(
                "a predicate is missing; give one like opacity>0.5, size<0.01, red>0.6, label in 3,4 or \
                 inside(sphere:0,0,0,1)",
            ));
        }
        self.at += word.len();
        let known = ATTRIBUTES.into_iter().find(|(name, _)| *name == word);
        Ok(known.map_or_else(
            || Attribute::Property(word.into()),
            |(_, attribute)| attribute,
        ))
    }

    fn ranges(&mut self) -> Result<Vec<[f64; 2]>> {
        let mut ranges = Vec::new();
        loop {
            let word = self.word();
            let (low, high) = word.split_once("..").unwrap_or((word, word));
            let range = [self.number(low)?, self.number(high)?];
            if range[0] > range[1] {
                return Err(self.error(&format!(
                    "{low}..{high} holds nothing; put the smaller end first"
                )));
            }
            self.at += word.len();
            ranges.push(range);
            if !self.takes(",") {
                return Ok(ranges);
            }
        }
    }

    fn number(&self, text: &str) -> Result<f64> {
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ if text.is_empty() => Err(self.error("a number is missing")),
            _ => Err(self.error(&format!("'{}' is not a finite number", shortened(text)))),
        }
    }
}

/// The text that it parses from.
impl fmt::Display for Predicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |f: &mut fmt::Formatter<'_>, word: &str, operands: &[Self]| {
            for (number, operand) in operands.iter().enumerate() {
                f.write_str(if number > 0 { word } else { "" })?;
                match operand {
                    Self::All(_) | Self::Any(_) => write!(f, "({operand})")?,
                    _ => operand.fmt(f)?,
                }
            }
            Ok(())
        };
        match self {
            Self::Inside(region) => write!(f, "inside({region})"),
            Self::Compare(attribute, comparison, number) => {
                let sign = SIGNS.iter().find(|(_, known)| known == comparison);
                write!(
                    f,
                    "{attribute}{}{number}",
                    sign.map_or("=", |(sign, _)| sign)
                )
            }
            Self::In(attribute, ranges) => {
                write!(f, "{attribute} in ")?;
                for (number, [low, high]) in ranges.iter().enumerate() {
                    f.write_str(if number > 0 { "," } else { "" })?;
                    match low == high {
                        true => write!(f, "{low}")?,
                        false => write!(f, "{low}..{high}")?,
                    }
                }
                Ok(())
            }
            Self::All(all) => list(f, " and ", all),
            Self::Any(any) => list(f, " or ", any),
            Self::Not(one) => write!(f, "not ({one})"),
        }
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Property(name) = self {
            let is_plain = name.chars().all(is_of_name)
                && !name.starts_with(|c: char| c.is_ascii_digit())
                && !WORDS.contains(&name.as_str())
                && ATTRIBUTES.iter().all(|(known, _)| known != name);
            return match is_plain {
                true => f.write_str(name),
                false => write!(f, "property({name})"),
            };
        }
        let name = ATTRIBUTES.iter().find(|(_, attribute)| attribute == self);
        f.write_str(name.map_or("", |(name, _)| name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_with_its_place_and_a_remedy() {
        for (text, words) in [
            ("", "column 1 of the selection: a predicate is missing"),
            ("and opacity>1", "column 1 of the selection: a predicate"),
            (
                "opacity",
                "column 8 of the selection: a comparison is missing",
            ),
            ("opacity>", "column 9 of the selection: a number is missing"),
            ("opacity>half", "'half' is not a finite number"),
            ("opacity>inf", "'inf' is not a finite number"),
            (
                "opacity==1",
                "column 9 of the selection: a number is missing",
            ),
            ("label in", "a number is missing"),
            ("label in 3,", "a number is missing"),
            ("label in 3 4", "'4' is left over; join"),
            ("label in 4..3", "smaller end first"),
            ("label in 4..", "a number is missing"),
            ("(opacity>1", "a ) is missing"),
            ("opacity>1)", "')' is left over"),
            ("inside sphere:0,0,0,1", "inside needs a shape"),
            ("inside(sphere:0,0,0,1", "the ) of inside( is missing"),
            (
                "red>1 and inside(globe:1)",
                "from column 18 of the selection on: column 1 of the clip expression",
            ),
            ("property()>1", "no name in it"),
            ("opacity>1 size<2", "'size<2' is left over"),
            ("3>opacity", "a predicate is missing"),
            ("ä>1 and", "column 8 of"),
        ] {
            let message = text.parse::<Predicate>().unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
        let deep = format!("{}opacity>1{}", "(".repeat(100), ")".repeat(100));
        let message = deep.parse::<Predicate>().unwrap_err().to_string();
        assert!(message.contains("48"), "{message}");
        let deep = format!("{}opacity>1", "not ".repeat(100_000));
        assert!(deep.parse::<Predicate>().is_err());
    }

    #[test]
    fn text_is_what_it_parses_from() {
        for text in [
            "opacity>0.5",
            "label in 3,4,7..9 and not (size<0.01)",
            "(red>0.6 or blue<=0.1) and property(red)!=200",
            "inside(all(box:0,0,0,1,1,1, !sphere:0,0,0,0.5)) or property(in)=1",
            "property(my label)>=-1",
        ] {
            assert_eq!(text.parse::<Predicate>().unwrap().to_string(), text);
        }
    }
}
