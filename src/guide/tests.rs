//! A property of the guide that rustdoc does not see: that it can be read in the repository too.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::CHAPTERS;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The front page, the index and the chapters.
fn pages() -> Vec<PathBuf> {
    let guide = root().join("src/guide");
    let chapters = CHAPTERS
        .iter()
        .map(|name| guide.join(name).with_extension("md"));
    [root().join("README.md"), guide.join("index.md")]
        .into_iter()
        .chain(chapters)
        .collect()
}

/// The links that a text defines: names and where they lead.
fn definitions(text: &str) -> Vec<(&str, &str)> {
    text.lines()
        .filter_map(|line| line.strip_prefix('[')?.split_once("]: "))
        .collect()
}

#[test]
fn every_file_is_a_chapter() {
    let others = ["index", "links"];
    let names: BTreeSet<_> = CHAPTERS
        .iter()
        .chain(&others)
        .map(|name| format!("{name}.md"))
        .collect();
    let entries = std::fs::read_dir(root().join("src/guide")).expect("the guide");
    let files = entries.map(|entry| {
        entry
            .expect("an entry")
            .file_name()
            .into_string()
            .expect("UTF-8")
    });
    let files: BTreeSet<_> = files.filter(|name| name.ends_with(".md")).collect();
    assert_eq!(files, names);
}

#[test]
fn the_front_page_and_the_index_name_every_chapter() {
    for page in &pages()[..2] {
        let text = read(page);
        for name in CHAPTERS {
            let file = format!("{name}.md");
            let found = definitions(&text).iter().any(|(_, to)| to.ends_with(&file));
            assert!(found, "{} does not lead to {file}", page.display());
        }
    }
}

#[test]
fn the_front_page_is_short() {
    let lines = read(&root().join("README.md")).lines().count();
    assert!(
        lines <= 250,
        "{lines} lines: what does not have to be there goes into a chapter"
    );
}

#[test]
fn links_lead_somewhere_in_the_repository_and_among_generated_pages() {
    let guide = root().join("src/guide");
    let links = read(&guide.join("links.md"));
    let pictures = crate::codegen::pictures::NAMES.map(|name| format!("{name} picture"));
    let generated: BTreeSet<_> = definitions(&links)
        .into_iter()
        .map(|(name, _)| name)
        .chain(pictures.iter().map(String::as_str))
        .collect();
    for page in pages() {
        let (text, name) = (read(&page), page.display());
        assert!(
            !text.contains("]("),
            "{name}: a link that is no definition leads nowhere among generated pages"
        );
        for (label, to) in definitions(&text) {
            let folder = page.parent().expect("a folder");
            assert!(folder.join(to).is_file(), "{name}: {to} is no file");
            assert!(
                generated.contains(label),
                "{name}: links.md does not say where [{label}] leads"
            );
        }
    }
}

#[test]
fn paths_that_are_named_exist() {
    for page in pages() {
        let text = read(&page);
        for code in text.split('`').skip(1).step_by(2) {
            let is_path = ["src/", "glsl/", "tests/", "tools/"]
                .iter()
                .any(|folder| code.starts_with(folder));
            let path = code.split_whitespace().next().unwrap_or_default();
            assert!(
                !is_path || root().join(path).exists(),
                "{}: there is no {path}",
                page.display()
            );
        }
    }
}

#[test]
fn tests_of_the_tables_of_a_specification_exist() {
    let text = read(&root().join("src/guide/formats.md"));
    let (_, section) = text.split_once("row by row\n").expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.ends_with("` |"));
    let names: BTreeSet<_> = rows.filter_map(|row| row.rsplit('`').nth(1)).collect();
    assert!(names.len() > 10, "{names:?}");
    let folders = [
        "tests/files/formats",
        "tests/files/formats/harmonics",
        "tests/pictures",
    ];
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(root().join(folder)).expect("tests"));
    let files = files.map(|entry| entry.expect("an entry").path());
    let code: Vec<_> = files
        .filter(|path| path.is_file())
        .map(|path| read(&path))
        .collect();
    for name in names {
        let function = format!("fn {name}()");
        assert!(
            code.iter().any(|code| code.contains(&function)),
            "there is no test {name}"
        );
    }
}
