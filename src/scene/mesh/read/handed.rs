//! The lines of a text, each put in the form in which another crate reads it, one after the other, so that it is known at which
//! one that fails.

use std::cell::Cell;
use std::io::{BufRead, Read, Result, Seek, SeekFrom};

/// A source of lines that a function makes of those of a text. It is called for each of them with the line and what to write to,
/// and with `None` at the end.
pub(super) struct Handed<'a, F> {
    all: &'a [u8],
    rest: &'a [u8],
    has_ended: bool,
    make: F,
    made: String,
    /// How much of what was made is read.
    read: usize,
    number: &'a Cell<u64>,
}

impl<'a, F: FnMut(Option<&str>, &mut String)> Handed<'a, F> {
    /// The lines of a text. The number of the line that is read last is in a cell, counted from 1.
    pub(super) fn new(all: &'a [u8], number: &'a Cell<u64>, make: F) -> Self {
        Self {
            all,
            rest: all,
            has_ended: false,
            make,
            made: String::new(),
            read: 0,
            number,
        }
    }
}

impl<F: FnMut(Option<&str>, &mut String)> BufRead for Handed<'_, F> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        while self.read == self.made.len() && !self.has_ended {
            self.made.clear();
            self.read = 0;
            if self.rest.is_empty() {
                self.has_ended = true;
                (self.make)(None, &mut self.made);
                break;
            }
            let (line, rest) = first_line(self.rest);
            self.rest = rest;
            self.number.set(self.number.get() + 1);
            match std::str::from_utf8(line) {
                Ok(line) => (self.make)(Some(line), &mut self.made),
                Err(_) => (self.make)(Some(&String::from_utf8_lossy(line)), &mut self.made),
            }
        }
        Ok(&self.made.as_bytes()[self.read..])
    }

    fn consume(&mut self, count: usize) {
        self.read += count;
    }
}

/// A line at most at a time, so that no more lines are counted than are used.
impl<F: FnMut(Option<&str>, &mut String)> Read for Handed<'_, F> {
    fn read(&mut self, to: &mut [u8]) -> Result<usize> {
        let mut from = self.fill_buf()?;
        let count = from.read(to)?;
        self.consume(count);
        Ok(count)
    }
}

/// Back to the start, which is where others seek to.
impl<F: FnMut(Option<&str>, &mut String)> Seek for Handed<'_, F> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        if to != SeekFrom::Start(0) {
            return Err(std::io::ErrorKind::Unsupported.into());
        }
        self.rest = self.all;
        self.has_ended = false;
        self.made.clear();
        self.read = 0;
        self.number.set(0);
        Ok(0)
    }
}

/// The first line of a text, and what follows it. Old files end lines with a carriage return alone, which may be that of a pair.
fn first_line(text: &[u8]) -> (&[u8], &[u8]) {
    let end = text.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    let Some(end) = end else {
        return (text, &[]);
    };
    let rest = &text[end + 1..];
    let behind_pair = rest.strip_prefix(b"\n").filter(|_| text[end] == b'\r');
    (&text[..end], behind_pair.unwrap_or(rest))
}

/// A line of a text, counted from 1, to quote in a message.
pub(super) fn quoted(text: &[u8], number: u64) -> String {
    let mut rest = text;
    for _ in 1..number {
        rest = first_line(rest).1;
    }
    let line = String::from_utf8_lossy(first_line(rest).0);
    rara_base::error::shortened(line.trim())
}
