//! Numbers of things, as sentences have them.

use std::fmt::Display;

/// So many of what is called `one`: "1 camera", "2 cameras", "0 properties".
pub fn counted(number: impl Display, one: &str) -> String {
    let number = number.to_string();
    match one.strip_suffix("ty") {
        _ if number == "1" => format!("{number} {one}"),
        Some(stem) => format!("{number} {stem}ties"),
        None => format!("{number} {one}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};

    #[test]
    fn one_is_no_plural() {
        let shown = [0, 1, 2, 1000].map(|number| counted(number, "view"));
        assert_eq!(shown, ["0 views", "1 view", "2 views", "1000 views"]);
        assert_eq!(
            counted(1, "property") + &counted(2, "property"),
            "1 property2 properties"
        );
        assert_eq!(counted("1 234", "byte"), "1 234 bytes");
    }

    /// The source files below a folder.
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                sources(&path, found);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                found.push(path);
            }
        }
    }

    /// A file without its tests and comments, its sentences in one piece.
    fn text(file: &Path) -> String {
        let text = std::fs::read_to_string(file).expect("a file");
        let end = text.find("\n#[cfg(test)]\nmod ").unwrap_or(text.len());
        let lines = text[..end].lines().map(str::trim);
        let mut joined = String::new();
        for line in lines.filter(|line| !line.starts_with("//")) {
            match line.strip_suffix('\\') {
                Some(part) => joined += part,
                None => joined.extend([line, "\n"]),
            }
        }
        joined
    }

    /// The places of `{...} plural` where the braces hold a number that may be 1: no constant, no part of a size as 3x4, no end of a range from 1, and none
    /// that is written with decimals.
    fn uncounted(text: &str, plural: &str) -> Vec<String> {
        let end = format!("}} {plural}");
        let found = text.match_indices(&end).filter_map(|(end, matched)| {
            let after = text[end + matched.len()..].chars().next();
            let begin = text[..end].rfind('{')?;
            let inside = &text[begin + 1..end];
            let name = inside.split(':').next().unwrap_or_default();
            let is_constant = !name.is_empty()
                && name
                    .chars()
                    .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
            let is_number = !is_constant
                && !inside.contains(['.', '\n'])
                && !["x", "1 to "]
                    .iter()
                    .any(|before| text[..begin].ends_with(before));
            let is_word = !after.is_some_and(|c| c.is_alphanumeric() || "_-".contains(c));
            (is_number && is_word).then(|| text[begin..end + matched.len()].to_owned())
        });
        found.collect()
    }

    /// What is counted by `counted` in one place is so in all.
    #[test]
    fn sentences_count_by_this_function() {
        let base = Path::new(env!("CARGO_MANIFEST_DIR"));
        let src = base.parent().expect("src");
        let mut files = Vec::new();
        sources(src, &mut files);
        let is_test = |file: &&PathBuf| {
            let parts = file.strip_prefix(src).expect("below it");
            parts.iter().any(|part| {
                ["tests", "tests.rs", "reference", "codegen", "c"]
                    .iter()
                    .any(|test| part == *test)
            })
        };
        files.retain(|file| !is_test(&file));
        let texts: Vec<_> = files.iter().map(|file| (file, text(file))).collect();
        let mut plurals = BTreeSet::new();
        for (_, text) in &texts {
            for (at, _) in text.match_indices("counted(") {
                let call = &text[at..text[at..].find(");").map_or(text.len(), |end| at + end)];
                let noun = call
                    .split('"')
                    .nth(1)
                    .filter(|noun| noun.chars().all(char::is_alphabetic));
                plurals.extend(noun.map(|noun| counted(2, noun)[2..].to_owned()));
            }
        }
        assert!(
            plurals.contains("Gaussians") && plurals.contains("bytes"),
            "{plurals:?}"
        );
        let mut wrong = Vec::new();
        for (file, text) in &texts {
            for plural in &plurals {
                wrong.extend(
                    uncounted(text, plural)
                        .iter()
                        .map(|part| format!("{}: {part}", file.display())),
                );
            }
        }
        assert!(
            wrong.is_empty(),
            "give these to `counted`:\n{}",
            wrong.join("\n")
        );
    }
}
