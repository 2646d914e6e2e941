//! A folder of a test's own.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::{env, fs, process};

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
