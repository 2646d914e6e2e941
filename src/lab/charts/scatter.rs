use std::error::Error;

use plotters::prelude::*;

use super::canvas::{self, Anchor, HEIGHT, Key, SMALL, WIDTH, width_of};
use super::plot::Plot;
use super::{Axis, Point, Series, colours};

/// Points, each with a name beside it where it has one.
#[derive(Debug, Clone)]
pub struct Scatter {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// Points that a stepped line joins from left to right, such as those that none is better than; none without them.
    pub front: Vec<[f64; 2]>,
}

impl Scatter {
    pub fn svg(&self) -> String {
        canvas::chart(&self.title, (WIDTH, HEIGHT + 60), |area| {
            let names: Vec<_> = self.series.iter().map(|s| s.name.as_str()).collect();
            let area = canvas::legend(area, Key::Mark, &names)?;
            let points = self.series.iter().flat_map(|series| &series.points);
            let plot = Plot::measured(&area, (&self.x, &self.y), points)?;
            let has_place = |p: &&Point| self.x.takes(p.x) && self.y.takes(p.y);
            let mut labels = Labels::new(&plot);
            labels.taken.extend(self.draw_front(&plot)?);
            for (number, series) in self.series.iter().enumerate() {
                for point in series.points.iter().filter(has_place) {
                    let at = plot.at(point.x, point.y);
                    labels.taken.push([at.0 - 6, at.1 - 6, at.0 + 6, at.1 + 6]);
                    canvas::mark(&plot.area, number, at)?;
                }
            }
            for (number, series) in self.series.iter().enumerate() {
                let named = |p: &&Point| has_place(p) && !p.label.is_empty();
                for point in series.points.iter().filter(named) {
                    let (at, anchor) = labels.place(&point.label, plot.at(point.x, point.y));
                    let colour = colours::darker(colours::series(number));
                    canvas::write(&plot.area, &point.label, at, anchor, SMALL, colour)?;
                }
            }
            Ok(())
        })
    }

    /// Draws the line and returns where its pieces are, as [`Labels::taken`] has them.
    fn draw_front(&self, plot: &Plot<'_>) -> Result<Vec<[i32; 4]>, Box<dyn Error>> {
        let mut front = self.front.clone();
        front.retain(|p| self.x.takes(p[0]) && self.y.takes(p[1]));
        front.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        let mut path: Vec<(i32, i32)> = Vec::new();
        for [x, y] in front {
            let at = plot.at(x, y);
            if let Some(last) = path.last() {
                path.push((at.0, last.1));
            }
            path.push(at);
        }
        let piece = |ends: &[(i32, i32)]| {
            let [from, to] = [ends[0], ends[1]];
            let (left, right) = (from.0.min(to.0), from.0.max(to.0));
            [left, from.1.min(to.1), right + 1, from.1.max(to.1) + 1]
        };
        let pieces = path.windows(2).map(piece).collect();
        if !path.is_empty() {
            plot.area.draw(&PathElement::new(path, colours::FAINT))?;
        }
        Ok(pieces)
    }
}

/// The places of labels, so that they hide neither points nor each other.
struct Labels {
    /// Left, top, right and bottom of what must not be hidden.
    taken: Vec<[i32; 4]>,
    size: (i32, i32),
}

impl Labels {
    fn new(plot: &Plot<'_>) -> Self {
        let (width, height) = plot.area.dim_in_pixel();
        Self {
            taken: Vec::new(),
            size: (width as i32, height as i32),
        }
    }

    /// The place of a point's label: the first one around it that is free, or where it hides least.
    fn place(&mut self, label: &str, (x, y): (i32, i32)) -> ((i32, i32), Anchor) {
        let wide = width_of(label, SMALL);
        let beside = [(10, 0), (8, -12), (8, 12), (8, -24), (8, 24)];
        let right = beside.map(|(dx, dy)| ((x + dx, y + dy), Anchor::Start));
        let left = beside.map(|(dx, dy)| ((x - dx, y + dy), Anchor::End));
        let middle = [-16, 16, -30, 30].map(|dy| ((x, y + dy), Anchor::Middle));
        let near = |turn: usize| [right[turn], left[turn]];
        let places = (0..beside.len()).flat_map(near).chain(middle);
        let box_of = |((x, y), anchor): ((i32, i32), Anchor)| {
            let left = match anchor {
                Anchor::Start => x,
                Anchor::Middle => x - wide / 2,
                Anchor::End => x - wide,
            };
            [left, y - 8, left + wide, y + 8]
        };
        let hidden = |place: &((i32, i32), Anchor)| -> i64 {
            let [left, top, right, bottom] = box_of(*place);
            let outside = left < 2 || top < 0 || right > self.size.0 || bottom > self.size.1;
            let overlap = |other: &[i32; 4]| {
                let across = right.min(other[2]) - left.max(other[0]);
                let down = bottom.min(other[3]) - top.max(other[1]);
                i64::from(across.max(0)) * i64::from(down.max(0))
            };
            self.taken.iter().map(overlap).sum::<i64>() + if outside { 1_000_000 } else { 0 }
        };
        let place = places.min_by_key(hidden).unwrap_or(right[0]);
        self.taken.push(box_of(place));
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charts::test::Read;

    fn scatter() -> Scatter {
        Scatter {
            title: "Error against time".into(),
            x: Axis::log("Time (ms)"),
            y: Axis::log("Mean squared error"),
            series: vec![
                Series::labelled(
                    "rara",
                    [
                        (1.0, 1e-4, "exact"),
                        (1.1, 1e-4, "affine"),
                        (2.0, 0.0, "beam"),
                    ],
                ),
                Series::labelled("others", [(0.5, 1e-2, "hard"), (4.0, 1e-3, "<none>")]),
            ],
            front: vec![[0.5, 1e-2], [1.0, 1e-4], [2.0, 0.0]],
        }
    }

    #[test]
    fn every_point_and_label_is_there_and_zeros_lie_below_the_break() {
        let read = Read::parse("scatter", &scatter().svg());
        read.has(&[
            "exact",
            "affine",
            "beam",
            "hard",
            "<none>",
            "rara",
            "others",
            "Time (ms)",
            "0",
        ]);
        let circles = read.circles("#0072B2");
        assert_eq!(
            circles.len(),
            4,
            "three points and the legend's: {circles:?}"
        );
        let [exact, affine, beam] = [circles[1], circles[2], circles[3]];
        assert!(exact.0 < affine.0 && affine.0 < beam.0);
        assert_eq!(exact.1, affine.1);
        // One decade up is the same everywhere; the zero is apart from them.
        assert!(beam.1 > exact.1 + 20, "{circles:?}");
    }

    #[test]
    fn labels_of_close_points_do_not_overlap() {
        let mut labels = Labels {
            taken: vec![[94, 94, 106, 106], [96, 94, 108, 106]],
            size: (400, 400),
        };
        let texts = ["first", "second", "third", "fourth"];
        for (number, text) in texts.iter().enumerate() {
            labels.place(text, (100 + 2 * (number as i32 % 2), 100));
        }
        for (i, a) in labels.taken.iter().enumerate().skip(2) {
            for b in &labels.taken[..i] {
                let apart = a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3];
                assert!(apart, "{a:?} {b:?}");
            }
        }
    }
}
