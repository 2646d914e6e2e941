//! A headless Chromium, driven through chromedriver by WebDriver's JSON over HTTP.

use std::io::{BufRead, BufReader, ErrorKind, Lines, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

use crate::folder::PATIENCE;

/// Keys, as WebDriver has them.
pub(crate) const TAB: &str = "\u{e004}";
pub(crate) const ENTER: &str = "\u{e007}";
pub(crate) const HOME: &str = "\u{e011}";
pub(crate) const LEFT: &str = "\u{e012}";
pub(crate) const UP: &str = "\u{e013}";
pub(crate) const RIGHT: &str = "\u{e014}";

/// How often chromedriver is started before it names a port. It chooses one of IPv6 and ends if another program has that
/// of IPv4.
const TRIES: u32 = 5;

type Output = Lines<BufReader<ChildStdout>>;

/// Starts chromedriver; `None` where there is none.
fn start_driver() -> Option<(Child, u16, Output)> {
    for _ in 0..TRIES {
        let started = Command::new("chromedriver")
            .arg("--port=0")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut driver = match started {
            Err(error) if error.kind() == ErrorKind::NotFound => return None,
            started => started.expect("chromedriver starts"),
        };
        let mut lines = BufReader::new(driver.stdout.take().expect("its output")).lines();
        let port = lines.by_ref().find_map(|line| port(&line.expect("a line")));
        if let Some(port) = port {
            return Some((driver, port, lines));
        }
        let status = driver.wait().expect("chromedriver ends");
        eprintln!("chromedriver names no port: {status}");
    }
    panic!("chromedriver was started {TRIES} times and names no port");
}

/// A browser with one page.
pub(crate) struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    /// Starts one that keeps everything in this folder and saves files there; `None` where there is no chromedriver.
    pub(crate) fn start(folder: &Path) -> Option<Self> {
        let (driver, port, lines) = start_driver()?;
        let mut browser = Self {
            driver,
            port,
            session: String::new(),
        };
        // What else it says must not fill the pipe.
        std::thread::spawn(move || lines.for_each(drop));
        let profile = format!("--user-data-dir={}", folder.join("profile").display());
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--disable-dev-shm-usage",
            // Scripts of the tests read the pixels of pictures.
            "--allow-file-access-from-files",
            &profile,
        ];
        let options = json!({ "args": arguments });
        let wanted =
            json!({ "capabilities": { "alwaysMatch": { "goog:chromeOptions": options } } });
        let session = browser.request("POST", "/session", Some(&wanted));
        browser.session = session["sessionId"].as_str().expect("a session").into();
        let downloads = json!({ "behavior": "allow", "downloadPath": folder });
        browser.devtools("Browser.setDownloadBehavior", downloads);
        Some(browser)
    }

    /// Makes the page as large as a phone's or a desktop's.
    pub(crate) fn resize(&self, width: u32, height: u32) {
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.devtools("Emulation.setDeviceMetricsOverride", size);
    }

    /// Opens an address.
    pub(crate) fn open(&self, address: &str) {
        self.post("url", &json!({ "url": address }));
    }

    /// Loads the page again.
    pub(crate) fn reload(&self) {
        self.post("refresh", &json!({}));
    }

    /// Runs JavaScript, the body of a function, and returns what it returns.
    pub(crate) fn run(&self, script: &str) -> Value {
        self.post("execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// The text that JavaScript returns.
    pub(crate) fn text(&self, script: &str) -> String {
        let value = self.run(script);
        value
            .as_str()
            .unwrap_or_else(|| panic!("{script}: {value}"))
            .into()
    }

    /// Presses keys one after the other, each a character.
    pub(crate) fn press(&self, keys: &str) {
        let each = keys.chars().flat_map(|key| {
            ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": key.to_string() }))
        });
        let actions =
            json!([{ "type": "key", "id": "keyboard", "actions": each.collect::<Vec<_>>() }]);
        self.post("actions", &json!({ "actions": actions }));
    }

    fn devtools(&self, command: &str, parameters: Value) {
        let content = json!({ "cmd": command, "params": parameters });
        self.post("goog/cdp/execute", &content);
    }

    fn post(&self, command: &str, content: &Value) -> Value {
        let path = format!("/session/{}/{command}", self.session);
        self.request("POST", &path, Some(content))
    }

    /// Sends a command and returns the value of the answer.
    fn request(&self, method: &str, path: &str, content: Option<&Value>) -> Value {
        let mut stream =
            TcpStream::connect(("127.0.0.1", self.port)).expect("chromedriver listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let content = content.map(Value::to_string).unwrap_or_default();
        let request = format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Type: application/json\r\n\
             Content-Length: {}\r\nConnection: close\r\n\r\n{content}",
            self.port,
            content.len()
        );
        stream.write_all(request.as_bytes()).expect("it is sent");
        let mut reader = BufReader::new(stream);
        let (mut line, mut length) = (String::new(), 0);
        while line != "\r\n" {
            line.clear();
            let read = reader.read_line(&mut line).expect("an answer");
            assert!(read > 0, "{method} {path}: the answer ends in its head");
            if let Some((name, value)) = line.split_once(':')
                && name.eq_ignore_ascii_case("content-length")
            {
                length = value.trim().parse().expect("a length");
            }
        }
        let mut answer = vec![0; length];
        reader.read_exact(&mut answer).expect("the whole answer");
        let mut answer: Value = serde_json::from_slice(&answer).expect("JSON");
        let value = answer["value"].take();
        assert!(
            value.get("error").is_none(),
            "{method} {path} {content}: {value:#}"
        );
        value
    }
}

/// The port in what chromedriver says when it has started.
fn port(line: &str) -> Option<u16> {
    let (_, port) = line.split_once("started successfully on port ")?;
    port.trim_end_matches('.').parse().ok()
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() && !std::thread::panicking() {
            self.request("DELETE", &format!("/session/{}", self.session), None);
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
