//! Where the time goes, on the processor and on the device, as the trace events that Perfetto and Chrome's tracing show.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::{Value, json};

/// Collects spans; clones collect into the same trace. [`HeadlessDesc::trace`](crate::HeadlessDesc::trace) takes one.
#[derive(Debug, Clone)]
pub struct Trace {
    begun: Instant,
    events: Arc<Mutex<Events>>,
}

#[derive(Debug, Default)]
struct Events {
    spans: Vec<Span>,
    /// How the device's clock was set against the processor's, and about the device.
    metadata: serde_json::Map<String, Value>,
}

#[derive(Debug)]
struct Span {
    lane: Lane,
    name: &'static str,
    /// Microseconds since the trace began.
    begin: f64,
    end: f64,
    about: Value,
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

    /// The document that `chrome://tracing` and <https://ui.perfetto.dev> open.
    pub fn json(&self) -> String {
        let events = self.events();
        let named = |lane: Lane, name: &str| {
            ["process_name", "thread_name"].map(|what| {
                json!({"ph": "M", "name": what, "pid": lane as u32, "tid": lane as u32, "args": {"name": name}})
            })
        };
        let mut list: Vec<Value> = named(Lane::Cpu, "CPU").into();
        list.extend(named(Lane::Gpu, "GPU"));
        let mut spans: Vec<&Span> = events.spans.iter().collect();
        // In the order of time, what holds others before them.
        spans.sort_by(|a, b| a.begin.total_cmp(&b.begin).then(b.end.total_cmp(&a.end)));
        list.extend(spans.iter().map(|span| {
            json!({
                "ph": "X", "name": span.name, "pid": span.lane as u32, "tid": span.lane as u32,
                "ts": span.begin, "dur": span.end - span.begin, "args": span.about,
            })
        }));
        let document = json!({
            "traceEvents": list, "displayTimeUnit": "ms", "metadata": events.metadata,
        });
        document.to_string()
    }

    pub(crate) fn cpu(&self, name: &'static str, begin: Instant, end: Instant) {
        self.push(Lane::Cpu, name, self.at(begin), self.at(end), json!({}));
    }

    /// A span of the device, in microseconds of the trace.
    pub(crate) fn gpu(&self, name: &'static str, [begin, end]: [f64; 2], about: Value) {
        self.push(Lane::Gpu, name, begin, end, about);
    }

    /// What the document says about itself.
    pub(crate) fn note(&self, key: &str, value: impl Into<Value>) {
        self.events().metadata.insert(key.into(), value.into());
    }

    /// Microseconds since the trace began.
    pub(crate) fn at(&self, time: Instant) -> f64 {
        time.saturating_duration_since(self.begun).as_nanos() as f64 * 1e-3
    }

    fn push(&self, lane: Lane, name: &'static str, begin: f64, end: f64, about: Value) {
        self.events().spans.push(Span {
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

/// [`Trace::span`] where there is a trace; without one only `act`.
pub fn span<R>(trace: Option<&Trace>, name: &'static str, act: impl FnOnce() -> R) -> R {
    match trace {
        Some(trace) => trace.span(name, act),
        None => act(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_holds_others_comes_first() {
        let trace = Trace::new();
        trace.span("outer", || trace.span("inner", || ()));
        trace.gpu("sort", [3.0, 5.0], json!({"splats": 7}));
        trace.note("clock", "none");
        let document: Value = serde_json::from_str(&trace.json()).expect("JSON");
        let events = document["traceEvents"].as_array().expect("a list");
        let cpu: Vec<_> = events
            .iter()
            .filter(|event| event["ph"] == "X" && event["pid"] == 1)
            .map(|event| event["name"].as_str().expect("a name"))
            .collect();
        assert_eq!(cpu, ["outer", "inner"]);
        let sort = events.iter().find(|event| event["name"] == "sort");
        let sort = sort.expect("the device's span");
        assert_eq!((&sort["ts"], &sort["dur"]), (&json!(3.0), &json!(2.0)));
        assert_eq!(sort["args"]["splats"], 7);
        assert_eq!(document["metadata"]["clock"], "none");
    }
}
