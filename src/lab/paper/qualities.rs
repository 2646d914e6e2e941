//! The six qualities over all cases, as tables and charts.

use rara::Settings;
use rara_base::counted::counted;

use super::perception::{Outcome, defect, measured};
use crate::bench::ways;
use crate::charts::{Axis, HeatMap, Radar, Violins};
use crate::statistics::{cohens_d, mean, median, standard_deviation, wilcoxon};
use crate::study::Metric;
use crate::table::Table;

/// The pairs that are tested: the first is expected to be better than the second.
const PAIRS: [(&str, &str); 3] = [("rara, paper", "hard"), ("rara", "hard"), ("exact", "rara")];

/// The defects of one way, a number for each case in which it could be measured, with the number of the case.
fn defects(outcomes: &[Outcome], way: &str, quality: Metric) -> Vec<Option<f64>> {
    let of = |outcome: &Outcome| {
        let found = outcome.ways.iter().find(|m| m.way == way)?;
        measured(quality, &found.qualities)
    };
    outcomes.iter().map(of).collect()
}

fn known(values: Vec<Option<f64>>) -> Vec<f64> {
    values.into_iter().flatten().collect()
}

/// Mean, deviation and median of each defect of each way.
pub(super) fn means(outcomes: &[Outcome]) -> Table {
    let note = format!(
        "The defect of each quality over {}; 0 is the truth. The guide's page on the paper defines them.",
        counted(outcomes.len(), "case")
    );
    let columns = [
        "quality",
        "defect",
        "way",
        "cases",
        "mean",
        "deviation",
        "median",
        "worst",
    ];
    let mut table = Table::new("The six qualities", note, columns);
    for quality in Metric::ALL {
        for (way, _) in ways(Settings::default()) {
            let values = known(defects(outcomes, way, quality));
            table.row([
                quality.name().into(),
                defect(quality).into(),
                way.into(),
                (values.len() as u32).into(),
                mean(&values).into(),
                standard_deviation(&values).into(),
                median(&values).into(),
                values.iter().copied().reduce(f64::max).into(),
            ]);
        }
    }
    table
}

/// How much less defect the first of two ways has than the second, case by case.
pub(super) fn tests(outcomes: &[Outcome]) -> Table {
    let note = "The second way's defect minus the first's, paired by case: more than 0 says that the first is better. d: Cohen's \
        d of the differences. p: Wilcoxon's signed-rank test, two-sided.";
    let columns = [
        "quality",
        "better",
        "than",
        "cases",
        "mean difference",
        "share better",
        "d",
        "W",
        "p",
    ];
    let mut table = Table::new("Effect sizes and tests", note, columns);
    for quality in Metric::ALL {
        for (better, worse) in PAIRS {
            let pairs = defects(outcomes, better, quality).into_iter();
            let pairs = pairs.zip(defects(outcomes, worse, quality));
            let less: Vec<f64> = pairs.filter_map(|(a, b)| Some(b? - a?)).collect();
            let wins = less.iter().filter(|&&d| d > 0.0).count();
            let test = wilcoxon(&less);
            table.row([
                quality.name().into(),
                better.into(),
                worse.into(),
                (less.len() as u32).into(),
                mean(&less).into(),
                Some(wins as f64 / less.len() as f64)
                    .filter(|v| v.is_finite())
                    .into(),
                cohens_d(&less).into(),
                test.statistic.into(),
                test.p.into(),
            ]);
        }
    }
    table
}

/// A quality's defects of `exact` as a share of those of `hard`, case by case: logarithm to the base of ten, -2 is a hundredth.
pub(super) fn heat_map(outcomes: &[Outcome], way: &str) -> HeatMap {
    let ratio = |(a, b): (Option<f64>, Option<f64>)| match (a, b) {
        (Some(a), Some(b)) if b > 0.0 => (a / b).max(1e-3).log10(),
        (Some(0.0), Some(_)) => 0.0, // neither has the defect
        _ => f64::NAN,
    };
    let columns: Vec<Vec<f64>> = Metric::ALL
        .iter()
        .map(|&quality| {
            let ours = defects(outcomes, way, quality).into_iter();
            ours.zip(defects(outcomes, "hard", quality))
                .map(ratio)
                .collect()
        })
        .collect();
    let row = |case: usize| columns.iter().map(|column| column[case]).collect();
    HeatMap {
        title: format!("Defects of {way} beside those of hard, case by case"),
        y: "case".into(),
        x: "quality".into(),
        rows: outcomes
            .iter()
            .map(|outcome| outcome.case.clone())
            .collect(),
        columns: Metric::ALL.map(|quality| quality.name().into()).into(),
        values: (0..outcomes.len()).map(row).collect(),
        unit: format!("log10 of the defect of {way} over that of hard; less than 0 is better"),
        most: 3.0,
    }
}

/// The distribution of each quality's defects over the cases, a violin for each way.
pub(super) fn violins(outcomes: &[Outcome]) -> Vec<Violins> {
    let chart = |quality: Metric| {
        // A logarithmic axis has no place for 0: what is less than a hundred thousandth is drawn there.
        let of = |(way, _)| {
            let values = known(defects(outcomes, way, quality)).into_iter();
            (way.into(), values.map(|v| v.max(1e-5).log10()).collect())
        };
        Violins {
            title: quality.name().into(),
            x: "way of cutting".into(),
            y: Axis::linear(format!("log10 of: {}", defect(quality))),
            samples: ways(Settings::default()).map(of).into(),
        }
    };
    Metric::ALL.map(chart).into()
}

/// The share of the defects of `hard` that each way avoids, in the mean over the cases.
pub(super) fn radar(outcomes: &[Outcome]) -> Radar {
    let mean_of = |way, quality| mean(&known(defects(outcomes, way, quality))).unwrap_or(f64::NAN);
    let avoided = |way: &'static str| {
        let share = |quality| match mean_of("hard", quality) {
            hard if hard > 0.0 => (100.0 * (1.0 - mean_of(way, quality) / hard)).max(0.0),
            _ => f64::NAN,
        };
        (way.into(), Metric::ALL.map(share).into())
    };
    Radar {
        title: "Share of the defects of hard that is avoided".into(),
        axes: Metric::ALL.map(|quality| quality.name().into()).into(),
        radius: Axis::linear("avoided (%)").between(0.0, 100.0),
        series: ways(Settings::default())[1..]
            .iter()
            .map(|(way, _)| avoided(way))
            .collect(),
    }
}
