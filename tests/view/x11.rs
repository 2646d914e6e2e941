//! As much of the X protocol as the tests need to treat a window as a window manager or a person does.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;

/// A client of an X server.
pub(super) struct Client {
    pub(super) stream: UnixStream,
    pub(super) root: u32,
    /// The last number of a thing of the client's own.
    pub(super) base: u32,
}

impl Client {
    /// Connects to the server on this machine that has this display number.
    pub(super) fn connect(number: &str) -> Self {
        let path = format!("/tmp/.X11-unix/X{number}");
        let mut stream = UnixStream::connect(path).expect("the server listens");
        // Little-endian, protocol 11.0, no authorisation.
        let hello = [b'l', 0, 11, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        stream.write_all(&hello).expect("the server listens");
        let mut head = [0; 8];
        stream.read_exact(&mut head).expect("an answer");
        assert_eq!(head[0], 1, "the server lets everybody in");
        let mut setup = vec![0; 4 * usize::from(u16::from_le_bytes([head[6], head[7]]))];
        stream.read_exact(&mut setup).expect("the whole answer");
        let vendor = usize::from(u16::from_le_bytes([setup[16], setup[17]]));
        let screen = 32 + vendor.next_multiple_of(4) + 8 * usize::from(setup[21]);
        let (root, base) = (word(&setup, screen), word(&setup, 4));
        Self { stream, root, base }
    }

    /// The largest window that is open.
    pub(super) fn window(&mut self) -> u32 {
        self.request(15, 0, &[self.root]); // QueryTree
        let reply = self.reply();
        let mut children = vec![0; 4 * word(&reply, 4) as usize];
        self.stream.read_exact(&mut children).expect("the rest");
        let children = children.chunks_exact(4).map(|child| word(child, 0));
        let children: Vec<_> = children.collect();
        let area = |client: &mut Self, window: u32| {
            client.request(14, 0, &[window]); // GetGeometry
            let reply = client.reply();
            let side = |at: usize| u32::from(u16::from_le_bytes([reply[at], reply[at + 1]]));
            side(16) * side(18)
        };
        let largest = children
            .into_iter()
            .max_by_key(|window| area(self, *window));
        largest.expect("a window is open")
    }

    /// Takes the window from the screen, as a window manager does when it is minimised.
    pub(super) fn unmap(&mut self, window: u32) {
        self.send(10, 0, &[window]);
    }

    /// Puts it on the screen again.
    pub(super) fn map(&mut self, window: u32) {
        self.send(8, 0, &[window]);
    }

    /// Ends the connection of the program whose window it is.
    pub(super) fn kill(&mut self, window: u32) {
        self.send(113, 0, &[window]);
    }

    /// Gives the window the keyboard, and presses a key and lets it go.
    pub(super) fn press(&mut self, window: u32, key: u8) {
        self.events(window, &[(2, key), (3, key)]);
    }

    /// The same while another key is held down.
    pub(super) fn press_with(&mut self, window: u32, held: u8, key: u8) {
        self.events(window, &[(2, held), (2, key), (3, key), (3, held)]);
    }

    fn events(&mut self, window: u32, events: &[(u32, u8)]) {
        self.send(42, 1, &[window, 0]); // SetInputFocus
        let name = u32::from_le_bytes(*b"XTES");
        self.request(98, 0, &[5, name, u32::from(b'T')]); // QueryExtension
        let reply = self.reply();
        assert_eq!(reply[8], 1, "the server has XTEST");
        for &(event, key) in events {
            let what = event | u32::from(key) << 8;
            self.send(reply[9], 2, &[what, 0, 0, 0, 0, 0, 0, 0]); // FakeInput
        }
    }

    pub(super) fn request(&mut self, opcode: u8, detail: u8, words: &[u32]) {
        let length = u16::try_from(words.len() + 1).expect("a short request");
        let mut request = vec![opcode, detail];
        request.extend(length.to_le_bytes());
        request.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        self.stream.write_all(&request).expect("the server listens");
    }

    /// Sends a request without a reply and waits until it is done, as the server forgets the requests of a client that
    /// has left.
    pub(super) fn send(&mut self, opcode: u8, detail: u8, words: &[u32]) {
        self.request(opcode, detail, words);
        self.request(43, 0, &[]); // GetInputFocus
        self.reply();
    }

    /// A reply's first 32 bytes.
    pub(super) fn reply(&mut self) -> [u8; 32] {
        let mut head = [0; 32];
        self.stream.read_exact(&mut head).expect("a reply");
        while head[0] > 1 {
            // Some events go to everybody.
            self.stream.read_exact(&mut head).expect("a reply");
        }
        assert_eq!(head[0], 1, "no error: {head:?}");
        head
    }
}

pub(super) fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..][..4].try_into().expect("four bytes"))
}
