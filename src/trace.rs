//! Traces: where the time goes on the processor and on the device, as events that Perfetto and Chrome's tracing page
//! show.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use rara_base::stats::PassStatistics;

#[cfg(feature = "json")]
mod document;

/// Collects spans; clones collect into the same trace. [`HeadlessDesc::trace`](crate::HeadlessDesc::trace) takes one.
#[derive(Debug, Clone)]
pub struct Trace {
    begun: Instant,
    events: Arc<Mutex<Events>>,
}

#[derive(Debug, Default)]
struct Events {
    spans: Vec<TraceSpan>,
    /// Facts about the device, and how its clock was related to the processor's.
    notes: Vec<(&'static str, Note)>,
}

/// A fact in the document about its recording.
#[derive(Debug)]
#[cfg_attr(feature = "json", derive(serde::Serialize), serde(untagged))]
#[cfg_attr(
    not(feature = "json"),
    expect(dead_code, reason = "only the document reads it")
)]
pub(crate) enum Note {
    Text(String),
    Number(f64),
}

#[derive(Debug)]
#[cfg_attr(
    not(feature = "json"),
    expect(dead_code, reason = "only the document reads it")
)]
struct TraceSpan {
    lane: Lane,
    name: &'static str,
    /// Microseconds since the trace began.
    begin: f64,
    end: f64,
    about: Option<PassStatistics>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lane {
    Cpu = 1,
    Gpu = 2,
}

impl Default for Trace {
    fn default() -> Self {
        Self {
            begun: Instant::now(),
            events: Arc::default(),
        }
    }
}

impl Trace {
    /// An empty trace that begins now.
    pub fn new() -> Self {
        Self::default()
    }

    /// Runs `act` and notes how long it took on the processor. Spans nest.
    pub fn span<R>(&self, name: &'static str, act: impl FnOnce() -> R) -> R {
        let begin = Instant::now();
        let result = act();
        self.cpu(name, begin, Instant::now());
        result
    }

    pub(crate) fn cpu(&self, name: &'static str, begin: Instant, end: Instant) {
        self.push(Lane::Cpu, name, self.at(begin), self.at(end), None);
    }

    /// A span of the device, in microseconds of the trace.
    pub(crate) fn gpu(
        &self,
        name: &'static str,
        [begin, end]: [f64; 2],
        about: Option<PassStatistics>,
    ) {
        self.push(Lane::Gpu, name, begin, end, about);
    }

    /// Notes a fact in the document about its recording.
    pub(crate) fn note(&self, key: &'static str, value: Note) {
        let mut events = self.events();
        events.notes.retain(|(noted, _)| *noted != key);
        events.notes.push((key, value));
    }

    /// Microseconds since the trace began.
    pub(crate) fn at(&self, time: Instant) -> f64 {
        time.saturating_duration_since(self.begun).as_nanos() as f64 * 1e-3
    }

    fn push(
        &self,
        lane: Lane,
        name: &'static str,
        begin: f64,
        end: f64,
        about: Option<PassStatistics>,
    ) {
        self.events().spans.push(TraceSpan {
            lane,
            name,
            begin,
            end,
            about,
        });
    }

    fn events(&self) -> MutexGuard<'_, Events> {
        self.events.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Runs `act`, in a [`Trace::span`] if there is a trace.
pub(crate) fn span<R>(trace: Option<&Trace>, name: &'static str, act: impl FnOnce() -> R) -> R {
    match trace {
        Some(trace) => trace.span(name, act),
        None => act(),
    }
}
