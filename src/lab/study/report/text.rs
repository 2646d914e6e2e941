//! What the report says, as its templates ask for it.

use std::fmt::Write as _;

use rara_base::counted::counted;

use crate::study::{Evaluation, MetricResult, Participant, Questions, Sample};

impl Evaluation {
    pub(super) fn is_complete(&self) -> usize {
        self.participants.iter().filter(|p| p.is_complete()).count()
    }

    pub(super) fn answer_count(&self) -> usize {
        self.participants.iter().map(|p| p.answers.len()).sum()
    }

    /// Who and how many answers the report is about, in sentences.
    pub(super) fn summary(&self) -> String {
        let (all, complete) = (self.participants.len(), self.is_complete());
        let asked: usize = self.participants.iter().map(|p| p.asked).sum();
        let answers = counted(self.answer_count(), "answer");
        let mut text = format!("{} gave {answers} of {asked}", counted(all, "participant"));
        match all - complete {
            0 => text += "; all answered everything.",
            some => {
                let _ = write!(
                    text,
                    "; {some} of them answered only a part, which is used."
                );
            }
        }
        if let Some(seconds) = self.median_seconds {
            let _ = write!(text, " The median time of an answer is {seconds:.1} s.");
        }
        text
    }

    /// How many participants are of each kind, by what `kind` says.
    pub(super) fn shares(&self, kind: impl Fn(&Participant) -> &str) -> String {
        let mut counts = std::collections::BTreeMap::<&str, usize>::new();
        for participant in &self.participants {
            *counts.entry(kind(participant)).or_default() += 1;
        }
        let parts = counts
            .iter()
            .map(|(kind, count)| format!("{kind}: {count}"));
        parts.collect::<Vec<_>>().join(", ")
    }

    pub(super) fn ages(&self) -> String {
        self.shares(|p| &p.background.age)
    }

    pub(super) fn experience(&self) -> String {
        self.shares(|p| &p.background.experience)
    }

    pub(super) fn groups(&self) -> String {
        self.shares(|p| if p.group == 1 { "group 1" } else { "group 2" })
    }

    /// The open questions, each with the answers that were given to it and their participants.
    pub(super) fn questions(&self) -> Vec<(&'static str, Vec<(&str, &str)>)> {
        type Read = fn(&Questions) -> &str;
        let questions: [(&str, Read); 3] = [
            ("What an ideal cut must be like", |q| &q.properties),
            (
                "What is missing from both methods, or bad about them",
                |q| &q.limitations,
            ),
            ("What is good about them", |q| &q.strengths),
        ];
        let given = |read: Read| {
            let all = self.participants.iter();
            let all = all.map(move |p| (p.code.as_str(), read(&p.questions).trim()));
            all.filter(|(_, text)| !text.is_empty()).collect()
        };
        questions.map(|(title, read)| (title, given(read))).into()
    }
}

impl MetricResult {
    /// Over what, and the preferences, as the tables have them.
    pub(super) fn samples(&self) -> [(&'static str, &Sample); 2] {
        [
            ("answers", &self.answers),
            ("participants", &self.participants),
        ]
    }
}
