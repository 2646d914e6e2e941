use std::f64::consts::TAU;

use plotters::prelude::*;

use super::Axis;
use super::canvas::{self, END, FAINT, GRID, INK, MIDDLE, START, WIDTH, series};

/// Values of a few properties as polygons around a circle.
#[derive(Debug, Clone)]
pub struct Radar {
    pub title: String,
    /// The properties, clockwise from the top.
    pub axes: Vec<String>,
    pub radius: Axis,
    /// Names, and a value for each property.
    pub series: Vec<(String, Vec<f64>)>,
}

impl Radar {
    pub fn svg(&self) -> String {
        let values = self.series.iter().flat_map(|series| &series.1);
        let span = self.radius.span(values.copied());
        let [low, high] = span.ends;
        let names = self.series.iter().map(|series| &series.0);
        canvas::chart(&self.title, names, 560, |canvas, top| {
            let centre = (WIDTH / 2, (top + 520) / 2);
            let reach = f64::from(520 - centre.1 - 36);
            let out = |axis: usize, radius: f64| {
                let (across, up) = (TAU * axis as f64 / self.axes.len().max(1) as f64).sin_cos();
                let place = |middle: i32, way: f64| middle + (radius * way).round() as i32;
                (place(centre.0, across), place(centre.1, -up))
            };
            let at = |axis: usize, place: f64| out(axis, reach * (place - low) / (high - low));
            for (place, _) in &span.marks {
                let ring: Vec<_> = (0..=self.axes.len()).map(|axis| at(axis, *place)).collect();
                let colour = if *place == 0.0 { FAINT } else { GRID };
                canvas.draw(&PathElement::new(ring, colour))?;
            }
            for (axis, name) in self.axes.iter().enumerate() {
                canvas.draw(&PathElement::new(vec![centre, at(axis, high)], GRID))?;
                let beyond = out(axis, reach + 18.0);
                let anchor = match beyond.0 - centre.0 {
                    ..-9 => END,
                    -9..=9 => MIDDLE,
                    _ => START,
                };
                canvas::write(canvas, name, beyond, anchor, INK)?;
            }
            for (number, (_, values)) in self.series.iter().enumerate() {
                let values = values.iter().take(self.axes.len()).enumerate();
                let places = values.filter_map(|(axis, value)| Some(at(axis, span.at(*value)?)));
                let path: Vec<_> = places.collect();
                let colour = series(number);
                canvas.draw(&Polygon::new(path.clone(), colour.mix(0.15).filled()))?;
                let closed: Vec<_> = path.iter().chain(path.first()).copied().collect();
                canvas.draw(&PathElement::new(closed, colour.stroke_width(2)))?;
                for place in path {
                    canvas::mark(canvas, number, place)?;
                }
            }
            for (place, text) in &span.marks {
                let (x, y) = at(0, *place);
                canvas::write(canvas, text, (x - 6, y), END, FAINT)?;
            }
            canvas::write(canvas, &self.radius.label, (centre.0, 540), MIDDLE, INK)
        })
    }
}
