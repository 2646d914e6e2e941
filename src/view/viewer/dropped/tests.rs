use super::*;

#[test]
fn files_are_told_apart_by_their_names_and_what_is_in_them() {
    let folder = std::env::temp_dir().join(format!("rara-dropped-{}", std::process::id()));
    let sog = folder.join("sog");
    std::fs::create_dir_all(folder.join("colmap/sparse")).unwrap();
    std::fs::create_dir_all(&sog).unwrap();
    let put = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let clip = put("clip.json", "\u{feff}[{\"normal\":[0,0,1],\"d\":2}]");
    assert!(matches!(DroppedFile::open(&clip), Ok(DroppedFile::Clip(all)) if all.len() == 1));
    let scene = |path: &Path| matches!(DroppedFile::open(path), Ok(DroppedFile::Scene));
    assert!(scene(&put("a.splat", "")) && scene(&put("broken.json", "{")));
    assert!(scene(&put("meta.json", "{}")) && scene(&sog));
    assert_eq!(kind(&folder.join("colmap")), JsonKind::Cameras);
    assert_eq!(kind(&folder.join("colmap/cameras.txt")), JsonKind::Cameras);
    let error = DroppedFile::open(&folder.join("none.ply"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("none.ply"), "{error}");
    let empty = put("empty.json", "[]");
    let error = DroppedFile::open(&empty).unwrap_err().to_string();
    assert!(error.contains("no clip in it"), "{error}");
    let planes = vec![r#"{"normal":[0,0,1],"d":2}"#; MOST_SURFACES + 1].join(",");
    let many = put("many.json", &format!("[{planes}]"));
    let error = DroppedFile::open(&many).unwrap_err().to_string();
    assert!(
        error.contains("many.json") && error.contains("65 537 surfaces"),
        "{error}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

#[cfg(unix)]
#[test]
fn nobody_waits_for_a_device() {
    let error = DroppedFile::open(Path::new("/dev/null"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("neither a file nor a folder"), "{error}");
}
