use super::check_folder;
use std::fs;

#[test]
fn a_probe_leaves_nothing_and_touches_no_other() {
    let folder = std::env::temp_dir().join(format!("rara-probes-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let probe = |number: u64| folder.join(format!(".rara-{}-{number}.probe", std::process::id()));
    // Other tests of this process may take some of these numbers meanwhile.
    let theirs: Vec<_> = (0..64).map(probe).collect();
    theirs
        .iter()
        .for_each(|file| fs::write(file, "theirs").expect("a file"));
    std::thread::scope(|scope| {
        let threads =
            [(); 4].map(|()| scope.spawn(|| (0..50).all(|_| check_folder(&folder).is_ok())));
        assert!(
            threads
                .into_iter()
                .all(|thread| thread.join().expect("no panic"))
        );
    });
    for file in &theirs {
        assert_eq!(fs::read(file).expect("it is there"), b"theirs");
        fs::remove_file(file).expect("ours");
    }
    fs::remove_dir(&folder).expect("nothing is left in it");
}
