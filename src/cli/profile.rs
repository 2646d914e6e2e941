//! The flags that show what is in a frame: a trace, and what the stages have done.

use std::path::PathBuf;

use clap::Args;
use rara::{Clip, HeadlessDesc, Scene, Settings, ShFormat, Trace};

use super::failure::Failure;
use super::memory;
use super::output;
use super::scenes::SceneArgs;
use super::session::{FirstFrame, Session};
use super::settings::DeviceArgs;
use super::values;

/// Recordings to make beside the pictures.
#[derive(Debug, Args)]
#[command(next_help_heading = "Profiling")]
pub(super) struct ProfileArgs {
    /// Write a trace for ui.perfetto.dev or chrome://tracing
    ///
    /// It shows how long each step takes on the processor and on the device.
    #[arg(long, value_name = "FILE", value_parser = values::json_file())]
    trace: Option<PathBuf>,
    /// Count the work of each stage with Vulkan's pipeline statistics, if the device has them
    ///
    /// The JSON has the counts under "statistics". Without --json, rara prints a line for each stage.
    #[arg(long)]
    statistics: bool,
}

/// A command's profile: the trace that it fills, if one is wanted.
pub(super) struct Profile {
    file: Option<PathBuf>,
    trace: Option<Trace>,
    statistics: bool,
}

impl ProfileArgs {
    pub(super) fn is_traced(&self) -> bool {
        self.trace.is_some()
    }

    /// Begins the trace; fails where its file could not be written, or is one of `pictures`.
    pub(super) fn begin(
        &self,
        pictures: impl FnOnce() -> Vec<PathBuf>,
    ) -> Result<Profile, Failure> {
        if let Some(file) = &self.trace {
            output::check_file(file)?;
            if pictures().contains(file) {
                return Err(Failure::Usage(format!(
                    "--trace and -o are one file, {}: name two",
                    file.display()
                )));
            }
        }
        Ok(Profile {
            trace: self.trace.as_ref().map(|_| Trace::new()),
            file: self.trace.clone(),
            statistics: self.statistics,
        })
    }
}

impl Profile {
    pub(super) fn is_traced(&self) -> bool {
        self.trace.is_some()
    }

    /// The frame that a session may draw ahead; none where a trace is to show one thing after the other, and where the driver may
    /// find no memory, which is checked once the scene is known.
    pub(super) fn first_frame(
        &self,
        device: &DeviceArgs,
        scenes: &SceneArgs,
        (clip, settings): (Clip, Settings),
    ) -> Option<FirstFrame> {
        let is_late = self.is_traced() || memory::address_space_is_limited();
        (!is_late).then_some(FirstFrame {
            device: device.meant().statistics(self.statistics),
            layers: scenes.places().len(),
            clip,
            settings,
        })
    }

    /// Opens a session that records what the profile needs.
    pub(super) fn open(
        &self,
        device: HeadlessDesc,
        scene: Scene<'_>,
        sh: ShFormat,
    ) -> Result<Session, Failure> {
        let device = device.trace(self.trace.clone()).statistics(self.statistics);
        Ok(self.opened(Session::open(&device, scene, sh)?))
    }

    /// A session that has been opened, with a note if its device has no statistics.
    pub(super) fn opened(&self, session: Session) -> Session {
        if self.statistics && !session.headless.device().support().pipeline_statistics {
            output::say("note: this device counts nothing (no pipelineStatisticsQuery)");
        }
        session
    }

    /// Records how long `act` takes.
    pub(super) fn span<R>(&self, name: &'static str, act: impl FnOnce() -> R) -> R {
        match &self.trace {
            Some(trace) => trace.span(name, act),
            None => act(),
        }
    }

    /// Writes the trace, also after a failure, since it shows how far the work came. The first failure is returned.
    pub(super) fn end_after(self, done: Result<(), Failure>) -> Result<(), Failure> {
        let written = match (self.file, self.trace) {
            (Some(file), Some(trace)) => output::text(&file, &trace.json()),
            _ => Ok(()),
        };
        done.and(written.map_err(Failure::from))
    }
}
