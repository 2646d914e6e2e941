use super::*;

#[test]
fn drivers_keep_theirs_beside_ours_and_nowhere_else() {
    let own = std::env::temp_dir().join(format!("rara-process-{}", std::process::id()));
    let with = |set: &[(&str, &str)]| {
        let names = drivers_folders(|name| {
            let other = set.iter().find(|(have, _)| *have == name);
            other.map(|(_, value)| OsString::from(value.replace('@', own.to_str().expect("text"))))
        });
        names
            .into_iter()
            .map(|(name, folder)| {
                assert_eq!(Path::new(&folder), own.join("driver"));
                name
            })
            .collect::<Vec<_>>()
    };
    let both = ["MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH"];
    assert_eq!(with(&[("RARA_CACHE", "@")]), both);
    assert_eq!(
        with(&[("RARA_CACHE", "@"), ("MESA_SHADER_CACHE_DIR", "/x")]),
        both[1..]
    );
    assert_eq!(
        with(&[("RARA_CACHE", "@"), ("MESA_GLSL_CACHE_DIR", "/x")]),
        both[1..]
    );
    assert!(with(&[]).is_empty() && with(&[("RARA_CACHE", "")]).is_empty());
    assert!(!own.exists(), "nothing is made before a device is opened");
    std::fs::write(&own, "a file").expect("a file");
    assert!(with(&[("RARA_CACHE", "@")]).is_empty());
    std::fs::remove_file(&own).expect("ours");
}
