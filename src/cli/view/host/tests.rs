use super::*;

fn reading(file: (usize, usize), bytes: (u64, u64)) -> Progress {
    let path = Path::new("folder/a b.ply");
    progress(Reading { path, file, bytes })
}

#[test]
fn the_share_is_that_of_all_files_where_it_is_known() {
    let one = reading((1, 1), (25, 100));
    assert_eq!((&one.what[..], one.share), ("reading a b.ply", Some(0.25)));
    let second = reading((2, 4), (50, 100));
    assert_eq!(second.what, "reading a b.ply (2 of 4)");
    assert_eq!(second.share, Some(0.375));
    assert_eq!(reading((1, 1), (0, 0)).share, None);
}

#[test]
fn what_cannot_be_read_is_said_as_on_the_command_line() {
    let missing = PathBuf::from("/nowhere/scene.ply");
    let mut program = Program {
        shots: Shots::new("{}.png".into()),
        save_clip: None,
    };
    let mut seen = Vec::new();
    let load = program.read(vec![missing.clone()], None, (64, 64));
    let failure = load(&mut |progress| seen.push(progress.what));
    let failure = Failure::from(failure.expect_err("it is not there"));
    let typed = scenes::load_files(&[missing], &mut |_| ()).err();
    assert_eq!(
        failure.to_string(),
        typed.expect("nor for a command").to_string()
    );
    assert_eq!(seen[0], "reading scene.ply");
}
