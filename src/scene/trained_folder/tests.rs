use super::*;

#[test]
fn cameras_that_agree_have_a_common_up() {
    let ring = |up: DVec3| {
        let camera = |turn: u32| {
            let eye =
                glam::DQuat::from_axis_angle(up, f64::from(turn)) * up.any_orthonormal_vector();
            Camera::look_at(5.0 * eye + up, DVec3::ZERO, up, 50.0, (8, 8)).expect("a view")
        };
        (0..6).map(camera).collect::<Vec<_>>()
    };
    for up in [DVec3::Y, DVec3::NEG_Y, DVec3::Z] {
        let found = common_up(ring(up).into_iter()).expect("they agree");
        assert!(found.dot(up) > 0.99, "{found}");
    }
    let mut all = ring(DVec3::Y);
    all.extend(ring(DVec3::NEG_Y));
    assert_eq!(common_up(all.into_iter()), None);
}

#[test]
fn the_last_iteration_counts_and_its_cameras_are_found() {
    let folder = std::env::temp_dir().join(format!("rara-training-{}", std::process::id()));
    let write = |name: &str| {
        let file = folder.join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        fs::write(&file, "").expect("a file");
        file
    };
    fs::create_dir_all(&folder).expect("a folder");
    assert!(matches!(scene_in(&folder), Ok(None)));
    write("point_cloud/iteration_7000/point_cloud.ply");
    let last = write("point_cloud/iteration_30000/point_cloud.ply");
    write("point_cloud/iteration_40000/other.ply");
    write("point_cloud/iteration_x/point_cloud.ply");
    let cameras_file = write("cameras.json");
    assert_eq!(scene_in(&folder).ok().flatten(), Some(last.clone()));
    assert_eq!(cameras_beside(&folder), Some(cameras_file.clone()));
    assert_eq!(cameras_of(std::slice::from_ref(&last)), Some(cameras_file));
    assert_eq!(beside(&last, "dataparser_transforms.json"), None);
    // Standard input is beside nothing, whatever folder the program runs in.
    assert!(around(Path::new("-")).is_empty());
    for (name, text, says) in [
        (
            "cfg_args",
            "Namespace(sh_degree=3, antialiasing=False, white_background=False)",
            false,
        ),
        (
            "cfg_args",
            "Namespace(sh_degree=3, antialiasing=True, white_background=False)",
            true,
        ),
        (
            "config.yml",
            "  model: !!python/object\n    not_rasterize_mode: antialiased\n",
            false,
        ),
        (
            "config.yml",
            "  model: !!python/object\n    rasterize_mode: antialiased\n",
            true,
        ),
        ("cfg.yml", "antialiased: false\n", false),
        ("cfg.yml", "antialiased: true\n", true),
    ] {
        let file = folder.join(name);
        fs::write(&file, text).expect("a file");
        let by = antialiased_by(&last);
        assert_eq!(by, says.then_some(file.clone()), "{text}");
        assert_eq!(antialiased_by(&folder.join("ply/a.ply")), by);
        fs::remove_file(&file).expect("ours");
    }
    write("meta.json");
    assert!(matches!(scene_in(&folder), Ok(None)), "it is SOG");
    fs::remove_dir_all(&folder).expect("ours");
}
