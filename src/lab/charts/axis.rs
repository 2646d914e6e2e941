//! Axes: what stands beside them, how values lie along them, and where their marks are.

use std::error::Error;
use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::canvas::{
    self, Area, FAINT, GRID, INK, MARGIN, MEDIUM, PAPER, SMALL, WIDTH, style, width_of,
};

#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it measures, and in which unit: "Time (ms)".
    pub label: String,
    /// Values lie by their logarithms. Zeros lie at a mark of their own before a break; negative values are missing.
    pub is_log: bool,
    /// The ends of the axis, on which values beyond them lie; `None` is as far as the values.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            is_log: false,
            range: None,
        }
    }

    pub fn log(label: impl Into<String>) -> Self {
        Self {
            is_log: true,
            ..Self::linear(label)
        }
    }

    pub fn between(self, low: f64, high: f64) -> Self {
        Self {
            range: Some([low, high]),
            ..self
        }
    }

    /// Where a value lies: its logarithm or itself, unless lengths of axes with it could be infinite.
    fn place(&self, value: f64) -> Option<f64> {
        let place = if self.is_log { value.log10() } else { value };
        Some(place).filter(|place| place.abs() <= 1e300)
    }

    /// The axis as these values need it.
    pub(super) fn span(&self, values: impl IntoIterator<Item = f64>) -> Span {
        let values: Vec<f64> = values.into_iter().collect();
        let has_zeros = self.is_log && values.contains(&0.0);
        let is_fixed = self.range.is_some();
        let shown = self.range.map_or(values, Vec::from);
        let places: Vec<f64> = shown.into_iter().filter_map(|v| self.place(v)).collect();
        let low = places.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let high = places.iter().copied().reduce(f64::max).unwrap_or(1.0);
        let margin = match high - low {
            none if none <= 1e-9 * high.abs().max(low.abs()) => {
                let is_relative = !self.is_log && low.abs() > 1e-9;
                if is_relative { low.abs() / 2.0 } else { 0.5 }
            }
            length if self.is_log && !is_fixed => (0.06 * length).max(0.1),
            _ => 0.0,
        };
        let (mut low, mut high) = (low - margin, high + margin);
        let steps = |low: f64, high: f64| RangedCoordf64::from(low..high).key_points(9);
        let marks = if self.is_log {
            powers(low, high)
        } else {
            // To a whole number of steps, so that a mark is at both ends.
            if let (false, [first, second, ..]) = (is_fixed, &steps(low, high)[..]) {
                let step = second - first;
                (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
            }
            steps(low, high)
        };
        let value = |mark: f64| if self.is_log { 10_f64.powf(mark) } else { mark };
        let marks = marks.into_iter().map(|mark| (mark, number(value(mark))));
        let mut span = Span {
            axis: self.clone(),
            ends: [low, high],
            zeros: None,
            marks: marks.collect(),
        };
        if has_zeros {
            let step = 0.06 * (high - low);
            span.ends[0] = low - 2.0 * step;
            span.zeros = Some(low - step);
            span.marks.push((low - step, number(0.0)));
        }
        span
    }
}

/// The logarithms of powers of ten, and of multiples of them where there are few.
fn powers(low: f64, high: f64) -> Vec<f64> {
    let parts: &[f64] = match high - low {
        few if few < 0.7 => &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
        few if few < 3.0 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let every = ((high - low) / 8.0).ceil().max(1.0) as usize;
    let powers = (low.floor() as i32..=high.ceil() as i32).step_by(every);
    let marks = powers.flat_map(|power| parts.iter().map(move |p| f64::from(power) + p.log10()));
    let within = low - 1e-9..=high + 1e-9;
    marks.filter(|mark| within.contains(mark)).collect()
}

/// A number with at most six digits, and with a power of ten where it would be long.
pub(super) fn number(value: f64) -> String {
    let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let text = match short.abs() {
        0.0 => "0".into(), // also -0
        1e-4..1e6 => short.to_string(),
        _ => format!("{short:e}"),
    };
    text.replace('-', "\u{2212}")
}

/// An axis from its lowest place to its highest one.
#[derive(Debug, Clone)]
pub(super) struct Span {
    axis: Axis,
    pub(super) ends: [f64; 2],
    /// The place of zeros on an axis of logarithms that needs one.
    zeros: Option<f64>,
    /// Places and what stands at them.
    pub(super) marks: Vec<(f64, String)>,
}

impl Span {
    /// An axis of categories, whose middles are at 0.5, 1.5 and so on.
    pub(super) fn of_categories<'a>(label: &str, names: impl Iterator<Item = &'a String>) -> Self {
        let middles = (0..).map(|number| f64::from(number) + 0.5);
        let marks: Vec<_> = middles.zip(names.cloned()).collect();
        Self {
            axis: Axis::linear(label),
            ends: [0.0, marks.len().max(1) as f64],
            zeros: None,
            marks,
        }
    }

    /// The place of a value; `None` where it is missing.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        if value == 0.0 && self.zeros.is_some() {
            return self.zeros;
        }
        let [low, high] = self.ends;
        Some(self.axis.place(value)?.clamp(low, high))
    }

    /// The place between zeros and everything else.
    pub(super) fn breaks(&self) -> Option<f64> {
        Some(2.0 * self.zeros? - self.ends[0])
    }
}

