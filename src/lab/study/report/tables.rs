use crate::study::{Evaluation, Side, Which};
use crate::table::{Cell, Table};

/// The statistics of each metric, over answers and over participants.
pub(super) fn metrics(evaluation: &Evaluation) -> Table {
    let columns = [
        "metric",
        "over",
        "n",
        "mean",
        "standard deviation",
        "median",
        "d",
        "n of W",
        "W",
        "p",
        "exact",
        "positive share",
    ];
    let mut table = Table::new("Results by metric", "", columns);
    for result in &evaluation.metrics {
        for (over, sample) in result.samples() {
            let test = sample.wilcoxon;
            let is_tested = |number: f64| Some(number).filter(|_| test.n > 0);
            table.row([
                result.metric.name().into(),
                over.into(),
                Cell::Count(sample.values.len() as u64),
                sample.mean.into(),
                sample.deviation.into(),
                sample.median.into(),
                sample.d.into(),
                Cell::Count(test.n as u64),
                is_tested(test.statistic).into(),
                is_tested(test.p).into(),
                test.exact.to_string().into(),
                sample.positive.into(),
            ]);
        }
    }
    table
}

pub(super) fn answers(evaluation: &Evaluation) -> Table {
    let columns = [
        "participant",
        "group",
        "case",
        "metric",
        "left",
        "choice",
        "strength",
        "preference",
        "ms",
        "changes",
        "position",
        "at",
    ];
    let mut table = Table::new("", "", columns);
    for participant in &evaluation.participants {
        for answer in &participant.answers {
            let is_hard = answer.left == Which::Hard;
            let is_left = answer.choice == Side::Left;
            table.row([
                participant.code.as_str().into(),
                u32::from(participant.group).into(),
                answer.case.as_str().into(),
                answer.metric.name().into(),
                if is_hard { "hard" } else { "method" }.into(),
                if is_left { "left" } else { "right" }.into(),
                u32::from(answer.strength).into(),
                answer.preference().into(),
                Cell::Count(answer.ms),
                Cell::Count(answer.changes),
                Cell::Count(answer.position),
                answer.at.as_str().into(),
            ]);
        }
    }
    table
}
