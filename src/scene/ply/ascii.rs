//! The ascii payload: one element a line; blank lines are skipped, and every message has the number of its line.

use std::io::{BufRead, BufReader, Read};
use std::ops::Range;

use super::header::PlyHeader;
use super::layout::{Field, Layout};
use crate::assemble::{Assembler, GaussianRow, ROWS};
use crate::failure::Failure;
use crate::input::Progress;
use rara_base::counted::counted;
use rara_base::error::shortened;

/// A Gaussian takes about 1 kB; a longer line than this is not text at all.
const MAX_LINE: u64 = 4 << 20;

struct Lines<R> {
    reader: BufReader<R>,
    line: Vec<u8>,
    /// Number of the line in `line`, counted from 1 at the top of the file.
    number: u64,
    left: u64,
    end: u8,
}

/// Reads the payload that begins at `source`'s position into `assembler`; `left` bytes remain of it there.
pub(super) fn read<R: Read>(
    source: R,
    left: u64,
    header: &PlyHeader,
    layout: &Layout<'_>,
    assembler: &mut Assembler,
    progress: &mut Progress<'_>,
) -> Result<(), Failure> {
    let mut lines = Lines {
        reader: BufReader::with_capacity(1 << 20, source),
        line: Vec::new(),
        number: header.lines,
        left,
        end: header.line_end,
    };
    for element in layout.before {
        for index in 0..element.count {
            lines.next(|| format!("`{}` element {index} of {}", element.name, element.count))?;
        }
    }
    // What is wrong with a line is said after what is wrong with the lines before it.
    let mut ended = None;
    let read = |numbers: Range<u64>| {
        if let Some(failure) = ended.take() {
            return Err(failure);
        }
        let mut read = Vec::new();
        for number in numbers {
            match lines.next(|| format!("Gaussian {number} of {}", layout.count)) {
                Ok(()) => read.push((lines.number, lines.line.clone())),
                Err(failure) => {
                    ended = Some(failure);
                    break;
                }
            }
        }
        progress.left(lines.left);
        Ok(read)
    };
    assembler.read(ROWS, read, |lines, rows| {
        let mut row = layout.row();
        for (number, line) in lines {
            parse(&line, &layout.fields, &mut row)
                .map_err(|what| Failure::Format(format!("line {number}: {what}")))?;
            rows.push(&row);
        }
        Ok(())
    })?;
    if let Some(failure) = ended {
        return Err(failure);
    }
    // Only what follows the last declared element is trailing, and only if it says something.
    if layout.after == Some(0) {
        let after = lines.left;
        if lines.next(String::new).is_ok() {
            assembler.report.trailing_bytes = after;
        }
    }
    Ok(())
}

impl<R: Read> Lines<R> {
    /// The next line that is not blank, into `self.line`; `what` names the thing it must hold.
    fn next(&mut self, what: impl Fn() -> String) -> Result<(), Failure> {
        loop {
            self.line.clear();
            let mut limited = (&mut self.reader).take(MAX_LINE);
            let read = limited.read_until(self.end, &mut self.line)? as u64;
            self.left = self.left.saturating_sub(read);
            self.number += 1;
            let number = self.number;
            if read == 0 {
                return Err(Failure::Format(format!(
                    "line {number}: the file ends where {} should stand; it is cut off, get it again",
                    what()
                )));
            }
            if read == MAX_LINE && self.line.last() != Some(&self.end) {
                return Err(Failure::Format(format!(
                    "line {number} is longer than {MAX_LINE} bytes; this is not an ascii PLY; export the scene again"
                )));
            }
            if !self.line.trim_ascii().is_empty() {
                return Ok(());
            }
        }
    }
}

/// Splits a line into the numbers of a row.
fn parse(line: &[u8], fields: &[Field], row: &mut GaussianRow) -> Result<(), String> {
    let mut words = line
        .split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty());
    let mut next = || {
        words.next().ok_or_else(|| {
            format!(
                "too few numbers, the header declares {}; export the scene again",
                counted(fields.len(), "property")
            )
        })
    };
    for field in fields {
        match *field {
            // The text is skipped unread, since an extra property may hold anything.
            Field::Scalar(_, None) => {
                next()?;
            }
            Field::Scalar(_, Some(slot)) => row[slot] = number(next()?)?,
            Field::List(..) => {
                let items = number(next()?)?;
                if !(items >= 0.0 && items.fract() == 0.0) {
                    return Err(format!(
                        "{items} cannot be the length of a list; export the scene again"
                    ));
                }
                // The loop ends with the line at the latest, whatever the length says.
                for _ in 0..items as u64 {
                    next()?;
                }
            }
        }
    }
    match words.next() {
        None => Ok(()),
        Some(_) => Err(format!(
            "more numbers than the {} declared properties; export the scene again",
            fields.len()
        )),
    }
}

fn number(word: &[u8]) -> Result<f64, String> {
    let text = std::str::from_utf8(word).unwrap_or_default();
    // Windows prints NaN as nan(ind) and nan(snan).
    let plain = text.split('(').next().unwrap_or(text);
    let error = |_| {
        let word = String::from_utf8_lossy(word);
        format!(
            "\"{}\" is not a number; export the scene again",
            shortened(&word)
        )
    };
    plain.parse().map_err(error)
}
