//! What a program of ours has printed, and how it ended.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use std::process::Output;

use serde_json::Value;

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("messages are UTF-8")
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("documents are UTF-8")
}

/// Asserts success; the message has the command's stderr.
pub fn done(output: Output) -> Output {
    assert!(
        output.status.success(),
        "{:?}: {}",
        output.status,
        stderr(&output)
    );
    output
}

/// The one JSON document on stdout.
pub fn document(output: Output) -> Value {
    let output = done(output);
    serde_json::from_str(&stdout(&output)).expect("stdout is one JSON document and nothing else")
}

/// Asserts a failure with this status, nothing on stdout, and one line that says `what`.
#[track_caller]
pub fn refused(output: &Output, status: i32, what: &str) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(status), "{message}");
    assert!(output.stdout.is_empty());
    let program = message.split(": ").next();
    assert!(matches!(program, Some("rara" | "rara-lab")), "{message}");
    assert!(message.contains(what), "'{what}' is not in: {message}");
    assert_eq!(message.trim_end().lines().count(), 1, "one line: {message}");
    assert!(!message.contains("panicked"), "{message}");
}

/// Words in the plural behind a 1.
pub fn plurals(text: &str) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let bare = |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).to_owned();
    let is_plural = |word: &str| {
        word.ends_with('s') && !["ms", "is", "as", "has", "was", "its"].contains(&word)
    };
    let pairs = words
        .windows(2)
        .map(|pair| (pair[0].trim_start_matches('('), bare(pair[1])));
    let found = pairs.filter(|(number, word)| *number == "1" && is_plural(word));
    found
        .map(|(number, word)| format!("{number} {word}"))
        .collect()
}
