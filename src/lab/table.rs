//! Tables of results: the same rows as Markdown and HTML for people and as CSV for programs.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

/// A table with its title and what has to be known to read it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Table {
    pub title: String,
    /// What the columns mean and where the numbers are from; may be empty.
    pub note: String,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<Cell>>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Cell {
    Text(String),
    /// A measured number, which people see with three significant digits and programs as it is; `None` where nothing was
    /// measured.
    Number(Option<f64>),
    /// A number that people see with so many decimals.
    Fixed(f64, usize),
    Count(u64),
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(Some(number))
    }
}

impl From<Option<f64>> for Cell {
    fn from(number: Option<f64>) -> Self {
        Self::Number(number)
    }
}

impl From<u32> for Cell {
    fn from(count: u32) -> Self {
        Self::Count(count.into())
    }
}

impl Cell {
    pub fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(None) => "-".into(),
            Self::Number(Some(number)) => small(*number),
            Self::Fixed(number, decimals) => format!("{number:.decimals$}"),
            Self::Count(count) => count.to_string(),
        }
    }

    fn csv(&self) -> String {
        match self {
            Self::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
            Self::Number(None) => String::new(),
            Self::Number(Some(number)) | Self::Fixed(number, _) => number.to_string(),
            Self::Count(count) => count.to_string(),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }
}

impl Table {
    pub fn new<C: Into<String>>(
        title: impl Into<String>,
        note: impl Into<String>,
        columns: impl IntoIterator<Item = C>,
    ) -> Self {
        Self {
            title: title.into(),
            note: note.into(),
            columns: columns.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
        }
    }

    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Adds rows, each of cells for the columns so far and of numbers with names, which become columns.
    pub(crate) fn pivot<'a>(
        mut self,
        rows: impl IntoIterator<Item = (Vec<Cell>, Vec<(&'a str, f64)>)>,
    ) -> Self {
        let keys = self.columns.len();
        for (mut row, numbers) in rows {
            for (name, number) in numbers {
                let known = self.columns[keys..]
                    .iter()
                    .position(|column| column == name);
                let at = keys
                    + known.unwrap_or_else(|| {
                        self.columns.push(name.into());
                        self.columns.len() - 1 - keys
                    });
                row.resize(row.len().max(at + 1), Cell::Number(None));
                row[at] = number.into();
            }
            self.rows.push(row);
        }
        let count = self.columns.len();
        self.rows
            .iter_mut()
            .for_each(|row| row.resize(count, Cell::Number(None)));
        self
    }

    /// The number in a column of the row that begins with a text.
    pub fn number(&self, row: &str, column: &str) -> Option<f64> {
        let column = self.columns.iter().position(|name| name == column)?;
        let begins = |cells: &&Vec<Cell>| cells.first().is_some_and(|cell| cell.text() == row);
        match self.rows.iter().find(begins)?.get(column)? {
            Cell::Number(number) => *number,
            Cell::Fixed(number, _) => Some(*number),
            Cell::Count(count) => Some(*count as f64),
            Cell::Text(_) => None,
        }
    }

    fn is_text(&self, column: usize) -> bool {
        let cells = self.rows.iter().filter_map(|row| row.get(column));
        cells.clone().any(Cell::is_text)
    }

    /// The table with its title as a heading.
    pub fn markdown(&self) -> String {
        let mut text = format!("## {}\n\n", self.title);
        if !self.note.is_empty() {
            let _ = writeln!(text, "{}\n", self.note);
        }
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        text += &line(&self.columns);
        let rules = (0..self.columns.len()).map(|c| match self.is_text(c) {
            true => "---",
            false => "---:",
        });
        text += &format!("|{}|\n", rules.collect::<Vec<_>>().join("|"));
        for row in &self.rows {
            let cells: Vec<_> = row.iter().map(|c| c.text().replace('|', "\\|")).collect();
            text += &line(&cells);
        }
        text
    }

    /// The columns' names and the rows, without title and note.
    pub fn csv(&self) -> String {
        let quoted = |name: &String| Cell::Text(name.clone()).csv();
        let lines = self
            .rows
            .iter()
            .map(|row| row.iter().map(Cell::csv).collect());
        let head: Vec<String> = self.columns.iter().map(quoted).collect();
        let lines = std::iter::once(head).chain(lines);
        lines.map(|cells| cells.join(",") + "\n").collect()
    }

    /// The element `table`, without title and note.
    pub fn html(&self) -> String {
        let cells = |tag: &str, cells: Vec<String>| -> String {
            let cell = |(c, text): (usize, &String)| {
                let class = if self.is_text(c) {
                    ""
                } else {
                    " class=\"number\""
                };
                format!("<{tag}{class}>{}</{tag}>", escaped(text))
            };
            format!(
                "<tr>{}</tr>\n",
                cells.iter().enumerate().map(cell).collect::<String>()
            )
        };
        let head = cells("th", self.columns.clone());
        let rows = self.rows.iter();
        let rows: String = rows
            .map(|row| cells("td", row.iter().map(Cell::text).collect()))
            .collect();
        format!(
            "<div class=\"table\"><table>\n<thead>{head}</thead>\n<tbody>\n{rows}</tbody></table></div>\n"
        )
    }
}

/// Text that HTML takes as text.
pub fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

/// Three significant digits, however small the number: 0.000312, 0.12, 3.44, 25.2, 731.
pub fn small(number: f64) -> String {
    if number == 0.0 {
        return "0".into(); // also -0
    }
    if !number.is_finite() {
        return number.to_string();
    }
    let digits = 2 - number.abs().log10().floor() as i32;
    if digits > 6 {
        return format!("{number:.2e}");
    }
    format!("{number:.*}", digits.max(0) as usize)
}

#[cfg(test)]
mod tests;
