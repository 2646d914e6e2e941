use std::f64::consts::TAU;

use plotters::prelude::*;

use super::axis::number;
use super::canvas::{self, Anchor, Key, SMALL};
use super::{Axis, Values, colours};

/// Values of a few properties as polygons around a circle.
#[derive(Debug, Clone)]
pub struct Radar {
    pub title: String,
    /// The properties, clockwise from the top.
    pub axes: Vec<String>,
    pub radius: Axis,
    pub series: Vec<Values>,
}

const WIDTH: u32 = 680;
const HEIGHT: u32 = 560;

impl Radar {
    pub fn svg(&self) -> String {
        let values = self.series.iter().flat_map(|series| &series.values);
        let middle = Some(0.0).filter(|_| self.radius.range.is_none());
        let span = self.radius.span(values.copied().chain(middle));
        canvas::chart(&self.title, (WIDTH, HEIGHT), |area| {
            let names: Vec<_> = self.series.iter().map(|s| s.name.as_str()).collect();
            let area = canvas::legend(area, Key::Line, &names)?;
            let (width, height) = area.dim_in_pixel();
            let (width, height) = (width as i32, height as i32);
            let reach = f64::from((width / 2 - 150).min(height / 2 - 44));
            let centre = (width / 2, (height - 24) / 2);
            let at = |axis: usize, share: f64| {
                let angle = TAU * axis as f64 / self.axes.len().max(1) as f64;
                let (across, up) = angle.sin_cos();
                let place = |middle: i32, way: f64| middle + (share * reach * way).round() as i32;
                (place(centre.0, across), place(centre.1, -up))
            };
            let ring = |share: f64| (0..=self.axes.len()).map(move |axis| at(axis, share));
            for mark in span.marks() {
                let path: Vec<_> = ring(span.share(mark)).collect();
                let colour = if mark == 0.0 {
                    colours::FAINT
                } else {
                    colours::GRID
                };
                area.draw(&PathElement::new(path, colour))?;
            }
            for (axis, name) in self.axes.iter().enumerate() {
                let spoke = vec![at(axis, 0.0), at(axis, 1.0)];
                area.draw(&PathElement::new(spoke, colours::GRID))?;
                let outside = at(axis, 1.0 + 18.0 / reach);
                let anchor = match outside.0 - centre.0 {
                    ..-9 => Anchor::End,
                    -9..=9 => Anchor::Middle,
                    _ => Anchor::Start,
                };
                canvas::write_wrapped(&area, name, outside, anchor, 130)?;
            }
            for (series, values) in self.series.iter().enumerate() {
                let colour = colours::series(series);
                let place = |(axis, value): (usize, &f64)| {
                    let share = span.share(*value).clamp(0.0, 1.0);
                    self.radius.takes(*value).then(|| at(axis, share))
                };
                let values = values.values.iter().take(self.axes.len());
                let path: Vec<_> = values.enumerate().filter_map(place).collect();
                area.draw(&Polygon::new(path.clone(), colour.mix(0.15).filled()))?;
                let closed = path.iter().chain(path.first()).copied().collect::<Vec<_>>();
                area.draw(&PathElement::new(closed, colour.stroke_width(2)))?;
                for at in path {
                    canvas::mark(&area, series, at)?;
                }
            }
            for mark in span.marks() {
                let (x, y) = at(0, span.share(mark));
                let text = number(mark);
                canvas::write(&area, &text, (x - 6, y), Anchor::End, 11, colours::FAINT)?;
            }
            let below = (centre.0, height - 8);
            let label = &self.radius.label;
            canvas::write(&area, label, below, Anchor::Middle, SMALL, colours::INK)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    #[test]
    fn values_are_as_far_from_the_middle_as_they_are_large() {
        let names = [
            "Flatness",
            "Temporal stability",
            "Topological integrity",
            "Naturalness",
        ];
        let radar = Radar {
            title: "Mean preferences".into(),
            axes: names.map(Into::into).into(),
            radius: Axis::linear("Signed preference").between(0.0, 4.0),
            series: vec![Values::new("exact", [4.0, 2.0, 2.0, f64::NAN])],
        };
        let read = Read::parse("radar", &radar.svg());
        read.has(&names);
        read.has(&["Mean preferences", "Signed preference", "exact", "4"]);
        let circles = read.circles("#0072B2");
        assert_eq!(circles.len(), 4, "three values and the legend's");
        let [top, right, bottom] = [circles[1], circles[2], circles[3]];
        assert_eq!(top.0, bottom.0);
        let reach = right.0 - top.0;
        assert!((bottom.1 - right.1 - reach).abs() <= 1, "{circles:?}");
        assert!((right.1 - top.1 - 2 * reach).abs() <= 1, "{circles:?}");
    }
}
