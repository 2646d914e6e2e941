//! A trace as JSON.

use serde_json::{Map, Value, json};

use super::{Lane, Trace, TraceSpan};

impl Trace {
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
        let mut spans: Vec<&TraceSpan> = events.spans.iter().collect();
        // In the order of time; a span stands before those that it holds.
        spans.sort_by(|a, b| a.begin.total_cmp(&b.begin).then(b.end.total_cmp(&a.end)));
        list.extend(spans.iter().map(|span| {
            json!({
                "ph": "X", "name": span.name, "pid": span.lane as u32, "tid": span.lane as u32,
                "ts": span.begin, "dur": span.end - span.begin,
                "args": span.about.map_or(json!({}), |about| json!(about)),
            })
        }));
        let notes: Map<String, Value> = events
            .notes
            .iter()
            .map(|(key, note)| ((*key).into(), json!(note)))
            .collect();
        let document = json!({
            "traceEvents": list, "displayTimeUnit": "ms", "metadata": notes,
        });
        document.to_string()
    }
}

#[cfg(test)]
mod tests;
