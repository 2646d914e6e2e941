//! What pages and manifests say of the package besides its own manifest: the version of Rust that it needs, and its own.

use std::fs;
use std::path::Path;

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn one_version_of_rust_is_asked_for() {
    let pages = [
        ("README.md", "Rust 1."),
        ("src/guide/building.md", "Rust 1."),
        ("tools/examples/wgpu/Cargo.toml", "rust-version = \"1."),
    ];
    for (page, before) in pages {
        let text = read(page);
        let minors: Vec<&str> = text.split(before).skip(1).collect();
        assert!(
            !minors.is_empty(),
            "{page} does not say which Rust it needs"
        );
        for minor in minors {
            let minor = minor.split(|c: char| !c.is_ascii_digit()).next();
            let said = format!("1.{}", minor.unwrap_or_default());
            let wanted = env!("CARGO_PKG_RUST_VERSION");
            assert_eq!(said, wanted, "{page}: Cargo.toml says {wanted}");
        }
    }
}

#[test]
fn the_changelog_begins_with_this_version() {
    let text = read("CHANGELOG.md");
    let first = text.lines().find_map(|line| line.strip_prefix("## "));
    let version = first.and_then(|heading| heading.split(' ').next());
    assert_eq!(version, Some(env!("CARGO_PKG_VERSION")));
}