impl Ranged for Span {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, pixels: (i32, i32)) -> i32 {
        RangedCoordf64::from(self.range()).map(place, pixels)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let marks = self.marks.iter().map(|mark| mark.0);
        let is_bold = !hint.weight().allow_light_points();
        marks.filter(|_| is_bold).collect()
    }

    fn range(&self) -> Range<f64> {
        self.ends[0]..self.ends[1]
    }
}

impl ValueFormatter<f64> for Span {
    fn format_ext(&self, place: &f64) -> String {
        let mark = self.marks.iter().find(|mark| mark.0 == *place);
        mark.map_or(String::new(), |mark| mark.1.clone())
    }
}

pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Span, Span>>;

/// Draws two axes in these rows of a canvas and returns what takes places along them.
pub(super) fn axes<'a>(
    canvas: &Area<'a>,
    rows: Range<i32>,
    x: &Span,
    y: &Span,
) -> Result<Chart<'a>, Box<dyn Error>> {
    let height = canvas.dim_in_pixel().1 as i32;
    let names = y.marks.iter().map(|mark| width_of(&mark.1, SMALL));
    let left = 46 + names.max().unwrap_or(0).min(WIDTH / 3);
    let column = (WIDTH - left - 3 * MARGIN) / x.marks.len().max(1) as i32;
    let lines = |text: &str| canvas::wrapped(text, column, SMALL);
    let most = x.marks.iter().map(|mark| lines(&mark.1).len()).max();
    let mut chart = ChartBuilder::on(canvas)
        .margin(MARGIN)
        .margin_right(2 * MARGIN)
        .margin_top(rows.start)
        .margin_bottom(height - rows.end)
        .x_label_area_size(34 + 15 * most.unwrap_or(0) as i32)
        .y_label_area_size(left)
        .build_cartesian_2d(x.clone(), y.clone())?;
    // The first lines; plotters writes no others.
    chart
        .configure_mesh()
        .axis_style(FAINT)
        .bold_line_style(GRID)
        .label_style(style(SMALL, INK))
        .axis_desc_style(style(MEDIUM, INK))
        .x_desc(&x.axis.label)
        .y_desc(&y.axis.label)
        .x_label_formatter(&|place| lines(&x.format_ext(place))[0].clone())
        .draw()?;
    for (place, text) in &x.marks {
        let (x, y) = chart.backend_coord(&(*place, y.ends[0]));
        for (line, text) in (0..).zip(lines(text)).skip(1) {
            canvas::write(canvas, &text, (x, y + 17 + 15 * line), canvas::MIDDLE, INK)?;
        }
    }
    // Breaks go a little beyond the lines of the axes that they are in.
    let breaks = [
        (x.breaks().map(|at| y.ends.map(|end| (at, end))), (0, 6)),
        (y.breaks().map(|at| x.ends.map(|end| (end, at))), (-6, 0)),
    ];
    for (ends, beyond) in breaks {
        let Some(ends) = ends else { continue };
        let [from, to] = ends.map(|end| chart.backend_coord(&end));
        let path = vec![(from.0 + beyond.0, from.1 + beyond.1), to];
        canvas.draw(&PathElement::new(path, PAPER.stroke_width(7)))?;
    }
    Ok(chart)
}
