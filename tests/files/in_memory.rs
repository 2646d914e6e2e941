//! Scenes and cameras that are read from memory are those that are read from files.

use std::io::Cursor;
use std::path::Path;

use rara::camera_files::{ColmapFormat, cameras_from_colmap, cameras_from_json, load_cameras};
use rara::scene::{Kind, generate, load, load_from, save_ply};

#[test]
fn a_scene() {
    let path = std::env::temp_dir().join(format!("rara-memory-{}.ply", std::process::id()));
    save_ply(&path, &generate(Kind::General, 300, 1)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let expected = load(&path, &mut |_, _| ()).unwrap();
    std::fs::remove_file(&path).unwrap();

    let mut last = (0, 0);
    let loaded = load_from(Cursor::new(&bytes), Path::new("entry"), &mut |done, all| {
        last = (done, all);
    });
    assert_eq!(loaded.unwrap(), expected);
    assert_eq!(last, (bytes.len() as u64, bytes.len() as u64));
    let cut = load_from(
        Cursor::new(&bytes[..999]),
        Path::new("entry"),
        &mut |_, _| (),
    );
    assert!(cut.unwrap_err().to_string().starts_with("entry: "));
}

#[test]
fn cameras() {
    let folder = std::env::temp_dir().join(format!("rara-memory-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (lenses, images) = ("1 PINHOLE 9 7 8 8 4 3\n", "1 1 0 0 0 1 2 3 1 a.png\n\n");
    std::fs::write(folder.join("cameras.txt"), lenses).unwrap();
    std::fs::write(folder.join("images.txt"), images).unwrap();
    let (text, bytes) = (ColmapFormat::Text, (lenses.as_bytes(), images.as_bytes()));
    let colmap = cameras_from_colmap(text, bytes.0, bytes.1, &folder).unwrap();
    assert_eq!(colmap, load_cameras(&folder).unwrap());
    std::fs::remove_dir_all(&folder).unwrap();

    let json = r#" {"w": 9, "h": 7, "fl_x": 8, "cx": 4, "cy": 3, "frames": [{"file_path": "a.png",
        "transform_matrix": [[1,0,0,-1],[0,-1,0,-2],[0,0,-1,-3],[0,0,0,1]]}]}"#;
    let frames = cameras_from_json(json.as_bytes(), Path::new("file")).unwrap();
    assert_eq!(frames[0].name(), colmap[0].name());
    assert_eq!(frames[0].camera().unwrap(), colmap[0].camera().unwrap());
}
