use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::Axis;
use super::axis::axes;
use super::canvas::{self, END, FAINT, MIDDLE, SMALL, START, series, width_of};

#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub name: String,
    /// Across, up, and what stands beside the point; nothing where it is empty.
    pub points: Vec<(f64, f64, String)>,
}

/// Points of series, each with a name beside it where it has one.
#[derive(Debug, Clone)]
pub struct Plot {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// True where lines join the points of a series; they are broken where a value is missing.
    pub joined: bool,
    /// Points that a stepped line joins from left to right, such as those that none is better than; none without them.
    pub front: Vec<[f64; 2]>,
}

impl Plot {
    pub fn svg(&self) -> String {
        let names = self.series.iter().map(|series| &series.name);
        canvas::chart(&self.title, names, 500, |canvas, top| {
            let points = || self.series.iter().flat_map(|series| &series.points);
            let x = self.x.span(points().map(|point| point.0));
            let y = self.y.span(points().map(|point| point.1));
            let chart = axes(canvas, top..484, &x, &y)?;
            let at = |a: f64, b: f64| Some(chart.backend_coord(&(x.at(a)?, y.at(b)?)));
            let (across, down) = chart.plotting_area().get_pixel_range();
            let mut labels = Labels {
                taken: Vec::new(),
                room: [across.start, down.start, across.end, down.end],
            };

            let mut front: Vec<_> = self.front.iter().filter_map(|p| at(p[0], p[1])).collect();
            front.sort_unstable();
            let corners = front.windows(2).flat_map(|p| [p[0], (p[1].0, p[0].1)]);
            let steps: Vec<_> = corners.chain(front.last().copied()).collect();
            labels.taken.extend(steps.windows(2).map(|ends| {
                let [from, to] = [ends[0], ends[1]];
                [from.0, from.1.min(to.1), to.0 + 1, from.1.max(to.1) + 1]
            }));
            canvas.draw(&PathElement::new(steps, FAINT))?;

            for (number, line) in self.series.iter().enumerate() {
                let places: Vec<_> = line.points.iter().map(|p| at(p.0, p.1)).collect();
                for run in places.split(Option::is_none).filter(|_| self.joined) {
                    let path: Vec<_> = run.iter().copied().flatten().collect();
                    canvas.draw(&PathElement::new(path, series(number).stroke_width(2)))?;
                }
                for place in places.into_iter().flatten() {
                    labels.taken.push(around(place, 6, 6));
                    canvas::mark(canvas, number, place)?;
                }
            }
            for (number, line) in self.series.iter().enumerate() {
                let colour = canvas::darker(series(number));
                for (x, y, label) in line.points.iter().filter(|p| !p.2.is_empty()) {
                    if let Some(place) = at(*x, *y) {
                        let (place, anchor) = labels.place(label, place);
                        canvas::write(canvas, label, place, anchor, colour)?;
                    }
                }
            }
            Ok(())
        })
    }
}

/// Left, top, right and bottom.
type Bounds = [i32; 4];

fn around((x, y): (i32, i32), wide: i32, high: i32) -> Bounds {
    [x - wide, y - high, x + wide, y + high]
}

fn shared(a: Bounds, b: Bounds) -> i32 {
    let across = a[2].min(b[2]) - a[0].max(b[0]);
    across.max(0) * (a[3].min(b[3]) - a[1].max(b[1])).max(0)
}

/// The places of labels, so that they hide neither points nor each other.
pub(super) struct Labels {
    /// What must not be hidden.
    pub(super) taken: Vec<Bounds>,
    /// Where labels may be.
    pub(super) room: Bounds,
}

impl Labels {
    /// The place of a point's label: the first one around it that is free, or where it hides least.
    pub(super) fn place(&mut self, label: &str, (x, y): (i32, i32)) -> ((i32, i32), HPos) {
        let half = width_of(label, SMALL) / 2;
        let beside = [0, -12, 12, -24, 24].into_iter();
        let beside = beside.flat_map(|dy| [(10, dy, START), (-10, dy, END)]);
        let places = beside.chain([-16, 16, -30, 30].map(|dy| (0, dy, MIDDLE)));
        let bounds =
            |(dx, dy, _): (i32, i32, HPos)| around((x + dx + half * dx.signum(), y + dy), half, 8);
        let hidden = |place: &(i32, i32, HPos)| {
            let bounds = bounds(*place);
            let outside = 32 * half - shared(bounds, self.room);
            let hidden: i32 = self.taken.iter().map(|taken| shared(bounds, *taken)).sum();
            (outside, hidden)
        };
        let place = places.min_by_key(hidden).expect("a place");
        self.taken.push(bounds(place));
        ((x + place.0, y + place.1), place.2)
    }
}
