//! One is never more than one.

use std::fs;

use super::{done, folder, line, plurals, stderr, stdout};

#[test]
fn one_gaussian_view_or_frame_is_not_called_several() {
    assert_eq!(
        plurals("1 Gaussians, (1 views), 11 bytes, 1 ms, 1 is"),
        ["1 Gaussians", "1 views"]
    );
    let here = folder("plurals");
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let camera = serde_json::json!([{"id": 0, "img_name": "a", "width": 16, "height": 16, "position": [0.0, 0.0, -4.0],
        "rotation": axes, "fx": 16.0, "fy": 16.0}]);
    fs::write(here.join("cameras.json"), camera.to_string()).expect("writes");
    let clips = r#"[{"name": "a", "normal": [1, 0, 0], "d": 9}]"#;
    fs::write(here.join("clips.json"), clips).expect("writes");
    let made = done(line(&here, "generate general -n 1 -o @/one.ply"));
    assert!(
        stderr(&made).contains("wrote 1 Gaussian to"),
        "{}",
        stderr(&made)
    );
    let plane = "--clip plane:0,0,1,1e-9";
    let drawn = "@/one.ply --size 16x16";
    for words in [
        "info @/one.ply".to_owned(),
        format!("render {drawn} -o @/a.png --repeat 1"),
        format!("render {drawn} -o @/a.png --repeat 1 --clip plane:0,0,1,-1e9"),
        format!("render {drawn} -o @/a.png --repeat 1 --statistics"),
        format!("render {drawn} -o @/a_{{}}.png --path orbit --frames 1"),
        format!("render {drawn} -o @/a_{{}}.png --cameras @/cameras.json --view all"),
        format!("render {drawn} -o @/a_{{}}.png --path orbit --frames 1 --skip-existing"),
        "render @/one.ply -o @/p.png --panorama --eye 0,0,0 --size 16x8".to_owned(),
        format!("sweep {drawn} --clip-normal 0,0,1 --frames 1 -o @/s"),
        format!("demo {drawn} -o @/out"),
        format!("bake @/one.ply -o @/b.ply --views 1 --size 16x16 {plane}"),
        "convert @/one.ply -o @/c.spz --min-opacity 1".to_owned(),
        "convert @/one.ply -o @/c.splat.ply --clip plane:0,0,1,-1e9".to_owned(),
        "compare @/a.png @/a.png".to_owned(),
    ] {
        let output = done(line(&here, &words));
        let text = stdout(&output) + &stderr(&output);
        assert_eq!(plurals(&text), Vec::<String>::new(), "{words}:\n{text}");
    }
    for words in [
        format!("render {drawn} --json --cameras @/cameras.json --view b"),
        format!("render {drawn} --json --clip-file @/clips.json:b"),
        format!("render {drawn} --json --clip plane:1"),
    ] {
        let output = line(&here, &words);
        assert!(!output.status.success(), "{words}");
        assert_eq!(plurals(&stderr(&output)), Vec::<String>::new(), "{words}");
    }
}
