//! What all answers together say.

use std::path::{Path, PathBuf};

use rara::Result;
use serde::Serialize;

use super::answers::{Answer, Background, Questions, Study};
use super::files::{StagingFolder, read};
use super::metric::Metric;
use crate::statistics::{self, Wilcoxon};

#[derive(Debug, Clone, Serialize)]
pub struct Evaluation {
    pub study: Study,
    /// Who took part, by their codes.
    pub participants: Vec<Participant>,
    /// Files that a later one of the same participant replaces.
    pub replaced: Vec<StagingFolder>,
    /// The metrics, those that nobody answered included.
    pub metrics: Vec<MetricResult>,
    /// The mean signed preference by case, then by metric; `None` where nobody answered.
    pub by_case: Vec<Vec<Option<f64>>>,
    /// The median time of an answer, seconds.
    pub median_seconds: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
pub struct Participant {
    pub code: String,
    pub file: PathBuf,
    pub group: u8,
    pub background: Background,
    /// How many answers the page asks for.
    pub asked: usize,
    pub answers: Vec<Answer>,
    pub questions: Questions,
}

impl Participant {
    /// True for one who has answered everything that the page asks for.
    pub fn is_complete(&self) -> bool {
        self.answers.len() >= self.asked
    }

    fn preferences(&self, metric: Metric) -> Vec<f64> {
        let asked = self.answers.iter().filter(|a| a.metric == metric);
        asked.map(Answer::preference).collect()
    }
}

#[derive(Debug, Clone, Serialize)]
pub struct MetricResult {
    pub metric: Metric,
    /// Over all answers, each of one participant about one case.
    pub answers: Sample,
    /// Over participants, each with the mean of the answers.
    pub participants: Sample,
}

/// Signed preferences, -7 to 7 and positive for the method, and their statistics.
#[derive(Debug, Clone, Serialize)]
pub struct Sample {
    pub values: Vec<f64>,
    pub mean: Option<f64>,
    /// Their standard deviation; `None` of fewer than two.
    pub deviation: Option<f64>,
    pub median: Option<f64>,
    /// Cohen's d against 0; `None` of fewer than two, and where all are the same.
    pub d: Option<f64>,
    pub wilcoxon: Wilcoxon,
    /// The share of those above 0; `None` without any.
    pub positive: Option<f64>,
}

impl Sample {
    fn from_values(values: Vec<f64>) -> Self {
        let positive = values.iter().filter(|&&v| v > 0.0).count() as f64;
        Self {
            mean: statistics::mean(&values),
            deviation: statistics::standard_deviation(&values),
            median: statistics::median(&values),
            d: statistics::cohens_d(&values),
            wilcoxon: statistics::wilcoxon(&values),
            positive: (!values.is_empty()).then(|| positive / values.len() as f64),
            values,
        }
    }
}

/// Reads the files of a study's participants and evaluates them. Of a participant with several files the one that was
/// saved last is used, of equally late ones the last in the list. Files with some of the answers are used for those.
///
/// # Errors
/// Without files, as [`Answers::load`](super::Answers::load), and if the files belong to several studies or to another one than `expected`.
pub fn evaluate<P: AsRef<Path>>(files: &[P], expected: Option<&str>) -> Result<Evaluation> {
    let (study, used, replaced) = read(files, expected)?;
    let participants: Vec<_> = used
        .into_values()
        .map(|(file, answers)| Participant {
            asked: study.cases.len() * Metric::ALL.len() / 2,
            code: answers.participant,
            file,
            group: answers.group,
            background: answers.background,
            answers: answers.answers,
            questions: answers.questions,
        })
        .collect();
    let metrics = Metric::ALL.map(|metric| result(metric, &participants));
    let answers = || participants.iter().flat_map(|p| &p.answers);
    let mean = |case: &str, metric: Metric| {
        let about = answers().filter(|a| a.case == case && a.metric == metric);
        statistics::mean(&about.map(Answer::preference).collect::<Vec<_>>())
    };
    let row = |case: &String| Metric::ALL.map(|metric| mean(case, metric)).into();
    let seconds: Vec<_> = answers().map(|a| a.ms as f64 / 1000.0).collect();
    Ok(Evaluation {
        by_case: study.cases.iter().map(row).collect(),
        median_seconds: statistics::median(&seconds),
        metrics: metrics.into(),
        study,
        participants,
        replaced,
    })
}

fn result(metric: Metric, participants: &[Participant]) -> MetricResult {
    let each: Vec<_> = participants.iter().map(|p| p.preferences(metric)).collect();
    let means = each.iter().filter_map(|values| statistics::mean(values));
    MetricResult {
        metric,
        participants: Sample::from_values(means.collect()),
        answers: Sample::from_values(each.concat()),
    }
}

#[cfg(test)]
pub(super) mod tests;
