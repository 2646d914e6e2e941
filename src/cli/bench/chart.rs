//! The choices as points, ms across and error (L1, logarithmic) up: one list of shapes, written as SVG and as PNG.

use std::fmt::Write as _;
use std::path::Path;

use rara::{Picture, Result};

use super::{Report, output};
use crate::ink;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 720.0;
/// The plot's own rectangle: left, top, right, bottom.
const PLOT: [f64; 4] = [90.0, 50.0, 890.0, 650.0];
const BLACK: [u8; 3] = [20, 20, 20];
const GREY: [u8; 3] = [150, 150, 150];
const PALE: [u8; 3] = [228, 228, 228];
const RED: [u8; 3] = [200, 40, 30];

/// An element of a chart; coordinates in pixels from the top left.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Mark {
    Line([f64; 2], [f64; 2], [u8; 3]),
    Dot([f64; 2], f64, [u8; 3]),
    /// A text and its middle left.
    Text([f64; 2], String, [u8; 3]),
}

/// Writes `pareto.svg` and `pareto.png` into a folder.
pub(super) fn write(folder: &Path, report: &Report) -> Result<()> {
    let shapes = shapes(report);
    output::text(&folder.join("pareto.svg"), &svg(&shapes))?;
    png(&shapes).save(folder.join("pareto.png"))
}

fn shapes(report: &Report) -> Vec<Mark> {
    // The unclipped scene is left out, since it is no cut.
    let rows: Vec<_> = report
        .rows
        .iter()
        .filter(|row| row.name != "none")
        .collect();
    let points: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.times.cost, row.measures.l1.max(1e-7)])
        .collect();
    let most = points.iter().map(|p| p[0]).fold(0.0, f64::max).max(1e-3);
    let decades =
        |pick: fn(f64, f64) -> f64, from: f64| points.iter().map(|p| p[1].log10()).fold(from, pick);
    let low = decades(f64::min, f64::INFINITY).floor();
    let high = decades(f64::max, f64::NEG_INFINITY).ceil();
    let (low, high) = if low < high { (low, high) } else { (-3.0, 1.0) };
    let [left, top, right, bottom] = PLOT;
    let step = tick(most);
    let end = (most / step).ceil() * step;
    let x = |ms: f64| left + (right - left) * ms / end;
    let y = |log: f64| bottom - (bottom - top) * (log - low) / (high - low);

    let title = format!("{}, {}x{}", report.scene, report.size[0], report.size[1]);
    let mut shapes = vec![
        Mark::Text([left + 100.0, 25.0], title, BLACK),
        Mark::Text(
            [left + 300.0, bottom + 50.0],
            "ms a frame, the least".into(),
            BLACK,
        ),
        Mark::Text([5.0, top - 25.0], "L1 of 255".into(), BLACK),
    ];
    let mut ms = 0.0;
    while ms <= end * 1.0001 {
        shapes.push(Mark::Line([x(ms), top], [x(ms), bottom], PALE));
        shapes.push(Mark::Text([x(ms) - 12.0, bottom + 20.0], number(ms), BLACK));
        ms += step;
    }
    for decade in low as i32..=high as i32 {
        let at = y(decade.into());
        shapes.push(Mark::Line([left, at], [right, at], PALE));
        shapes.push(Mark::Text([10.0, at], number(10.0_f64.powi(decade)), BLACK));
    }
    shapes.push(Mark::Line([left, bottom], [right, bottom], BLACK));
    shapes.push(Mark::Line([left, top], [left, bottom], BLACK));

    // The front as a staircase: nothing lies below and to its left.
    let mut best: Vec<[f64; 2]> = rows
        .iter()
        .zip(&points)
        .filter(|(row, _)| row.undominated)
        .map(|(_, p)| [x(p[0]), y(p[1].log10())])
        .collect();
    best.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for pair in best.windows(2) {
        let corner = [pair[1][0], pair[0][1]];
        shapes.push(Mark::Line(pair[0], corner, RED));
        shapes.push(Mark::Line(corner, pair[1], RED));
    }
    for (place, (row, point)) in (1..).zip(rows.iter().zip(&points)) {
        let colour = if row.undominated { RED } else { GREY };
        let at = [x(point[0]), y(point[1].log10())];
        shapes.push(Mark::Dot(at, 4.0, colour));
        shapes.push(Mark::Text(
            [at[0] + 7.0, at[1] - 7.0],
            place.to_string(),
            colour,
        ));
        let entry = [right + 25.0, top + 24.0 * f64::from(place)];
        let text = format!("{place:>2} {}", row.name);
        shapes.push(Mark::Text(
            entry,
            text,
            if row.undominated { RED } else { BLACK },
        ));
    }
    shapes
}

