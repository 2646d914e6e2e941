//! An X server of the test's own, and what it shows.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use rara::Picture;

use super::x11::Client;
use super::{rara, stderr};

/// The X server's screen; the windows are smaller.
const SCREEN: &str = "640x480x24";

/// A child process that does not outlive the test.
pub(super) struct Owned(pub(super) Child);

impl Owned {
    /// Everything that it prints on stderr, until it ends.
    pub(super) fn printed(&mut self) -> String {
        let mut text = String::new();
        let mut stderr = self.0.stderr.take().expect("it is piped");
        let read = stderr.read_to_string(&mut text);
        read.expect("messages are UTF-8");
        text
    }
}

impl Drop for Owned {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// An X server without a screen to look at. It keeps what would be on it in a file.
pub(super) struct Display {
    server: Owned,
    /// The value of `DISPLAY`.
    pub(super) name: String,
    frame_buffer: PathBuf,
}

impl Display {
    /// Starts a server; prints a message and returns `None` where Xvfb is missing.
    pub(super) fn start(folder: &Path) -> Option<Self> {
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-noreset"])
            .args(["-screen", "0", SCREEN, "-fbdir"])
            .arg(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match server {
            Ok(server) => Owned(server),
            Err(error) => {
                eprintln!("SKIPPED: Xvfb does not start ({error}); tools/setup test installs it");
                return None;
            }
        };
        let mut number = String::new();
        let pipe = server.0.stdout.take().expect("it is piped");
        let read = BufReader::new(pipe).read_line(&mut number);
        read.expect("Xvfb says which display it has");
        assert!(!number.trim().is_empty(), "Xvfb found no free display");
        let this = Self {
            server,
            name: format!(":{}", number.trim()),
            frame_buffer: folder.join("Xvfb_screen0"),
        };
        this.can_be_drawn_to(folder).then_some(this)
    }

    /// Says whether the driver under test supports windows at all; SwiftShader as Chromium ships it does not.
    fn can_be_drawn_to(&self, folder: &Path) -> bool {
        if std::env::var_os("RARA_TEST_DEVICE").is_none() {
            return true;
        }
        fs::write(folder.join("quit.txt"), "quit").expect("a script");
        let mut command = rara(folder, "view @/scene.ply --script @/quit.txt");
        let output = command.env("DISPLAY", &self.name).output();
        let printed = stderr(&output.expect("the rara binary runs"));
        let lacks =
            printed.contains("cannot draw into windows") || printed.contains("cannot be used here");
        if lacks {
            eprintln!("SKIPPED: {}", printed.trim_end());
        }
        !lacks
    }

    /// A client of the server.
    pub(super) fn client(&self) -> Client {
        Client::connect(self.name.trim_start_matches(':'))
    }

    /// Ends the server at once, whoever is connected.
    pub(super) fn kill(mut self) {
        self.server.0.kill().expect("it runs");
    }

    /// The upper left corner of the screen, where a window without a window manager is.
    pub(super) fn corner(&self, width: u32, height: u32) -> Picture {
        let bytes = fs::read(&self.frame_buffer).expect("Xvfb keeps its screen in a file");
        // An XWD file: a header of big-endian words, 12 bytes for each colour of a map, rows.
        let word = |at: usize| {
            let bytes = bytes[4 * at..][..4].try_into().expect("four bytes");
            u32::from_be_bytes(bytes) as usize
        };
        let (header, little_endian, bits, row, colours) =
            (word(0), word(7) == 0, word(11), word(12), word(19));
        assert!(
            little_endian && bits == 32,
            "pixels are blue, green, red, -"
        );
        let pixel = |i: u32| {
            let (x, y) = ((i % width) as usize, (i / width) as usize);
            let at = header + 12 * colours + y * row + 4 * x;
            let [b, g, r] = [0, 1, 2].map(|c| f32::from(bytes[at + c]) / 255.0);
            [r, g, b, 1.0]
        };
        Picture {
            width,
            height,
            pixels: (0..width * height).map(pixel).collect(),
        }
    }
}
