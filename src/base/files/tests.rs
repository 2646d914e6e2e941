use super::*;

#[test]
fn links_and_what_is_no_file_stay_what_they_are() {
    let folder = std::env::temp_dir().join(format!("rara-files-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let (file, link) = (folder.join("file"), folder.join("link"));
    fs::write(&file, "old").expect("a file");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    write_atomically(&link, |out| out.write_all(b"new")).expect("writes");
    let is_link = fs::symlink_metadata(&link).expect("there").is_symlink();
    assert!(is_link && fs::read(&file).expect("there") == b"new");
    let null = Path::new("/dev/null");
    write_atomically(null, |out| out.write_all(b"new")).expect("writes");
    assert!(!fs::metadata(null).expect("there").is_file());
    // A link to what is not there yet, by way of another, makes it.
    let (inner, outer) = (folder.join("inner"), folder.join("outer"));
    std::os::unix::fs::symlink("made", &inner).expect("a link");
    std::os::unix::fs::symlink(&inner, &outer).expect("a link");
    write_atomically(&outer, |out| out.write_all(b"first")).expect("writes");
    let made = folder.join("made");
    assert!(fs::symlink_metadata(&made).expect("there").is_file());
    assert!(fs::read(&outer).expect("there") == b"first");
    fs::remove_file(&made).expect("there");
    // Links in a circle lead nowhere.
    fs::remove_file(&inner).expect("there");
    std::os::unix::fs::symlink("outer", &inner).expect("a link");
    assert!(write_atomically(&outer, |out| out.write_all(b"first")).is_err());
    for link in [&inner, &outer] {
        assert!(fs::symlink_metadata(link).expect("there").is_symlink());
        fs::remove_file(link).expect("there");
    }
    // A write that fails leaves the old file.
    let failed = write_atomically(&link, |out| {
        out.write_all(b"half")?;
        Err(std::io::Error::other("full"))
    });
    assert!(failed.is_err() && fs::read(&file).expect("there") == b"new");
    // So does one that is given up.
    let mut given_up = PartialFile::begin(&link).expect("begins");
    given_up.write_all(b"half").expect("writes");
    assert!(
        given_up
            .beside
            .as_ref()
            .is_some_and(|beside| beside.is_file())
    );
    drop(given_up);
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 2);
    // A file of another process that has the same number stays that process's.
    let next = unfinished().1;
    let other = folder.join(format!(".rara-{}-{next}.part", std::process::id()));
    fs::write(&other, "theirs").expect("a file");
    write_atomically(&link, |out| out.write_all(b"new")).expect("writes");
    assert!(fs::read(&other).expect("there") == b"theirs");
    fs::remove_file(&other).expect("there");
    // As long a name as file systems take.
    let long = folder.join("n".repeat(255));
    write_atomically(&long, |out| out.write_all(b"new")).expect("writes");
    fs::remove_file(&long).expect("there");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 2);
    fs::remove_dir_all(&folder).expect("ours");
}
