use super::*;
use crate::trace::Note;
use rara_base::stats::PassStatistics;

#[test]
fn what_holds_others_comes_first() {
    let trace = Trace::new();
    trace.span("outer", || trace.span("inner", || ()));
    let mut about = PassStatistics::new("sort");
    about.primitives = 7;
    trace.gpu("sort", [3.0, 5.0], Some(about));
    trace.note("clock", Note::Text("read".into()));
    trace.note("clock", Note::Text("none".into()));
    trace.note("within", Note::Number(1.5));
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
    assert_eq!(sort["args"]["primitives"], 7);
    let inner = events.iter().find(|event| event["name"] == "inner");
    assert_eq!(inner.expect("a span")["args"], json!({}));
    assert_eq!(
        document["metadata"],
        json!({"clock": "none", "within": 1.5})
    );
}
