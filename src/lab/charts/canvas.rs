//! What all charts are drawn on: paper with a title, text in known places, markers, and a legend.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::colours::{INK, PAPER, series};

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Whether it was drawn; a string takes everything.
pub(super) type DrawResult = Result<(), Box<dyn Error>>;

pub(super) const WIDTH: u32 = 820;
pub(super) const HEIGHT: u32 = 480;
/// Marks and legends.
pub(super) const SMALL: u32 = 13;
/// Descriptions of axes.
pub(super) const MEDIUM: u32 = 14;
const LARGE: u32 = 18;
/// What SVG viewers have; plotters writes it into each text.
const SANS: &str = "system-ui, 'DejaVu Sans', 'Liberation Sans', Arial, sans-serif";
/// plotters divides the size of text by this.
const PLOTTERS: f64 = 1.24;
const MARGIN: i32 = 16;

/// Draws a chart of this size with a title; `draw` gets what is below it.
pub(super) fn chart(
    title: &str,
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> DrawResult,
) -> String {
    let mut svg = String::new();
    let drawn = (|| {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&PAPER)?;
        let lines = wrapped(title, size.0 as i32 - 2 * MARGIN, LARGE);
        for (line, text) in (0..).zip(&lines) {
            write_bold(&root, text, (MARGIN, 22 + 22 * line))?;
        }
        draw(&root.margin(18 + 22 * lines.len() as i32, MARGIN, MARGIN, MARGIN))?;
        root.present()?;
        drop(root);
        DrawResult::Ok(())
    })();
    drawn.expect("a string takes everything that is drawn");
    // What screen readers say of it.
    let mut named = String::from("<svg role=\"img\" aria-label=\"");
    named.extend(clean(title).chars().map(|c| match c {
        '<' | '>' | '&' | '"' => ' ',
        c => c,
    }));
    svg.replacen("<svg", &(named + "\""), 1)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Text without what XML does not allow.
fn clean(text: &str) -> String {
    let allowed = |&c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().filter(allowed).collect()
}

pub(super) fn style(size: u32, colour: RGBColor) -> TextStyle<'static> {
    let font = (SANS, f64::from(size) * PLOTTERS).into_font();
    TextStyle {
        color: colour.to_backend_color(),
        ..font.into()
    }
}

/// Writes a line of text whose middle is at the height of `at`.
pub(super) fn write(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    anchor: Anchor,
    size: u32,
    colour: RGBColor,
) -> DrawResult {
    let across = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    put(area, text, at, across, style(size, colour))
}

fn put(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    across: HPos,
    style: TextStyle<'static>,
) -> DrawResult {
    let style = style.pos(Pos::new(across, VPos::Center));
    area.draw(&Text::new(clean(text), at, style))?;
    Ok(())
}

fn write_bold(area: &Area<'_>, text: &str, at: (i32, i32)) -> DrawResult {
    let mut style = style(LARGE, INK);
    style.font = style.font.style(FontStyle::Bold);
    put(area, text, at, HPos::Left, style)
}

/// How wide a text is at most, about; no font is asked.
pub(super) fn width_of(text: &str, size: u32) -> i32 {
    (text.chars().count() as f64 * f64::from(size) * 0.6).ceil() as i32
}

/// Text in lines of at most this width where its spaces allow; at least one.
pub(super) fn wrapped(text: &str, width: i32, size: u32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("at least one line");
        if line.is_empty() {
            line.push_str(word);
        } else if width_of(line, size) + width_of(word, size) + width_of(" ", size) <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.into());
        }
    }
    lines
}

/// Writes text in lines around the height of `at`.
pub(super) fn write_wrapped(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    anchor: Anchor,
    width: i32,
) -> DrawResult {
    let lines = wrapped(text, width, SMALL);
    let height = SMALL as i32 + 3;
    let first = at.1 - height * (lines.len() as i32 - 1) / 2;
    for (line, text) in (0..).zip(&lines) {
        write(
            area,
            text,
            (at.0, first + height * line),
            anchor,
            SMALL,
            INK,
        )?;
    }
    Ok(())
}

/// The marker of a series, by its number: shapes differ as well as colours.
pub(super) fn mark(area: &Area<'_>, number: usize, (x, y): (i32, i32)) -> DrawResult {
    let filled = series(number).filled();
    let polygon = |corners: &[(i32, i32)]| {
        let corners = corners.iter().map(|(dx, dy)| (x + dx, y + dy));
        area.draw(&Polygon::new(corners.collect::<Vec<_>>(), filled))
    };
    match number % 5 {
        0 => area.draw(&Circle::new((x, y), 5, filled))?,
        1 => polygon(&[(-5, -5), (5, -5), (5, 5), (-5, 5)])?,
        2 => polygon(&[(0, -7), (6, 5), (-6, 5)])?,
        3 => polygon(&[(0, -7), (7, 0), (0, 7), (-7, 0)])?,
        _ => polygon(&[(0, 7), (6, -5), (-6, -5)])?,
    }
    Ok(())
}

/// What stands before a name in a legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Key {
    Mark,
    Line,
}

/// Draws a legend over the top of an area and returns what is below it; a single series without a name has none.
pub(super) fn legend<'a>(
    area: &Area<'a>,
    key: Key,
    names: &[&str],
) -> Result<Area<'a>, Box<dyn Error>> {
    if names.iter().all(|name| name.is_empty()) {
        return Ok(area.clone());
    }
    let width = area.dim_in_pixel().0 as i32;
    let (mut x, mut y) = (0, 12);
    for (number, name) in names.iter().enumerate() {
        let wide = 36 + width_of(name, SMALL) + 16;
        if x > 0 && x + wide > width {
            (x, y) = (0, y + 20);
        }
        match key {
            Key::Mark => mark(area, number, (x + 20, y))?,
            Key::Line => {
                let line = series(number).stroke_width(2);
                area.draw(&PathElement::new(vec![(x + 6, y), (x + 34, y)], line))?;
                mark(area, number, (x + 20, y))?;
            }
        }
        let after = if key == Key::Line { 40 } else { 34 };
        write(area, name, (x + after, y), Anchor::Start, SMALL, INK)?;
        x += wide;
    }
    Ok(area.margin(y + 18, 0, 0, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_wrapped_at_its_spaces_and_a_long_word_stays() {
        assert_eq!(
            wrapped("Topological integrity", 100, 13),
            ["Topological", "integrity"]
        );
        assert_eq!(
            wrapped("Topological integrity", 500, 13),
            ["Topological integrity"]
        );
        assert_eq!(
            wrapped("Donaudampfschifffahrt", 10, 13),
            ["Donaudampfschifffahrt"]
        );
        assert_eq!(wrapped("", 10, 13), [""]);
    }
}
