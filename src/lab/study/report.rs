//! The report of a user study: HTML and Markdown with charts, and tables for other programs.

mod tables;
mod text;

use std::fs;
use std::path::{Path, PathBuf};

use askama::Template;
use rara::{Error, Result};
use rara_base::files::write_atomically;

use super::evaluation::{Evaluation, evaluate};
use super::metric::Metric;
use crate::charts::{Axis, HeatMap, Radar, Violins};
use crate::table::Table;

#[derive(Debug, Clone, Default)]
pub struct ReportOptions {
    /// The study that all answers must belong to; `None` is that of the first file.
    pub study: Option<String>,
}

/// Evaluates the files that participants have saved and writes into a folder `report.html`, which needs no other file,
/// `report.md` with its charts, and the tables `metrics.csv` and `answers.csv`.
///
/// # Errors
/// As [`evaluate`], and if the folder cannot be written.
pub fn create(answers: &[PathBuf], folder: &Path, options: &ReportOptions) -> Result<Evaluation> {
    let evaluation = evaluate(answers, options.study.as_deref())?;
    write(&evaluation, folder)?;
    Ok(evaluation)
}

/// Writes the report of an evaluation, as [`create`] says.
pub fn write(evaluation: &Evaluation, folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(Error::io(folder))?;
    let charts = Charts::from_evaluation(evaluation);
    let results = tables::metrics(evaluation);
    let html = Html {
        evaluation,
        results: &results,
        charts: &charts,
    };
    let markdown = Markdown {
        evaluation,
        results: &results,
    };
    let filled =
        |error: askama::Error| Error::Invalid(format!("the report's template failed: {error}"));
    let files = [
        ("report.html", html.render().map_err(filled)?),
        ("report.md", markdown.render().map_err(filled)?),
        ("metrics.csv", results.csv()),
        ("answers.csv", tables::answers(evaluation).csv()),
        ("heat_map.svg", charts.heat_map),
        ("violins.svg", charts.violins),
        ("radar.svg", charts.radar),
    ];
    for (name, content) in &files {
        write_atomically(&folder.join(name), |file| {
            file.write_all(content.as_bytes())
        })?;
    }
    Ok(())
}

#[derive(Template)]
#[template(path = "report.html")]
struct Html<'a> {
    evaluation: &'a Evaluation,
    results: &'a Table,
    charts: &'a Charts,
}

#[derive(Template)]
#[template(path = "report.md")]
struct Markdown<'a> {
    evaluation: &'a Evaluation,
    results: &'a Table,
}

struct Charts {
    heat_map: String,
    violins: String,
    radar: String,
}

impl Charts {
    fn from_evaluation(evaluation: &Evaluation) -> Self {
        let names: Vec<String> = Metric::ALL.map(|metric| metric.name().into()).into();
        let method = &evaluation.study.method;
        let signed = format!("Signed preference, \u{2212}7 (hard) to 7 ({method})");
        let samples = evaluation.metrics.iter();
        let samples = samples.map(|m| (m.metric.name().into(), m.answers.values.clone()));
        let violins = Violins {
            title: "All answers by metric".into(),
            x: "Metric".into(),
            y: Axis::linear(&signed).between(-7.0, 7.0),
            samples: samples.collect(),
        };
        let means: Vec<_> = evaluation
            .metrics
            .iter()
            .map(|m| m.answers.mean.unwrap_or(f64::NAN))
            .collect();
        let least = means.iter().copied().fold(0.0, f64::min).floor();
        let most = means.iter().copied().fold(1.0, f64::max).ceil();
        let radar = Radar {
            title: "Mean preference by metric".into(),
            axes: names.clone(),
            radius: Axis::linear(format!("Mean of all answers; 0 is neither, 7 is {method}"))
                .between(least, most),
            series: vec![(method.clone(), means)],
        };
        let row = |row: &Vec<Option<f64>>| row.iter().map(|v| v.unwrap_or(f64::NAN)).collect();
        let heat_map = HeatMap {
            title: "Mean preference by case and metric".into(),
            x: "Metric".into(),
            y: "Case".into(),
            rows: evaluation.study.cases.clone(),
            columns: names,
            values: evaluation.by_case.iter().map(row).collect(),
            unit: signed,
            most: 7.0,
        };
        Self {
            heat_map: heat_map.svg(),
            violins: violins.svg(),
            radar: radar.svg(),
        }
    }
}

/// What the templates do to text.
#[allow(unreachable_pub, reason = "askama makes them public")]
mod filters {
    /// Text in a line of Markdown, without meaning to it.
    #[askama::filter_fn]
    pub(super) fn plain(
        text: impl std::fmt::Display,
        _: &dyn askama::Values,
    ) -> askama::Result<String> {
        let mut line = String::new();
        for c in text.to_string().chars() {
            match c {
                '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '!' | '&' => {
                    line.extend(['\\', c])
                }
                c if c.is_control() => line.push(' '),
                c => line.push(c),
            }
        }
        Ok(line)
    }
}

#[cfg(test)]
mod tests;
