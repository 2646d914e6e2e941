//! A file manager's part of dropping files on a window, by the protocol XDND.

use std::io::Read;
use std::path::Path;

use super::x11::{Client, word};

/// Events by their numbers.
const SELECTION_REQUEST: u8 = 30;
const SELECTION_NOTIFY: u32 = 31;
const CLIENT_MESSAGE: u32 = 33;

impl Client {
    /// Drops files on the middle of a window. They are there, and their names need no quoting in an address.
    pub(super) fn drop_files(&mut self, window: u32, files: &[&Path]) {
        // Each drag comes from a window of its own: what is left of the last one does not disturb it.
        self.base += 1;
        let source = self.base;
        // CreateWindow, one pixel large, which is never shown.
        self.send(1, 0, &[source, self.root, 0, 1 | 1 << 16, 0, 0, 0]);
        let names = ["XdndEnter", "XdndPosition", "XdndDrop", "XdndSelection"];
        let [enter, position, drop, selection] = names.map(|name| self.atom(name));
        let (list, copy) = (self.atom("text/uri-list"), self.atom("XdndActionCopy"));
        self.send(22, 0, &[source, selection, 0]); // SetSelectionOwner
        let version = 5 << 24;
        self.tell(window, enter, [source, version, list, 0, 0]);
        let middle = 20 << 16 | 20;
        self.tell(window, position, [source, 0, middle, 0, copy]);
        // The window wants to know what is dragged over it.
        let asked = self.event(SELECTION_REQUEST);
        let [time, requestor, target, property] = [4, 12, 20, 24].map(|at| word(&asked, at));
        let address = |file: &&Path| format!("file://{}\r\n", file.display());
        let text: String = files.iter().map(address).collect();
        let mut change = vec![requestor, property, target, 8, text.len() as u32];
        change.extend(words(text.as_bytes()));
        self.request(18, 0, &change); // ChangeProperty
        let answer = [time, requestor, selection, target, property, 0, 0];
        let mut event = vec![requestor, 0, SELECTION_NOTIFY];
        event.extend(answer);
        self.request(25, 0, &event); // SendEvent
        self.tell(window, drop, [source, 0, 0, 0, 0]);
        self.request(43, 0, &[]); // GetInputFocus: all before it is done when it is answered
        self.reply();
    }

    /// The number of a name.
    fn atom(&mut self, name: &str) -> u32 {
        let mut request = vec![name.len() as u32];
        request.extend(words(name.as_bytes()));
        self.request(16, 0, &request); // InternAtom
        word(&self.reply(), 8)
    }

    /// Sends a window a message of a type.
    fn tell(&mut self, window: u32, of: u32, data: [u32; 5]) {
        let mut event = vec![window, 0, CLIENT_MESSAGE | 32 << 8, window, of];
        event.extend(data);
        self.request(25, 0, &event); // SendEvent
    }

    /// The next event of this number.
    fn event(&mut self, number: u8) -> [u8; 32] {
        loop {
            let mut event = [0; 32];
            self.stream.read_exact(&mut event).expect("an event");
            if event[0] & 0x7f == number {
                return event;
            }
            assert!(event[0] > 1, "no error: {event:?}");
        }
    }
}

/// Bytes as the words of a request, with zeros behind.
fn words(bytes: &[u8]) -> Vec<u32> {
    let whole = |chunk: &[u8]| {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(word)
    };
    bytes.chunks(4).map(whole).collect()
}
