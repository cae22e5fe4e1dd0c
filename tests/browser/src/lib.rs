//! A headless Chromium, driven over its DevTools protocol: what is clicked, typed, seen; and a
//! running lab, asked as its pages ask it, without a browser. Tests and measurements of the lab use
//! them. What goes wrong ends in a panic: there is no test without it.

mod lab;
mod look;

pub use lab::{LabServer, PATIENCE, Response};

use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// Longer than anything a browser does takes on a busy machine.
const BROWSER_PATIENCE: Duration = Duration::from_secs(240);

/// Between two questions to a page that is not there yet.
const POLL: Duration = Duration::from_millis(40);

/// Whether a call failed because its page gave way to another.
fn has_left(error: &Value) -> bool {
    let text = error["message"].as_str().unwrap_or_default();
    ["navigated", "context was destroyed", "Cannot find context"]
        .iter()
        .any(|sign| text.contains(sign))
}

/// A browser with one page.
#[derive(Debug)]
pub struct Browser {
    child: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    session: String,
    calls: u64,
    /// What scripts complained of, and what is wrong with pages.
    pub complaints: Vec<String>,
    /// Where pictures go.
    pictures: PathBuf,
    _profile: TempDir,
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may be over before it is ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program, if there is one.
fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let files = names
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    files.into_iter().find(|file| file.is_file())
}

impl Browser {
    /// Starts it; `None`, and a line that says so, where there is no Chromium. Pictures go into the
    /// folder `pictures`.
    pub fn start(pictures: &Path) -> Option<Browser> {
        let Some(program) = chromium() else {
            println!("skipped: there is no chromium on the path");
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new(program)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--no-first-run",
            ])
            .args([
                "--disable-background-networking",
                "--disable-component-update",
            ])
            .args([
                "--disable-sync",
                "--remote-debugging-port=0",
                "--window-size=1280,900",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines.find_map(|line| {
            let line = line.unwrap();
            Some(line.strip_prefix("DevTools listening on ")?.to_string())
        });
        // It would stand still with a full pipe.
        std::thread::spawn(move || lines.for_each(drop));
        let (socket, _) = tungstenite::connect(address.expect("it listens")).unwrap();
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(BROWSER_PATIENCE)).unwrap();
        }
        let mut browser = Browser {
            child,
            socket,
            session: String::new(),
            calls: 0,
            complaints: Vec::new(),
            pictures: pictures.to_path_buf(),
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let asked = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = browser.call("Target.attachToTarget", asked);
        browser.session = attached["sessionId"].as_str().unwrap().to_string();
        for domain in ["Page", "Runtime", "Log", "DOM"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }

    /// A call of the protocol; complaints that come meanwhile are kept.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.try_call(method, parameters)
            .unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// A call of the protocol, or the browser's own error.
    fn try_call(&mut self, method: &str, parameters: Value) -> Result<Value, Value> {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if !self.session.is_empty() {
            call["sessionId"] = json!(self.session);
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else {
                continue;
            };
            let said: Value = serde_json::from_str(&text).unwrap();
            match said["method"].as_str() {
                Some("Runtime.exceptionThrown") => {
                    self.complaints
                        .push(said["params"]["exceptionDetails"].to_string());
                }
                Some("Log.entryAdded") if said["params"]["entry"]["level"] == "error" => {
                    self.complaints.push(said["params"]["entry"].to_string());
                }
                _ => {}
            }
            if said["id"] == self.calls {
                return if said["error"].is_null() {
                    Ok(said["result"].clone())
                } else {
                    Err(said["error"].clone())
                };
            }
        }
    }

    /// Opens an address, and waits for its end.
    pub fn open(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
        self.until("document.readyState === 'complete'");
    }

    /// The value of an expression of the page; a promise is waited for. A page that gives way to
    /// another meanwhile cannot answer: then the next one is asked.
    pub fn value(&mut self, expression: &str) -> Value {
        let asked = json!({
            "expression": expression, "returnByValue": true, "awaitPromise": true,
        });
        let begun = Instant::now();
        loop {
            match self.try_call("Runtime.evaluate", asked.clone()) {
                Ok(answer) => return answer["result"]["value"].clone(),
                Err(error) => assert!(
                    has_left(&error) && begun.elapsed() < BROWSER_PATIENCE,
                    "{expression}: {error}"
                ),
            }
            std::thread::sleep(POLL);
        }
    }

    /// Waits until an expression holds.
    pub fn until(&mut self, expression: &str) {
        let begun = Instant::now();
        while self.value(&format!("Boolean({expression})")) != json!(true) {
            if begun.elapsed() > BROWSER_PATIENCE {
                let message = self.value("document.getElementById('message')?.textContent");
                panic!("not in {BROWSER_PATIENCE:?}: {expression}; the page says {message}");
            }
            std::thread::sleep(POLL);
        }
    }

    /// A number that the page has. While it loads again it has none: it is asked until it has.
    pub fn number(&mut self, expression: &str) -> f64 {
        let begun = Instant::now();
        loop {
            if let Some(number) = self.value(expression).as_f64() {
                return number;
            }
            assert!(
                begun.elapsed() < BROWSER_PATIENCE,
                "no number in {BROWSER_PATIENCE:?}: {expression}"
            );
            std::thread::sleep(POLL);
        }
    }

    /// Text of an element.
    pub fn text(&mut self, selector: &str) -> String {
        let text = self.value(&format!("document.querySelector('{selector}').textContent"));
        text.as_str().unwrap_or_default().to_string()
    }

    /// Focuses an element, and presses a key there: the keyboard alone must suffice.
    pub fn press_on(&mut self, selector: &str, key: &str) {
        // Before its scripts run, a page does not notice what is pressed.
        self.until("document.readyState === 'complete'");
        self.until(&format!(
            "document.querySelector('{selector}')?.disabled === false \
                             || document.querySelector('{selector}')?.disabled === undefined \
                             && document.querySelector('{selector}')"
        ));
        // What is still hidden takes no focus.
        self.until(&format!(
            "(it => {{ it.focus(); return document.activeElement === it; }}) \
             (document.querySelector('{selector}'))"
        ));
        self.press(key);
    }

    /// Presses a key.
    pub fn press(&mut self, key: &str) {
        let (text, code) = match key {
            "Enter" => ("\r", 13),
            "ArrowRight" => ("", 39),
            "ArrowLeft" => ("", 37),
            "Tab" => ("", 9),
            other => (other, 0),
        };
        for kind in ["keyDown", "keyUp"] {
            let mut event = json!({
                "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code,
            });
            if kind == "keyDown" && !text.is_empty() {
                event["text"] = json!(text);
            }
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// Gives files to an input for files, as a choice of them does.
    pub fn choose_files(&mut self, selector: &str, files: &[&Path]) {
        // Before its script runs, a page does not notice what is chosen.
        self.until("document.readyState === 'complete'");
        let document = self.call("DOM.getDocument", json!({}));
        let root = &document["root"]["nodeId"];
        let found = self.call(
            "DOM.querySelector",
            json!({ "nodeId": root, "selector": selector }),
        );
        let asked = json!({ "nodeId": found["nodeId"], "files": files });
        self.call("DOM.setFileInputFiles", asked);
    }
}
