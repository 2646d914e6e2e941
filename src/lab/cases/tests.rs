use super::*;
use rara::{Mode, Settings};

#[test]
fn every_cut_removes_more_from_step_to_step_and_never_everything() {
    let scenes: Vec<_> = generated(400).into_iter().step_by(3).collect();
    for case in cases(&scenes, DVec3::NEG_Y, (48, 36)).expect("cases") {
        let scene = scenes[case.scene].scene();
        let settings = Settings::default().mode(Mode::Hard);
        let kept = [0.0, 0.5, 1.0].map(|share| {
            let clip = case.at(share).expect("a clip");
            let frame = rara_reference::render::<f64>(&scene, &case.camera, &clip, &settings);
            frame
                .picture
                .pixels
                .iter()
                .map(|p| f64::from(p[3]))
                .sum::<f64>()
        });
        assert!(
            kept[0] >= kept[1] && kept[1] >= kept[2] && kept[0] > kept[2],
            "{case:?}: {kept:?}"
        );
        assert!(kept[2] > 0.0, "{case:?}: {kept:?}");
    }
}

#[test]
fn names_that_were_there_get_a_number() {
    let plain = ["a, face", "a, edge", "a, face", "a, face (2)", "a, face"];
    assert_eq!(
        different(plain.map(String::from)),
        [
            "a, face",
            "a, edge",
            "a, face (2)",
            "a, face (2) (2)",
            "a, face (3)"
        ]
    );
}

#[test]
fn equal_names_get_numbers_also_if_only_their_files_would_be_equal() {
    let names = ["hair", "hair", "ha-r", "ha.r", "hair"].map(String::from);
    let expected = ["hair", "hair (2)", "ha-r", "ha.r (2)", "hair (3)"];
    assert_eq!(different(names), expected);
}