/// The distance of ticks that makes five to ten of them: 1, 2 or 5 times a power of ten.
fn tick(most: f64) -> f64 {
    let power = 10.0_f64.powf((most / 5.0).log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|step| step * power);
    steps
        .into_iter()
        .find(|step| most / step >= 5.0)
        .unwrap_or(power)
}

fn number(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 {
        return format!("{value:.0e}");
    }
    // Ticks are few digits times a power of ten; the conversion removes what rounding has added.
    format!("{}", (value * 1e7).round() / 1e7)
}

fn svg(shapes: &[Mark]) -> String {
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"monospace\" \
         font-size=\"16\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n"
    );
    let hex = |[r, g, b]: &[u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    for shape in shapes {
        let _ = match shape {
            Mark::Line([x1, y1], [x2, y2], colour) => writeln!(
                text,
                "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"{}\"/>",
                hex(colour)
            ),
            Mark::Dot([x, y], radius, colour) => writeln!(
                text,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{}\"/>",
                hex(colour)
            ),
            Mark::Text([x, y], words, colour) => {
                let words = words.replace('&', "&amp;").replace('<', "&lt;");
                writeln!(
                    text,
                    "<text x=\"{x:.1}\" y=\"{:.1}\" fill=\"{}\" xml:space=\"preserve\">{words}</text>",
                    y + 5.0,
                    hex(colour)
                )
            }
        };
    }
    text + "</svg>\n"
}

fn png(shapes: &[Mark]) -> Picture {
    let mut picture = Picture::filled(WIDTH as u32, HEIGHT as u32, [1.0; 4]);
    for shape in shapes {
        match shape {
            Mark::Line(from, to, colour) => ink::line(&mut picture, *from, *to, *colour),
            Mark::Dot(at, radius, colour) => ink::dot(&mut picture, *at, *radius, *colour),
            Mark::Text([x, y], words, colour) => {
                ink::text(
                    &mut picture,
                    [*x, y - 7.0],
                    words,
                    (ink::Font::Small, 2),
                    *colour,
                );
            }
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_five_to_twelve() {
        for most in [0.003, 0.99, 1.0, 7.3, 49.0, 101.0, 640.0] {
            let count = most / tick(most);
            assert!((5.0..=12.5).contains(&count), "{most}: {count}");
        }
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!((number(1e-6), number(0.0)), ("1e-6".into(), "0".into()));
    }

    #[test]
    fn shapes_become_both_kinds_of_picture() {
        let shapes = [
            Mark::Line([10.0, 10.0], [50.0, 10.0], RED),
            Mark::Dot([100.0, 100.0], 4.0, BLACK),
            Mark::Text([200.0, 200.0], "a<b".into(), GREY),
        ];
        let text = svg(&shapes);
        assert!(text.contains("M10.0 10.0L50.0 10.0") && text.contains("a&lt;b"));
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
        let picture = png(&shapes);
        assert!(
            picture.at(30, 10)[1] < 0.7,
            "half of a line between two rows"
        );
        assert!(picture.at(100, 100)[0] < 0.2);
        assert_eq!(picture.at(300, 300), [1.0; 4]);
    }
}
