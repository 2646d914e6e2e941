//! The files of a study's participants, all together.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rara::{Error, Result};
use serde::Serialize;

use super::answers::{Answers, Study};

/// A file that is not used because its participant saved a later one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StagingFolder {
    pub participant: String,
    pub file: PathBuf,
    pub by: PathBuf,
}

/// Reads all files: the study that they belong to, the file of each participant that was saved last, and the others.
pub(super) fn read<P: AsRef<Path>>(
    files: &[P],
    expected: Option<&str>,
) -> Result<(Study, ByParticipant, Vec<StagingFolder>)> {
    let mut read: Vec<(PathBuf, Answers)> = Vec::new();
    for file in files {
        let file = file.as_ref();
        let answers = Answers::load(file)?;
        let reference = read.first().map(|(path, first)| (path, &first.study));
        check_study(file, &answers.study, reference, expected)?;
        read.push((file.to_owned(), answers));
    }
    let Some((_, first)) = read.first() else {
        return Err(Error::Invalid(
            "there are no answers; name the files that participants have saved".into(),
        ));
    };
    let study = first.study.clone();
    let (used, replaced) = latest(read);
    Ok((study, used, replaced))
}

fn check_study(
    file: &Path,
    study: &Study,
    reference: Option<(&PathBuf, &Study)>,
    expected: Option<&str>,
) -> Result<()> {
    let id = &study.id;
    if let Some(expected) = expected.filter(|expected| expected != id) {
        return Err(Error::format(
            file,
            format!(
                "study.id: these are answers to study {id}, not to {expected}; leave the file out"
            ),
        ));
    }
    match reference {
        Some((first, other)) if other.id != *id => Err(Error::format(
            file,
            format!(
                "study.id: these are answers to study {id}, but those in {} are to {}; evaluate each study by itself",
                first.display(),
                other.id
            ),
        )),
        Some((first, other)) if other != study => Err(Error::format(
            file,
            format!(
                "study: method or cases differ from those in {}, though the study is the same; use the files as the \
                 page has saved them",
                first.display()
            ),
        )),
        _ => Ok(()),
    }
}

/// Files and what is in them by participant: the length of the code comes first, so that P2 is before P10.
pub(super) type ByParticipant = BTreeMap<(usize, String), (PathBuf, Answers)>;

/// The file of each participant that was saved last, and the others.
fn latest(read: Vec<(PathBuf, Answers)>) -> (ByParticipant, Vec<StagingFolder>) {
    let mut used = ByParticipant::new();
    let key = |code: &str| (code.chars().count(), code.to_owned());
    let mut pairs = Vec::new();
    for (file, answers) in read {
        let code = answers.participant.clone();
        match used.get(&key(&code)) {
            Some((_, other)) if other.saved > answers.saved => pairs.push((code, file)),
            _ => {
                if let Some((other, _)) = used.insert(key(&code), (file, answers)) {
                    pairs.push((code, other));
                }
            }
        }
    }
    let replaced = pairs.into_iter().map(|(participant, file)| StagingFolder {
        by: used[&key(&participant)].0.clone(),
        participant,
        file,
    });
    let replaced = replaced.collect();
    (used, replaced)
}
