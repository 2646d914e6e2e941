//! Two axes with their marks and what they measure, and where values lie between them.

use std::error::Error;

use plotters::prelude::*;

use super::axis::{BREAK, Span};
use super::canvas::{self, Anchor, Area, DrawResult, MEDIUM, SMALL, style};
use super::colours::{FAINT, GRID, INK, PAPER};
use super::{Axis, Point};

/// The space for the marks and the description of the axis up.
const LEFT: u32 = 76;
/// The space for those of the axis across.
const BELOW: u32 = 48;

pub(super) struct Plot<'a> {
    /// The rectangle; pixels are counted from its top left. What is drawn beyond it is moved to its edges.
    pub(super) area: Area<'a>,
    /// The rectangle and what is around it.
    outer: Area<'a>,
    /// The place of the rectangle in it.
    offset: (i32, i32),
    x: Span,
    y: Span,
}

impl<'a> Plot<'a> {
    /// The plot of two measured axes with these points on it.
    pub(super) fn measured<'p>(
        area: &Area<'a>,
        (x, y): (&Axis, &Axis),
        points: impl Iterator<Item = &'p Point> + Clone,
    ) -> Result<Self, Box<dyn Error>> {
        let points = points.filter(|p| x.takes(p.x) && y.takes(p.y));
        let spans = (
            x.span(points.clone().map(|p| p.x)),
            y.span(points.map(|p| p.y)),
        );
        Self::new(area, (&x.label, spans.0), (&y.label, spans.1), true)
    }

    /// The plot of categories, whose middles are at 0.5, 1.5 and so on, and a measured axis up.
    pub(super) fn of_categories(
        area: &Area<'a>,
        names: &[&str],
        label: &str,
        y: (&Axis, Span),
    ) -> Result<Self, Box<dyn Error>> {
        let count = names.len().max(1) as f64;
        let x = Axis::linear("").between(0.0, count).span([].into_iter());
        let plot = Self::new(area, (label, x), (&y.0.label, y.1), false)?;
        let (width, height) = plot.area.dim_in_pixel();
        let wide = width as i32 / names.len().max(1) as i32;
        for (number, name) in names.iter().enumerate() {
            let at = plot.outside((plot.across(number as f64 + 0.5), height as i32 + 22));
            canvas::write_wrapped(&plot.outer, name, at, Anchor::Middle, wide - 8)?;
        }
        Ok(plot)
    }

    fn new(
        area: &Area<'a>,
        x: (&str, Span),
        y: (&str, Span),
        is_measured: bool,
    ) -> Result<Self, Box<dyn Error>> {
        let below = if is_measured { BELOW } else { BELOW + 24 };
        let mut chart = ChartBuilder::on(area)
            .x_label_area_size(below)
            .y_label_area_size(LEFT)
            .margin_right(16)
            .margin_top(8)
            .build_cartesian_2d(x.1, y.1)?;
        let mut mesh = chart.configure_mesh();
        mesh.axis_style(FAINT)
            .bold_line_style(GRID)
            .max_light_lines(0)
            .label_style(style(SMALL, INK))
            .axis_desc_style(style(MEDIUM, INK))
            .x_desc(x.0)
            .y_desc(y.0);
        if !is_measured {
            mesh.disable_x_mesh().x_labels(0);
        }
        mesh.draw()?;
        let inner = chart.plotting_area().strip_coord_spec();
        let [base, outer] = [&inner, area].map(|area| area.get_base_pixel());
        let plot = Self {
            offset: (base.0 - outer.0, base.1 - outer.1),
            area: inner,
            outer: area.clone(),
            x: x.1,
            y: y.1,
        };
        plot.breaks()?;
        Ok(plot)
    }

    pub(super) fn across(&self, x: f64) -> i32 {
        let width = f64::from(self.area.dim_in_pixel().0);
        (self.x.share(x) * width).round() as i32
    }

    pub(super) fn down(&self, y: f64) -> i32 {
        let height = f64::from(self.area.dim_in_pixel().1);
        ((1.0 - self.y.share(y)) * height).round() as i32
    }

    pub(super) fn at(&self, x: f64, y: f64) -> (i32, i32) {
        (self.across(x), self.down(y))
    }

    /// Draws the breaks behind which axes with a band for zeros go on.
    fn breaks(&self) -> DrawResult {
        let (width, height) = self.area.dim_in_pixel();
        let (width, height) = (width as i32, height as i32);
        if self.y.zeros {
            let y = height - (BREAK * f64::from(height)).round() as i32;
            self.band([(-4, y - 3), (width, y + 3)])?;
            for at in [y - 3, y + 3] {
                self.line((-6, at + 3), (6, at - 3), FAINT)?;
            }
        }
        if self.x.zeros {
            let x = (BREAK * f64::from(width)).round() as i32;
            self.band([(x - 3, 0), (x + 3, height + 4)])?;
            for at in [x - 3, x + 3] {
                self.line((at - 3, height + 6), (at + 3, height - 6), FAINT)?;
            }
        }
        Ok(())
    }

    fn outside(&self, (x, y): (i32, i32)) -> (i32, i32) {
        (x + self.offset.0, y + self.offset.1)
    }

    fn band(&self, corners: [(i32, i32); 2]) -> DrawResult {
        let corners = corners.map(|corner| self.outside(corner));
        self.outer.draw(&Rectangle::new(corners, PAPER.filled()))?;
        Ok(())
    }

    pub(super) fn line(&self, from: (i32, i32), to: (i32, i32), colour: RGBColor) -> DrawResult {
        let path = vec![self.outside(from), self.outside(to)];
        self.outer.draw(&PathElement::new(path, colour))?;
        Ok(())
    }
}
