use super::*;

#[cfg(target_os = "linux")]
#[test]
fn the_users_folder_is_the_first_that_is_set() {
    let folder = |set: &[(&str, &str)]| {
        let set: Vec<(String, String)> = set
            .iter()
            .map(|(name, value)| ((*name).into(), (*value).into()))
            .collect();
        user_folder(move |name| {
            let found = set.iter().find(|(have, _)| have == name);
            found.map(|(_, value)| value.into())
        })
    };
    let (own, xdg, home) = (
        ("RARA_CACHE", "/a"),
        ("XDG_CACHE_HOME", "/b"),
        ("HOME", "/c"),
    );
    assert_eq!(folder(&[own, xdg, home]), Some("/a".into()));
    assert_eq!(folder(&[xdg, home]), Some("/b/rara".into()));
    assert_eq!(folder(&[home]), Some("/c/.cache/rara".into()));
    let relative = ("XDG_CACHE_HOME", "b");
    assert_eq!(folder(&[relative, home]), Some("/c/.cache/rara".into()));
    assert_eq!(folder(&[("RARA_CACHE", ""), xdg, home]), None);
    assert_eq!(folder(&[]), None);
}

#[test]
fn a_file_is_used_only_if_it_is_whole_and_the_drivers_own() {
    let folder = std::env::temp_dir().join(format!("rara-pipelines-{}", std::process::id()));
    let (id, mut data) = crate::pipeline_cache::example();
    data.extend(0..100);
    let mut file = PipelineFile {
        path: folder.join(name(&id)),
        held: None,
    };
    file.write(&data).expect("writes, and makes the folder");
    assert_eq!(file.held_bytes(), data.len() as u64);
    assert_eq!(read(&file.path, &id).expect("reads"), data);
    let other = PipelineCacheId {
        uuid: [8; 16],
        ..id
    };
    assert!(read(&file.path, &other).is_err());

    let whole = fs::read(&file.path).expect("is there");
    for byte in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[byte] ^= 4;
        fs::write(&file.path, damaged).expect("writes");
        assert!(read(&file.path, &id).is_err(), "byte {byte} is not checked");
    }
    for length in 0..whole.len() {
        fs::write(&file.path, &whole[..length]).expect("writes");
        assert!(read(&file.path, &id).is_err(), "{length} bytes are a file");
    }
    fs::remove_dir_all(&folder).expect("goes");
}
