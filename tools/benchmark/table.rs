//! Markdown tables that can be read as they are.

use crate::statistics::Summary;

/// A table; the first column is text, the others are numbers.
#[derive(Debug)]
pub(crate) struct Table {
    title: String,
    lines: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(title: impl Into<String>, header: &[&str]) -> Self {
        Self {
            title: title.into(),
            lines: vec![header.iter().map(|cell| (*cell).to_owned()).collect()],
        }
    }

    pub(crate) fn line(
        &mut self,
        name: impl Into<String>,
        cells: impl IntoIterator<Item = String>,
    ) {
        let mut line = vec![name.into()];
        line.extend(cells);
        self.lines.push(line);
    }

    /// Prints it, unless it has no lines.
    pub(crate) fn print(&self) {
        if self.lines.len() < 2 {
            return;
        }
        let width = |column: usize| {
            let cells = self.lines.iter().filter_map(|line| line.get(column));
            cells
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
                .max(3)
        };
        let widths: Vec<usize> = (0..self.lines[0].len()).map(width).collect();
        println!("\n{}\n", self.title);
        for (index, line) in self.lines.iter().enumerate() {
            let cells = line
                .iter()
                .zip(&widths)
                .enumerate()
                .map(|(column, (cell, &width))| {
                    if column == 0 {
                        format!("{cell:<width$}")
                    } else {
                        format!("{cell:>width$}")
                    }
                });
            println!("| {} |", cells.collect::<Vec<_>>().join(" | "));
            if index == 0 {
                let rule = |(column, width): (usize, &usize)| {
                    if column == 0 {
                        "-".repeat(width + 2)
                    } else {
                        "-".repeat(width + 1) + ":"
                    }
                };
                let rules: Vec<_> = widths.iter().enumerate().map(rule).collect();
                println!("|{}|", rules.join("|"));
            }
        }
    }
}

/// The median and, from the least to the 90th percentile, the spread: `12.3 (11.9-14.0)`.
pub(crate) fn spread(s: &Summary) -> String {
    if s.n == 0 {
        return "-".into();
    }
    format!("{} ({}-{})", digits(s.median), digits(s.min), digits(s.p90))
}

/// Three significant digits, or all digits before the point if they are more: 0.0123, 1.23, 12.3, 1234.
pub(crate) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let places = (2 - value.abs().log10().floor() as i32).clamp(0, 4);
    format!("{value:.*}", places as usize)
}
