use super::*;
use glam::DVec3;
use rara::camera_files;

#[test]
fn names_are_numbered_and_no_file_is_replaced() {
    let folder = std::env::temp_dir().join(format!("rara-shots-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut shots = Shots::new(folder.join("shot_{}.png").display().to_string());
    std::fs::write(folder.join("shot_001.json"), "").unwrap();
    let path = shots.next();
    assert_eq!(path, folder.join("shot_002.png"));

    let eye = DVec3::new(1.0, -2.0, -3.5);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 40.0, (8, 6)).unwrap();
    let picture = Picture::filled(8, 6, [0.5; 4]);
    save(&picture, &camera, &path).unwrap();
    let again = save(&picture, &camera, &path).unwrap_err().to_string();
    assert!(again.contains("replaces nothing"), "{again}");
    assert_eq!(shots.next(), folder.join("shot_003.png"));

    let read = camera_files::load_camera(&folder.join("shot_002.json")).unwrap();
    assert_eq!(read, camera);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_camera_that_cannot_be_read_again_is_not_written() {
    let folder = std::env::temp_dir().join(format!("rara-far-shot-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let eye = DVec3::new(1.0, -2.0, -3.5);
    let given = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 40.0, (8, 6)).unwrap();
    let picture = Picture::filled(8, 6, [0.5; 4]);
    for x in [f64::INFINITY, f64::NAN] {
        let mut camera = given;
        camera.eye.x = x;
        assert!(save(&picture, &camera, &folder.join("far.png")).is_err());
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_camera_is_named_as_a_shell_takes_it() {
    let text = wrote(Path::new("out/a.png"), "--mode hard");
    assert_eq!(
        text,
        "wrote out/a.png; as in rara render --camera out/a.json --mode hard"
    );
    if cfg!(not(windows)) {
        let text = wrote(Path::new("it's a $1.png"), "--mode hard");
        assert!(
            text.ends_with(r"--camera 'it'\''s a $1.json' --mode hard"),
            "{text}"
        );
    }
}
