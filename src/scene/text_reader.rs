//! What the texts of shapes, of clip expressions and of predicates have in common: words and signs, parentheses, lists, numbers,
//! a limit on how deep they are nested, and errors that say where.

use std::fmt;

use crate::bounds::Bounds;
use rara_base::error::{Error, Result, shortened};

/// How deep a text may be nested.
/// A file has an expression twice as deep, of which JSON's reader takes 128 levels.
const DEPTH: usize = 48;

/// What reads a part of a text.
type Read<'a, T> = fn(&mut TextReader<'a>) -> Result<T>;

/// A reader of a text. What there is to be read is said where that is defined.
pub(crate) struct TextReader<'a> {
    text: &'a str,
    /// What the text is called.
    what: &'static str,
    /// Whether a character may be one of a word.
    is_of_word: fn(char) -> bool,
    /// The rest of the text, from its first character that is not blank.
    pub(crate) rest: &'a str,
    depth: usize,
    /// The bounds of the scene at whose shares shapes may lie.
    pub(crate) bounds: Option<Bounds>,
    /// True once a shape lies at shares.
    pub(crate) has_shares: bool,
}

/// A tree with shapes in it, which may lie at shares of a scene.
pub trait ShapeTree: Sized {
    /// Reads a text. The shapes that lie at shares lie at those of the bounds; without bounds none can. Returns true beside the
    /// tree if there is one that does.
    #[doc(hidden)]
    fn read(text: &str, bounds: Option<Bounds>) -> Result<(Self, bool)>;
}

impl<'a> TextReader<'a> {
    /// A reader of a text that is called so, and whose words have such characters.
    pub(crate) fn new(
        what: &'static str,
        text: &'a str,
        is_of_word: fn(char) -> bool,
        bounds: Option<Bounds>,
    ) -> Self {
        Self {
            text: text.trim_end(),
            what,
            is_of_word,
            rest: text.trim(),
            depth: 0,
            bounds,
            has_shares: false,
        }
    }

    /// Reads all of the text; `remedy` says what to do with something behind it.
    pub(crate) fn all<T>(mut self, read: Read<'a, T>, remedy: &str) -> Result<(T, bool)> {
        let read = read(&mut self)?;
        match self.rest {
            "" => Ok((read, self.has_shares)),
            rest => self.refuse(format!("'{}' is left over; {remedy}", shortened(rest))),
        }
    }

    /// The word that is next; it may be empty.
    pub(crate) fn word(&self) -> &'a str {
        let end = self.rest.find(|letter| !(self.is_of_word)(letter));
        &self.rest[..end.unwrap_or(self.rest.len())]
    }

    /// Takes a word or a sign if it is next; a word is not taken from the beginning of a longer one.
    pub(crate) fn takes(&mut self, token: &str) -> bool {
        let word = self.word();
        let takes = word == token || word.is_empty() && self.rest.starts_with(token);
        self.skip(if takes { token } else { "" });
        takes
    }

    fn skip(&mut self, next: &str) {
        self.rest = self.rest[next.len()..].trim_start();
    }

    /// Reads what is next. What is wrong with it is said with the place where it begins.
    pub(crate) fn part<T>(
        &mut self,
        next: &'a str,
        read: impl FnOnce(&'a str) -> Result<T>,
    ) -> Result<T> {
        let read = read(next).or_else(|error| self.refuse(error))?;
        self.skip(next);
        Ok(read)
    }

    /// Things with a word or a sign between them; at least one.
    pub(crate) fn list<T>(&mut self, between: &str, read: Read<'a, T>) -> Result<Vec<T>> {
        let mut list = vec![read(self)?];
        while self.takes(between) {
            list.push(read(self)?);
        }
        Ok(list)
    }

    /// What stands in parentheses behind a word that is next, or behind none, which is "".
    pub(crate) fn enclosed<T>(&mut self, word: &str, what: &str, read: Read<'a, T>) -> Result<T> {
        self.skip(word);
        if !self.takes("(") {
            return self.refuse(format!("{word} needs {what} in ( )"));
        }
        let enclosed = read(self)?;
        match (self.takes(")"), word) {
            (true, _) => Ok(enclosed),
            (false, "") => self.refuse("a ) is missing"),
            (false, _) => self.refuse(format!("the ) of {word}( is missing")),
        }
    }

    /// The text before the parenthesis that closes what is open.
    pub(crate) fn before_closing(&mut self) -> &'a str {
        let mut open = 0;
        let end = self.rest.find(|letter| {
            open += i32::from(letter == '(') - i32::from(letter == ')');
            open < 0
        });
        let before = &self.rest[..end.unwrap_or(self.rest.len())];
        self.skip(before);
        before
    }

    /// Reads what lies a level deeper.
    pub(crate) fn deeper<T>(&mut self, read: Read<'a, T>) -> Result<T> {
        if self.depth == DEPTH {
            return self.refuse(format!("it is nested deeper than {DEPTH} levels"));
        }
        self.depth += 1;
        let read = read(self);
        self.depth -= 1;
        read
    }

    /// The place where a rest of the text begins; columns count from 1.
    pub(crate) fn place(&self, rest: &str) -> String {
        let read = &self.text[..self.text.len() - rest.len()];
        format!("column {} of the {}", read.chars().count() + 1, self.what)
    }

    /// An error at what is next.
    pub(crate) fn refuse<T>(&self, why: impl fmt::Display) -> Result<T> {
        let place = self.place(self.rest);
        Err(Error::Invalid(format!("{place}: {why}")))
    }
}

/// A finite number; blanks around it are allowed.
pub(crate) fn number(text: &str) -> Result<f64> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ if text.trim().is_empty() => Err(Error::Invalid("a number is missing".into())),
        _ => Err(Error::Invalid(format!(
            "'{}' is not a finite number",
            shortened(text)
        ))),
    }
}

/// The text of a list, with another text between its elements.
pub(crate) fn joined<T>(list: &[T], between: &str, text: impl Fn(&T) -> String) -> String {
    list.iter().map(text).collect::<Vec<_>>().join(between)
}
