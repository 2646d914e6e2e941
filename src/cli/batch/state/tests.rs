use super::*;

fn entry(picture: &str, at: f64) -> StateRecord {
    StateRecord {
        picture: picture.into(),
        file: picture.into(),
        bytes: 3,
        job: String::new(),
        version: String::new(),
        driver: String::new(),
        worker: format!("{at}"),
        at,
        seconds: 0.0,
        work: 1.0,
        frame: Value::Null,
    }
}

#[test]
fn lines_of_all_workers_are_joined_and_half_a_line_is_none() {
    let folder = std::env::temp_dir().join(format!("rara-state-{}", std::process::id()));
    let worker = Worker::new(&folder).expect("a folder");
    worker.note(&entry("a", 2.0)).expect("noted");
    worker.note(&entry("b", 3.0)).expect("noted");
    let line = |entry: &StateRecord| serde_json::to_string(entry).expect("JSON");
    let half = &line(&entry("c", 1.0))[..20];
    let other = format!("{}\n?\n{half}", line(&entry("a", 1.0)));
    fs::write(folder.join("other.jsonl"), other).expect("written");
    let state = State::read(&folder).expect("read");
    let workers: Vec<_> = state.entries.values().map(|e| e.worker.as_str()).collect();
    assert_eq!((workers, state.unread), (vec!["2", "3"], 1));
    assert!(
        State::read(&folder.join("none"))
            .expect("read")
            .entries
            .is_empty()
    );
    fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_picture_has_one_claim_at_a_time_and_the_dead_leave_nothing() {
    let folder = std::env::temp_dir().join(format!("rara-claims-{}", std::process::id()));
    let worker = Worker::new(&folder).expect("a folder");
    let file = folder.join("a.png");
    let since = |at| worker.claim(("a", at), Some(&file)).expect("asked");
    let claim = || since(0.0);
    let first = claim().expect("free");
    assert!(claim().is_none());
    drop(first); // as a process that is killed
    let parts = [
        format!(".rara-{}-7.part", mark()),
        ".rara-1-2-7.part".into(),
    ];
    parts
        .iter()
        .for_each(|part| fs::write(folder.join(part), "").expect("written"));
    let second = claim().expect("free again");
    assert_eq!(parts.map(|part| folder.join(part).exists()), [false, true]);
    second.release(5.25).expect("released");
    // Who has planned before it was done does not draw it again.
    assert!(claim().is_none() && since(5.25).is_some());
    fs::remove_dir_all(&folder).expect("removed");
}
