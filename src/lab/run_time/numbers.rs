//! What was measured of one scene, as a table for people and as rows for programs.

use crate::frames::{FrameTime, times};
use crate::statistics::{least, median};
use crate::table::{Cell, Table, small};

use super::world::World;

/// What [`Measurements::rows`] are of.
pub(super) const COLUMNS: [&str; 12] = [
    "device",
    "driver",
    "section",
    "scene",
    "gaussians",
    "size",
    "variant",
    "pass",
    "unit",
    "n",
    "min",
    "median",
];

/// All numbers of a scene and of pictures of one size.
#[derive(Debug)]
pub(super) struct Measurements {
    section: &'static str,
    scene: String,
    gaussians: usize,
    size: [u32; 2],
    /// What all of them have in common, such as their raster path; may be empty.
    raster: &'static str,
    /// The numbers, of which those of a column follow each other.
    all: Vec<Number>,
}

#[derive(Debug)]
struct Number {
    column: String,
    row: String,
    unit: &'static str,
    values: Vec<f64>,
}

/// What frames have beside their stages: from the call to the picture, of all processors, and all stages together.
const TOTALS: [&str; 3] = ["frame", "processor", "device"];

impl Measurements {
    pub(super) fn new(section: &'static str, world: &World, size: [u32; 2]) -> Self {
        Self {
            section,
            scene: world.name.clone(),
            gaussians: world.scene.len(),
            size,
            raster: "",
            all: Vec::new(),
        }
    }

    pub(super) fn for_pictures(&self, size: [u32; 2], raster: &'static str) -> Self {
        Self {
            scene: self.scene.clone(),
            size,
            raster,
            all: Vec::new(),
            ..*self
        }
    }

    pub(super) fn add(&mut self, column: &str, row: &str, unit: &'static str, values: Vec<f64>) {
        if !values.is_empty() {
            self.all.push(Number {
                column: column.into(),
                row: row.into(),
                unit,
                values,
            });
        }
    }

    pub(super) fn add_frames(&mut self, column: &str, frames: &[FrameTime]) {
        let stages = frames
            .last()
            .into_iter()
            .flat_map(|timed| &timed.stats.passes);
        for name in stages.map(|pass| pass.name).chain(TOTALS) {
            self.add(column, name, "ms", times(frames, name));
        }
    }

    /// Adds the ratios of frames' totals to those of other frames of the same rounds, which other work disturbs alike.
    pub(super) fn add_ratios(
        &mut self,
        column: &str,
        frames: &[FrameTime],
        to: (&str, &[FrameTime]),
    ) {
        for total in &TOTALS[..2] {
            let pairs = times(frames, total).into_iter().zip(times(to.1, total));
            let ratios = pairs.map(|(ms, to)| ms / to).collect();
            self.add(column, &format!("{total} / {}", to.0), "ratio", ratios);
        }
    }

    fn title(&self) -> String {
        let (section, scene, [width, height]) = (self.section, &self.scene, self.size);
        let gaussians = rara_base::counted::counted(self.gaussians, "Gaussian");
        let raster = match self.raster {
            "" => String::new(),
            raster => format!(", {raster}"),
        };
        format!("{section}: {scene}, {gaussians}, {width}x{height}{raster}")
    }

    /// The medians and, where there are several values, the least ones. Rows are in the order in which each column has them.
    pub(super) fn table(&self) -> Table {
        let (mut columns, mut rows, mut next) = (Vec::new(), Vec::new(), 0);
        for number in &self.all {
            if columns.last() != Some(&&number.column) {
                columns.push(&number.column);
                next = 0;
            }
            let row = (&number.row, number.unit);
            let known = rows.iter().position(|known| *known == row);
            next = 1 + known.unwrap_or_else(|| {
                rows.insert(next, row);
                next
            });
        }
        let names = ["", "unit"].into_iter();
        let names = names.chain(columns.iter().map(|column| &***column));
        let mut table = Table::new(self.title(), "", names);
        for row in rows {
            let cell = |column: &&String| -> Cell {
                let mut of_row = self.all.iter().filter(|n| (&n.row, n.unit) == row);
                match of_row.find(|number| number.column == **column) {
                    None => "-".into(),
                    Some(number) => number.text().into(),
                }
            };
            let first = [Cell::from(row.0.as_str()), row.1.into()];
            table.row(first.into_iter().chain(columns.iter().map(cell)));
        }
        table
    }

    pub(super) fn rows(&self, device: &[String; 2]) -> impl Iterator<Item = Vec<Cell>> {
        self.all.iter().map(|number| {
            let [width, height] = self.size;
            let variant = format!("{} {}", number.column, self.raster);
            vec![
                device[0].as_str().into(),
                device[1].as_str().into(),
                self.section.into(),
                self.scene.as_str().into(),
                Cell::Count(self.gaussians as u64),
                format!("{width}x{height}").into(),
                variant.trim_end().into(),
                number.row.as_str().into(),
                number.unit.into(),
                Cell::Count(number.values.len() as u64),
                least(&number.values).into(),
                median(&number.values).into(),
            ]
        })
    }
}

impl Number {
    fn text(&self) -> String {
        let median = small(median(&self.values).unwrap_or(f64::NAN));
        match self.values.len() {
            1 => median,
            _ => format!("{median} ({})", small(least(&self.values))),
        }
    }
}

#[cfg(test)]
mod tests;
