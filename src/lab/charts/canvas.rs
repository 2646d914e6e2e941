//! Charts are drawn on a canvas: paper with a title and a legend, text, markers and colours.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rara_reference::maps;

use crate::table::escaped;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Whether it was drawn; a string takes everything.
pub(super) type Drawn = Result<(), Box<dyn Error>>;

pub(super) const WIDTH: i32 = 820;
/// Marks and legends.
pub(super) const SMALL: i32 = 13;
/// Descriptions of axes.
pub(super) const MEDIUM: i32 = 14;
const LARGE: i32 = 18;
pub(super) const MARGIN: i32 = 16;

pub(super) const START: HPos = HPos::Left;
pub(super) const MIDDLE: HPos = HPos::Center;
pub(super) const END: HPos = HPos::Right;

/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// The grey of text that stands behind the data.
pub(super) const FAINT: RGBColor = RGBColor(0x66, 0x66, 0x66);
pub(super) const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
pub(super) const PAPER: RGBColor = WHITE;

/// The colours of Okabe and Ito, "Color Universal Design" (2008), those that stand out on white first; yellow, which does
/// not, is left out.
const SERIES: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x00, 0x00),
];

pub(super) fn series(number: usize) -> RGBColor {
    SERIES[number % SERIES.len()]
}

/// The colour of a value from -1, blue, by 0, nearly white, to 1, red.
pub(super) fn diverging(value: f64) -> RGBColor {
    let strength = value.abs().min(1.0);
    let hue = if value < 0.0 { 250.0 } else { 35.0 };
    let [r, g, b] = maps::oklch(0.97 - 0.45 * strength, 0.15 * strength, hue);
    RGBColor(r, g, b)
}

/// A colour that text can have on paper.
pub(super) fn darker(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let [r, g, b] = [r, g, b].map(|c| (u16::from(c) * 7 / 10) as u8);
    RGBColor(r, g, b)
}

/// What is read well on a colour.
pub(super) fn on(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let brightness = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
    if brightness > 128.0 { INK } else { PAPER }
}

/// Draws a chart with a title and a legend of these names; `draw` gets the height at which they end.
pub(super) fn chart<'n>(
    title: &str,
    names: impl IntoIterator<Item = &'n String>,
    height: i32,
    draw: impl FnOnce(&Area<'_>, i32) -> Drawn,
) -> String {
    let mut svg = String::new();
    let drawn = (|| {
        let size = (WIDTH as u32, height as u32);
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        canvas.fill(&PAPER)?;
        let mut y = 0;
        for line in wrapped(title, WIDTH - 2 * MARGIN, LARGE) {
            y += 22;
            let mut bold = style(LARGE, INK).pos(Pos::new(START, VPos::Center));
            bold.font = bold.font.style(FontStyle::Bold);
            canvas.draw_text(&line, &bold, (MARGIN, y))?;
        }
        y += legend(&canvas, names, y + 28)?;
        draw(&canvas, y + 32)?;
        canvas.present()?;
        drop(canvas);
        Drawn::Ok(())
    })();
    drawn.expect("a string takes everything that is drawn");
    // What screen readers say of it.
    let named = format!("<svg role=\"img\" aria-label=\"{}\"", escaped(title));
    let mut svg = svg.replacen("<svg", &named, 1);
    // What XML does not allow.
    svg.retain(|c| c == '\n' || !(c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')));
    svg
}

/// Draws the markers and names of series in rows and returns how high they are; without names there is nothing.
fn legend<'n>(
    canvas: &Area<'_>,
    names: impl IntoIterator<Item = &'n String>,
    top: i32,
) -> Result<i32, Box<dyn Error>> {
    let (mut x, mut height) = (MARGIN, 0);
    for (number, name) in names.into_iter().enumerate() {
        let wide = width_of(name, SMALL) + 40;
        if height == 0 || x + wide > WIDTH {
            (x, height) = (MARGIN, height + 20);
        }
        let y = top + height - 20;
        mark(canvas, number, (x + 10, y))?;
        write(canvas, name, (x + 22, y), START, INK)?;
        x += wide;
    }
    Ok(height)
}

pub(super) fn style(size: i32, colour: RGBColor) -> TextStyle<'static> {
    // What SVG viewers have; plotters divides the size by 1.24.
    const SANS: &str = "system-ui, 'DejaVu Sans', 'Liberation Sans', Arial, sans-serif";
    (SANS, f64::from(size) * 1.24).into_font().color(&colour)
}

/// Writes a small line of text whose middle is at the height of `at`.
pub(super) fn write(
    canvas: &Area<'_>,
    text: &str,
    at: (i32, i32),
    anchor: HPos,
    colour: RGBColor,
) -> Drawn {
    let style = style(SMALL, colour).pos(Pos::new(anchor, VPos::Center));
    Ok(canvas.draw_text(text, &style, at)?)
}

/// How wide a text is at most, about; no font is asked.
pub(super) fn width_of(text: &str, size: i32) -> i32 {
    text.chars().count() as i32 * size * 3 / 5
}

/// Text in lines of at most this width where its spaces allow; at least one.
pub(super) fn wrapped(text: &str, width: i32, size: i32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("at least one line");
        if line.is_empty() {
            line.push_str(word);
        } else if width_of(&format!("{line} {word}"), size) <= width {
            line.extend([" ", word]);
        } else {
            lines.push(word.into());
        }
    }
    lines
}

/// Draws the marker of a series: shapes differ as well as colours.
pub(super) fn mark(canvas: &Area<'_>, number: usize, (x, y): (i32, i32)) -> Drawn {
    let filled = series(number).filled();
    let corners: &[(i32, i32)] = match number % 5 {
        0 => return Ok(canvas.draw(&Circle::new((x, y), 5, filled))?),
        1 => &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        2 => &[(0, -7), (6, 5), (-6, 5)],
        3 => &[(0, -7), (7, 0), (0, 7), (-7, 0)],
        _ => &[(0, 7), (6, -5), (-6, -5)],
    };
    let corners = corners.iter().map(|(dx, dy)| (x + dx, y + dy));
    Ok(canvas.draw(&Polygon::new(corners.collect::<Vec<_>>(), filled))?)
}
