//! A folder of a test's own, a process of its own, and how tests wait for another process.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};
use std::{any, env, fs, process};

/// An empty folder that nothing else writes to, not even a second run of the same test. It is removed with the value,
/// unless the test fails: then its content shows why.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let name = format!("{test}-{}", process::id());
        // Where the tests were built is not where they run, if they were carried to another machine.
        let here = env::var_os("RARA_TEST_FOLDER").map(PathBuf::from);
        let here = here.unwrap_or_else(|| env!("CARGO_TARGET_TMPDIR").into());
        let path = here.join(name);
        let _ = fs::remove_dir_all(&path); // left by a process that had this number before
        fs::create_dir_all(&path).expect("the target folder is writable");
        Self(path)
    }
}

impl Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.0);
        }
    }
}

/// Says that a process runs one test, which it was started for.
const CHILD: &str = "RARA_TEST_ALONE";

/// For a test in whose process nothing else may run: whether it has run in one of its own, so that nothing is left to do here.
/// nextest gives every test a process; `cargo test` runs those of an executable side by side in one.
pub fn has_run_alone<T: Fn()>(test: T) -> bool {
    env::var_os("NEXTEST").is_none() && has_run_with(&[], test)
}

/// For a test whose process has variables in its environment: whether it has run in one that has them.
pub fn has_run_with<T: Fn()>(variables: &[(&str, &str)], _: T) -> bool {
    if env::var_os(CHILD).is_some() {
        return false;
    }
    let path = any::type_name::<T>();
    let (_, test) = path.split_once("::").expect("the test's executable");
    let output = process::Command::new(env::current_exe().expect("this executable"))
        .args(["--exact", test, "--include-ignored", "--nocapture"])
        .envs(variables.iter().copied())
        .env(CHILD, "")
        .output()
        .expect("this executable starts");
    let printed = String::from_utf8_lossy(&output.stdout);
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    assert!(
        output.status.success() && printed.contains(" 1 passed;"),
        "{test}: {printed}"
    );
    true
}

/// How long tests wait for another process: so long that only one that hangs takes it. A driver compiles for a minute and more where
/// other programs run beside it.
pub const PATIENCE: Duration = Duration::from_secs(600);

/// Waits until something is there, which is asked for again and again.
pub fn until<T>(what: &str, mut seen: impl FnMut() -> Option<T>) -> T {
    let begin = Instant::now();
    loop {
        if let Some(seen) = seen() {
            return seen;
        }
        assert!(begin.elapsed() < PATIENCE, "{what}: waited in vain");
        sleep(Duration::from_millis(20));
    }
}
