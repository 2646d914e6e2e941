//! A user study like the paper's: people compare hard cuts with another method, and a report says what they preferred.
//!
//! [`create`] writes a web page that works from a folder, without a server and without a network. Who takes part sends
//! the file back that the page saves, and [`report`](report::create) evaluates all of them.

mod answers;
mod evaluation;
mod files;
mod metric;
mod page;
mod pictures;
pub mod report;

pub use answers::{Answer, Answers, Background, Questions, Side, Study, Which};
pub use evaluation::{Evaluation, MetricResult, Participant, Sample, evaluate};
pub use files::StagingFolder;
pub use metric::Metric;
pub use page::{StudyPage, create, write};
pub use pictures::StudyOptions;
