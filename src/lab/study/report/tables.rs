//! The tables of a report, for other programs.

use crate::study::{Evaluation, Side, Which};

/// A field of a table, quoted where it has to be.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}

/// The statistics of each metric, over answers and over participants.
pub(super) fn metrics_csv(evaluation: &Evaluation) -> String {
    let mut csv = String::from(
        "metric,over,n,mean,standard_deviation,median,cohens_d,wilcoxon_n,wilcoxon_w,wilcoxon_p,exact,positive_share\n",
    );
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for result in &evaluation.metrics {
        for (over, sample) in result.samples() {
            let test = sample.wilcoxon;
            let fields = [
                result.metric.name().into(),
                over.into(),
                sample.values.len().to_string(),
                number(sample.mean),
                number(sample.deviation),
                number(sample.median),
                number(sample.d),
                test.n.to_string(),
                test.statistic.to_string(),
                test.p.to_string(),
                test.exact.to_string(),
                number(sample.positive),
            ];
            csv += &fields.map(|text: String| field(&text)).join(",");
            csv.push('\n');
        }
    }
    csv
}

pub(super) fn answers_csv(evaluation: &Evaluation) -> String {
    let mut csv = String::from(
        "participant,group,case,metric,left,choice,strength,preference,ms,changes,position,at\n",
    );
    for participant in &evaluation.participants {
        for answer in &participant.answers {
            let left = if answer.left == Which::Hard {
                "hard"
            } else {
                "method"
            };
            let choice = if answer.choice == Side::Left {
                "left"
            } else {
                "right"
            };
            let fields = [
                participant.code.clone(),
                participant.group.to_string(),
                answer.case.clone(),
                answer.metric.name().into(),
                left.into(),
                choice.into(),
                answer.strength.to_string(),
                answer.preference().to_string(),
                answer.ms.to_string(),
                answer.changes.to_string(),
                answer.position.to_string(),
                answer.at.clone(),
            ];
            csv += &fields.map(|text: String| field(&text)).join(",");
            csv.push('\n');
        }
    }
    csv
}
