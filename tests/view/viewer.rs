//! `rara view` as a child process that follows a script, and what the tests compare of it.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rara::Picture;

use crate::folder::{Folder, PATIENCE, until};
use crate::view::display::{Display, Owned};

/// `rara view`, following a script line by line.
pub(super) struct Viewer<'a> {
    pub(super) child: Owned,
    display: &'a Display,
    folder: &'a Path,
}

impl<'a> Viewer<'a> {
    /// On the folder's scene, without outlines: the window shows the picture and nothing else.
    pub(super) fn start(display: &'a Display, folder: &'a Path, words: &str) -> Self {
        Self::open(
            display,
            folder,
            &format!("@/scene.ply --no-outline {words}"),
        )
    }

    /// Without text over the picture.
    pub(super) fn open(display: &'a Display, folder: &'a Path, words: &str) -> Self {
        Self::with_text(display, folder, &format!("--no-text {words}"))
    }

    pub(super) fn with_text(display: &'a Display, folder: &'a Path, words: &str) -> Self {
        let mut command = rara(folder, &format!("view --script - --validation {words}"));
        command
            .env("DISPLAY", &display.name)
            .stdin(Stdio::piped())
            .stderr(Stdio::piped());
        Self {
            child: Owned(command.spawn().expect("the rara binary runs")),
            display,
            folder,
        }
    }

    pub(super) fn say(&mut self, lines: &str) {
        let stdin = self.child.0.stdin.as_mut().expect("it is piped");
        // If it has ended, a later check reports why.
        let _ = writeln!(
            stdin,
            "{}",
            lines.replace('@', self.folder.to_str().expect("text"))
        );
    }

    /// Takes a screenshot of that name; a failure shows what the viewer has printed.
    pub(super) fn screenshot(&mut self, name: &str) -> Picture {
        self.say(&format!("screenshot @/{name}.png"));
        let path = self.folder.join(name);
        // The camera is the last file to be written.
        until(&format!("screenshot {name}"), || {
            if let Some(status) = self.child.0.try_wait().expect("it can be asked") {
                panic!("{status}: {}", self.printed());
            }
            path.with_extension("json").exists().then_some(())
        });
        Picture::load(path.with_extension("png")).expect("a picture")
    }

    /// Waits until the window shows a picture, to 1/255.
    pub(super) fn shows(&self, what: &str, picture: &Picture) {
        let begin = Instant::now();
        loop {
            let seen = self.display.corner(picture.width, picture.height);
            let off = apart(&seen, picture);
            if off <= 1.01 {
                return;
            }
            if begin.elapsed() > PATIENCE {
                let _ = seen.save(self.folder.join("seen.png"));
                panic!(
                    "{what}: the window is off by {off}/255; {}/seen.png",
                    self.folder.display()
                );
            }
            sleep(Duration::from_millis(50));
        }
    }

    pub(super) fn printed(&mut self) -> String {
        self.child.printed()
    }

    /// Quits; returns what it has printed. Asserts that there is no message of the validation layer and no failure.
    pub(super) fn quit(self) -> String {
        self.quit_as(0)
    }

    /// The same with another exit status.
    pub(super) fn quit_as(mut self, code: i32) -> String {
        self.say("quit");
        let printed = self.printed();
        let status = self.child.0.wait().expect("it ends");
        assert_eq!(status.code(), Some(code), "{printed}");
        assert!(!printed.contains("validation"), "{printed}");
        printed
    }

    /// Processor time so far, hundredths of a second.
    #[cfg(target_os = "linux")]
    fn ticks(&self) -> u64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.child.0.id()));
        let stat = stat.expect("the process is there");
        let fields: Vec<_> = stat
            .rsplit(')')
            .next()
            .expect("fields")
            .split(' ')
            .collect();
        fields[12].parse::<u64>().expect("user") + fields[13].parse::<u64>().expect("system")
    }

    /// Asserts that it sleeps.
    pub(super) fn sleeps(&self, when: &str) {
        #[cfg(target_os = "linux")]
        {
            sleep(Duration::from_millis(300)); // the last frame's numbers
            let before = self.ticks();
            sleep(Duration::from_secs(1));
            let busy = self.ticks() - before;
            assert!(busy <= 5, "{when}: busy for {busy} hundredths of a second");
        }
    }
}

pub(super) fn rara(folder: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rara"));
    for word in words.split_whitespace() {
        command.arg(word.replace('@', folder.to_str().expect("the folder's name is text")));
    }
    if let Ok(device) = std::env::var("RARA_TEST_DEVICE")
        && !words.starts_with("generate")
    {
        command.args(["--device", &device]);
    }
    // The tests must not use the user's own cache and display.
    command.env("RARA_CACHE", "");
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command
}

pub(super) fn done(mut command: Command) {
    let output = command.output().expect("the rara binary runs");
    assert!(output.status.success(), "{}", stderr(&output));
}

pub(super) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A folder of the test's own with a small scene in it.
pub(super) fn folder(test: &str) -> Folder {
    let folder = Folder::new(&format!("view-{test}"));
    done(rara(
        &folder,
        "generate general -n 3000 --seed 3 -o @/scene.ply",
    ));
    folder
}

/// The largest difference, in units of 1/255, also beyond white.
pub(super) fn apart(a: &Picture, b: &Picture) -> f32 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.fold(0.0, |most: f32, (a, b)| most.max(255.0 * (a - b).abs()))
}

/// Draws a screenshot again with the flags that the viewer printed and nothing else, as a person would in a shell: the
/// file is the same, to the byte.
pub(super) fn draws_again(folder: &Path, name: &str, printed: &str) {
    draws_again_of(folder, "@/scene.ply", name, printed);
}

/// The same of these scenes.
pub(super) fn draws_again_of(folder: &Path, scenes: &str, name: &str, printed: &str) {
    let wrote = format!(
        "wrote {}",
        folder.join(name).with_extension("png").display()
    );
    let line = printed.lines().find(|line| line.starts_with(&wrote));
    let line = line.unwrap_or_else(|| panic!("{name} is not in {printed}"));
    let (_, flags) = line.split_once("rara render ").expect("the flags");
    let again = folder.join(format!("{name} again.png"));
    draw(folder, scenes, flags, &again);
    let file = |path: &Path| fs::read(path).expect("a picture");
    let shot = folder.join(name).with_extension("png");
    if file(&shot) != file(&again) {
        let picture = |path: &Path| Picture::load(path).expect("a picture");
        let off = apart(&picture(&shot), &picture(&again));
        panic!("{name}, {flags}: off by {off}/255");
    }
}

/// Draws a picture with flags that a shell takes apart.
pub(super) fn draw(folder: &Path, scenes: &str, flags: &str, picture: &Path) {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("exec \"$0\" \"$@\" {flags}")]);
    let render = rara(folder, &format!("render {scenes}"));
    shell.arg(render.get_program()).args(render.get_args());
    shell.arg("-o").arg(picture).env("RARA_CACHE", "");
    done(shell);
}
