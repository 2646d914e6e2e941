use plotters::prelude::*;

use super::Axis;
use super::axis::{Span, axes};
use super::canvas::{self, Drawn, FAINT, INK, MARGIN, PAPER, START, series};
use crate::statistics::{median, standard_deviation};

/// How samples are distributed: as wide as values are frequent, with each value as a dot and the median as a bar.
#[derive(Debug, Clone)]
pub struct Violins {
    pub title: String,
    pub x: String,
    /// Up; no violin reaches beyond its ends.
    pub y: Axis,
    /// Names and values.
    pub samples: Vec<(String, Vec<f64>)>,
}

impl Violins {
    pub fn svg(&self) -> String {
        let values = self.samples.iter().flat_map(|sample| &sample.1);
        let y = self.y.span(values.copied());
        let names = self.samples.iter().map(|sample| &sample.0);
        let x = Span::of_categories(&self.x, names);
        canvas::chart(&self.title, None, 480, |canvas, top| {
            let note =
                "Width: how frequent values are. Dots: the values, moved aside. Bar: their median.";
            canvas::write(canvas, note, (MARGIN, top - 4), START, FAINT)?;
            let mut chart = axes(canvas, top + 20..464, &x, &y)?;
            for (number, (_, values)) in self.samples.iter().enumerate() {
                let places: Vec<f64> = values.iter().filter_map(|value| y.at(*value)).collect();
                let Some(median) = median(&places) else {
                    continue;
                };
                let colour = series(number);
                // A violin takes this share of half its column, but not more than is good to see.
                let wide = 0.42_f64.min(0.1 * self.samples.len() as f64);
                let x = |away: f64| number as f64 + 0.5 + wide * away;
                let outline = outline(&places, y.ends);
                let side = |sign: f64| {
                    let at = move |&(place, share): &(f64, f64)| (x(sign * share), place);
                    outline.iter().map(at)
                };
                let closed = side(1.0).chain(side(-1.0).rev()).chain(side(1.0).take(1));
                let shape: Vec<_> = closed.collect();
                chart.draw_series([Polygon::new(shape.clone(), colour.mix(0.35).filled())])?;
                chart.draw_series([PathElement::new(shape, colour)])?;
                chart.draw_series(places.iter().enumerate().map(|(number, &place)| {
                    // Multiples of the golden ratio fill an interval evenly, in any number.
                    let away = (number as f64 * 0.618_033_988_75).fract() - 0.5;
                    Circle::new((x(away), place), 2, INK.mix(0.5).filled())
                }))?;
                let bar = vec![(x(-0.6), median), (x(0.6), median)];
                chart.draw_series([(PAPER, 8), (INK, 4)].map(|(colour, width)| {
                    PathElement::new(bar.clone(), colour.stroke_width(width))
                }))?;
            }
            Drawn::Ok(())
        })
    }
}

/// Places, and how dense values are there as a share of the most: a normal distribution around each, of Silverman's width.
fn outline(values: &[f64], [bottom, top]: [f64; 2]) -> Vec<(f64, f64)> {
    const STEPS: usize = 96;
    let deviation = standard_deviation(values).filter(|&s| s > 0.0);
    // Equal values get a width that can be seen.
    let deviation = deviation.unwrap_or((top - bottom) / 40.0);
    let width = 1.06 * deviation * (values.len() as f64).powf(-0.2);
    let low = values.iter().copied().fold(top, f64::min);
    let high = values.iter().copied().fold(bottom, f64::max);
    let (low, high) = (
        (low - 2.0 * width).max(bottom),
        (high + 2.0 * width).min(top),
    );
    let density = |at: f64| {
        values
            .iter()
            .map(|v| (-0.5 * ((at - v) / width).powi(2)).exp())
            .sum()
    };
    let places = (0..=STEPS).map(|step| low + (high - low) * step as f64 / STEPS as f64);
    let dense: Vec<(f64, f64)> = places.map(|at| (at, density(at))).collect();
    let most = dense.iter().map(|place| place.1).fold(1e-9, f64::max);
    dense
        .into_iter()
        .map(|(at, density)| (at, density / most))
        .collect()
}
