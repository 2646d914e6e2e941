use super::*;

#[test]
fn the_page_needs_no_network_and_no_file_that_is_not_written() {
    for (name, content) in FILES {
        assert!(
            !content.contains("//www") && !content.contains("http"),
            "{name}"
        );
    }
    let index = FILES[0].1;
    for (name, _) in &FILES[1..] {
        assert!(index.contains(&format!("\"{name}\"")), "{name}");
    }
    assert!(index.contains(&format!("\"{DATA}\"")));
}

#[test]
fn options_that_make_no_sense_and_foreign_folders_are_refused() {
    let folder = std::env::temp_dir().join(format!("rara-study-check-{}", std::process::id()));
    let plain = StudyOptions::default();
    assert!(check(&folder, &plain).is_ok());
    for options in [
        StudyOptions {
            method: Mode::Hard,
            ..plain.clone()
        },
        StudyOptions {
            cases: 0,
            ..plain.clone()
        },
        StudyOptions {
            frames: 1,
            ..plain.clone()
        },
        StudyOptions {
            size: 0,
            ..plain.clone()
        },
        StudyOptions {
            frames: 200,
            frame_size: 4096,
            ..plain.clone()
        },
    ] {
        assert!(check(&folder, &options).is_err(), "{options:?}");
    }
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("thesis.tex"), "").expect("a file");
    assert!(check(&folder, &plain).is_err());
    fs::write(folder.join(DATA), "").expect("a file");
    assert!(check(&folder, &plain).is_ok());
    fs::remove_dir_all(&folder).expect("removed");
}
