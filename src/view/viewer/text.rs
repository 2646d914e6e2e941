//! Text on small opaque pictures, which the window lays over its own.

use rara::Picture;

use rara_scene::picture::ink::{self, Font};

const PAPER: [u8; 3] = [22, 25, 30];
const INK: [u8; 3] = [225, 228, 232];
const TRACK: [u8; 3] = [60, 66, 75];
const FILLED: [u8; 3] = [64, 179, 255];
/// What has failed.
pub(super) const WARNING: [u8; 3] = [255, 190, 120];

/// Dots between the paper's edge and the text.
const MARGIN: u32 = 6;
/// Dots that a progress bar is high.
const BAR: u32 = 6;
/// The share of a bar that moves where nobody knows how much is done.
const RUNNER: f64 = 0.2;

/// How text is set: one font, whose dots are squares of so many pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Type {
    small: bool,
    dot: u32,
}

impl Type {
    /// The type for a screen on which a length that was once a pixel has so many.
    pub(super) fn new(scale_factor: f64) -> Self {
        Self {
            small: false,
            dot: (scale_factor.round() as u32).clamp(1, 8),
        }
    }

    /// The largest of this type and smaller ones in which so many columns and lines fit into these pixels; else the smallest.
    fn fitting(self, (columns, lines): (usize, usize), room: (u32, u32)) -> Self {
        let sizes = (1..=self.dot).rev();
        let mut all = sizes.flat_map(|dot| [false, true].map(|small| Self { small, dot }));
        let fits = |this: &Self| {
            let (width, height) = this.size(columns, lines);
            width <= room.0 && height <= room.1
        };
        all.find(fits).unwrap_or(Self {
            small: true,
            dot: 1,
        })
    }

    /// The pixels of a letter and what is between it and the next, and of a line.
    fn letter(self) -> (u32, u32) {
        let (width, height) = if self.small { (6, 12) } else { (8, 16) };
        (self.dot * width, self.dot * height)
    }

    /// The pixels of a paper with so many columns and lines of text.
    fn size(self, columns: usize, lines: usize) -> (u32, u32) {
        let (width, height) = self.letter();
        let all = |count: usize, of: u32| {
            let count = u32::try_from(count).unwrap_or(u32::MAX);
            count
                .saturating_mul(of)
                .saturating_add(2 * MARGIN * self.dot)
        };
        (all(columns, width), all(lines, height))
    }

    /// The columns of a paper that is so many pixels wide; at least one.
    pub(super) fn columns(self, width: u32) -> usize {
        let room = width.saturating_sub(2 * MARGIN * self.dot);
        (room / self.letter().0).max(1) as usize
    }

    fn write(self, paper: &mut Picture, line: usize, text: &str, colour: [u8; 3]) {
        let font = if self.small {
            Font::Small
        } else {
            Font::Middle
        };
        let margin = MARGIN * self.dot;
        // Letters stand in the middle of their line.
        let top = margin + line as u32 * self.letter().1 + 2 * self.dot;
        let at = [f64::from(margin), f64::from(top)];
        ink::text(paper, at, text, (font, self.dot.into()), colour);
    }
}

/// Lines of text on a paper that holds them, of a smaller type where there is no room for them in this one. Of what does not
/// fit then the beginning is there.
pub(super) fn sheet(
    lines: &[String],
    of: Type,
    room: (u32, u32),
    colour: Option<[u8; 3]>,
) -> Picture {
    let columns = lines.iter().map(|line| line.chars().count()).max();
    let columns = columns.unwrap_or(0);
    let of = of.fitting((columns, lines.len()), room);
    let mut paper = paper(of.size(columns, lines.len()), room);
    for (number, line) in lines.iter().enumerate() {
        of.write(&mut paper, number, line, colour.unwrap_or(INK));
    }
    paper
}

/// How far something has come, as a share of it, or the place from 0 to 1 of what moves where nobody knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ProgressBar {
    Share(f64),
    Moving(f64),
}

/// A line of text with a bar below it.
pub(super) fn bar(text: &str, progress: ProgressBar, of: Type, room: (u32, u32)) -> Picture {
    let (width, height) = of.size(text.chars().count().max(40), 1);
    let mut paper = paper((width, height + (BAR + MARGIN) * of.dot), room);
    of.write(&mut paper, 0, text, INK);
    let margin = MARGIN * of.dot;
    let track = paper.width.saturating_sub(2 * margin);
    let along =
        |share: f64| i64::from(margin) + (share.clamp(0.0, 1.0) * f64::from(track)).round() as i64;
    let (from, to) = match progress {
        ProgressBar::Share(share) => (0.0, share),
        ProgressBar::Moving(at) => (at * (1.0 + RUNNER) - RUNNER, at * (1.0 + RUNNER)),
    };
    let rows = height.into()..(height + BAR * of.dot).into();
    ink::fill(&mut paper, [along(0.0)..along(1.0), rows.clone()], TRACK);
    ink::fill(&mut paper, [along(from)..along(to), rows], FILLED);
    paper
}

fn paper((width, height): (u32, u32), room: (u32, u32)) -> Picture {
    let [r, g, b] = PAPER.map(|v| f32::from(v) / 255.0);
    Picture::filled(width.min(room.0), height.min(room.1), [r, g, b, 1.0])
}

/// A text in lines of at most so many columns, broken at blanks, and within words that are longer than a line.
pub(super) fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let columns = columns.max(1);
    let mut lines = Vec::new();
    let (mut line, mut length) = (String::new(), 0);
    for word in text.split_whitespace() {
        let mut word: Vec<char> = word.chars().collect();
        if length > 0 && length + 1 + word.len() <= columns {
            line.push(' ');
            length += 1;
        } else if length > 0 {
            lines.push(std::mem::take(&mut line));
            length = 0;
        }
        while word.len() > columns {
            let rest = word.split_off(columns);
            lines.push(word.into_iter().collect());
            word = rest;
        }
        length += word.len();
        line.extend(word);
    }
    if length > 0 {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests;
