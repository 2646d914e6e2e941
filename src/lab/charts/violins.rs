use plotters::prelude::*;

use super::canvas::{self, Anchor, Area, HEIGHT, SMALL, WIDTH};
use super::plot::Plot;
use super::{Axis, Scale, Values, colours};
use crate::statistics::{median, standard_deviation};

/// How samples are distributed: as wide as values are frequent, with each value as a dot and the median as a bar.
#[derive(Debug, Clone)]
pub struct Violins {
    pub title: String,
    pub x: String,
    /// Up. Where it has a range, no violin reaches beyond it.
    pub y: Axis,
    pub samples: Vec<Values>,
}

/// The heights at which the density of a violin is computed.
const STEPS: usize = 96;
/// The share of its column that a violin takes.
const WIDE: f64 = 0.84;
/// What it takes at most, in pixels, where there are few of them.
const WIDEST: f64 = 160.0;

impl Violins {
    pub fn svg(&self) -> String {
        let values = self.samples.iter().flat_map(|sample| &sample.values);
        let y = self.y.span(values.copied());
        canvas::chart(&self.title, (WIDTH, HEIGHT), |area| {
            let note =
                "Width: how frequent values are. Dots: the values, moved aside. Bar: their median.";
            canvas::write(area, note, (0, 10), Anchor::Start, SMALL, colours::FAINT)?;
            let area = &area.margin(24, 0, 0, 0);
            let names: Vec<_> = self.samples.iter().map(|s| s.name.as_str()).collect();
            let plot = Plot::of_categories(area, &names, &self.x, (&self.y, y))?;
            for (number, sample) in self.samples.iter().enumerate() {
                let takes = |v: &f64| self.y.takes(*v);
                let values: Vec<f64> = sample.values.iter().copied().filter(takes).collect();
                self.draw_violin(&plot, number, &values)?;
            }
            Ok(())
        })
    }

    fn draw_violin(&self, plot: &Plot<'_>, number: usize, values: &[f64]) -> canvas::DrawResult {
        let Some(median) = median(values) else {
            return Ok(());
        };
        let middle = number as f64 + 0.5;
        let column = f64::from(plot.across(1.0) - plot.across(0.0));
        let wide = WIDE.min(WIDEST / column.max(1.0));
        let colour = colours::series(number);
        let outline = self.outline(values);
        let most = outline.iter().map(|(_, d)| *d).fold(0.0, f64::max);
        let side = |sign: f64| {
            let half = move |density: f64| sign * wide / 2.0 * density / most;
            let at = move |&(value, density): &(f64, f64)| plot.at(middle + half(density), value);
            outline.iter().map(at)
        };
        let shape: Vec<_> = side(1.0).chain(side(-1.0).rev()).collect();
        plot.area
            .draw(&Polygon::new(shape.clone(), colour.mix(0.35).filled()))?;
        let closed = shape
            .iter()
            .chain(shape.first())
            .copied()
            .collect::<Vec<_>>();
        plot.area
            .draw(&PathElement::new(closed, colour.stroke_width(1)))?;
        dots(&plot.area, values, |value, away| {
            plot.at(middle + 0.25 * wide * away, value)
        })?;
        let [left, right] = [-0.3, 0.3].map(|away| plot.at(middle + away * wide, median));
        for (colour, width) in [(colours::PAPER, 8), (colours::INK, 4)] {
            let bar = PathElement::new(vec![left, right], colour.stroke_width(width));
            plot.area.draw(&bar)?;
        }
        Ok(())
    }

    /// The density of values by height, up to a factor: a normal distribution around each value, of Silverman's width, on
    /// the scale of the axis. On logarithms zeros have none.
    fn outline(&self, values: &[f64]) -> Vec<(f64, f64)> {
        let is_log = self.y.scale == Scale::Log;
        let scaled = |v: f64| if is_log { v.log10() } else { v };
        let values: Vec<f64> = values.iter().map(|&v| scaled(v)).collect();
        let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if values.is_empty() {
            return Vec::new();
        }
        let deviation = standard_deviation(&values).filter(|&s| s > 0.0);
        // Equal values get a width that can be seen.
        let deviation = deviation.unwrap_or(high.abs().max(1.0) / 20.0);
        let width = 1.06 * deviation * (values.len() as f64).powf(-0.2);
        // Without a range the axis ends soon after the values.
        let ends = self.y.range.map_or([low, high], |ends| ends.map(scaled));
        let bottom = (low - 2.0 * width).max(ends[0]);
        let top = (high + 2.0 * width).min(ends[1]);
        let density = |at: f64| {
            let weight = |v: &f64| (-0.5 * ((at - v) / width).powi(2)).exp();
            values.iter().map(weight).sum::<f64>().max(1e-9)
        };
        let at = |step: usize| bottom + (top - bottom) * step as f64 / STEPS as f64;
        let height = |at: f64| if is_log { 10_f64.powf(at) } else { at };
        let steps = (0..=STEPS).map(at);
        steps.map(|at| (height(at), density(at))).collect()
    }
}

/// A dot for each value, moved aside so that equal ones are seen; the same every time.
fn dots(
    area: &Area<'_>,
    values: &[f64],
    at: impl Fn(f64, f64) -> (i32, i32),
) -> canvas::DrawResult {
    for (number, &value) in values.iter().enumerate() {
        // Multiples of the golden ratio fill an interval evenly, in any number.
        let away = 2.0 * (number as f64 * 0.618_033_988_75).fract() - 1.0;
        let dot = Circle::new(at(value, away), 2, colours::INK.mix(0.5).filled());
        area.draw(&dot)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    #[test]
    fn a_violin_is_widest_where_values_are_frequent_and_its_bar_is_at_the_median() {
        let violins = Violins {
            title: "Preferences".into(),
            x: "Metric".into(),
            y: Axis::linear("Signed preference").between(-7.0, 7.0),
            samples: vec![
                Values::new("Flatness", [3.0, 3.0, 3.0, 3.0, -6.0]),
                Values::new("Topological integrity", [0.0, 7.0]),
                Values::new("Nobody", []),
                Values::new("All the same", [2.0, 2.0]),
            ],
        };
        let read = Read::parse("violins", &violins.svg());
        read.has(&[
            "Preferences",
            "Flatness",
            "Nobody",
            "Signed preference",
            "Metric",
        ]);
        let bars = read.paths("#222222");
        assert_eq!(bars.len(), 3, "{bars:?}");
        let dots = read.circles("#222222");
        assert_eq!(dots.len(), 9);
        // The median of the first is where its threes are, that of the second halfway between its values.
        assert_eq!(bars[0][0].1, dots[0].1);
        assert!((2 * bars[1][0].1 - dots[5].1 - dots[6].1).abs() <= 1);
        let outline = &read.polygons("#0072B2")[0];
        let widest = outline.iter().max_by_key(|p| p.0).expect("a violin");
        assert!(
            (widest.1 - dots[0].1).abs() <= 12,
            "{widest:?} {:?}",
            dots[0]
        );
    }
}
