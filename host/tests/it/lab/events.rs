//! A page that hears the robot's events, and answers that it is there.

use super::server::{LabServer, PATIENCE};
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A page without a browser.
pub struct Watcher<'a> {
    server: &'a LabServer,
    /// Its number.
    pub viewer: u64,
    stream: TcpStream,
    heard: Arc<Mutex<Vec<(String, Value)>>>,
    answers: Arc<AtomicBool>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl<'a> Watcher<'a> {
    /// Opens the events of session 1.
    pub fn new(server: &'a LabServer) -> Self {
        let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let head = format!(
            "GET /s/1/live HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nCookie: {}\r\n\r\n",
            server.port, server.cookies
        );
        stream.write_all(head.as_bytes()).unwrap();
        let (heard, answers) = (Arc::default(), Arc::new(AtomicBool::new(true)));
        let mut watcher = Watcher {
            server,
            viewer: 0,
            heard: Arc::clone(&heard),
            answers: Arc::clone(&answers),
            thread: None,
            stream: stream.try_clone().unwrap(),
        };
        let (port, cookies) = (server.port, server.cookies.clone());
        watcher.thread = Some(std::thread::spawn(move || {
            hear(stream, &heard, |viewer| {
                if answers.load(Ordering::Relaxed) {
                    is_here(port, &cookies, viewer);
                }
            });
        }));
        watcher.viewer = watcher.until("hello", |_| true)["viewer"].as_u64().unwrap();
        watcher
    }

    /// Says no more that it is there, as a page that hangs.
    pub fn hangs(&self) {
        self.answers.store(false, Ordering::Relaxed);
    }

    /// Goes away, as a page that is closed.
    pub fn goes(mut self) {
        self.close();
    }

    fn close(&mut self) {
        // It may be closed already.
        let _ = self.stream.shutdown(Shutdown::Both);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }

    /// Asks for a run; the status of the answer.
    pub fn begin(&self, task: &Value) -> u16 {
        let asked = json!({ "viewer": self.viewer, "task": task });
        self.server.post("/s/1/live/begin", &asked).status
    }

    /// Answers a question.
    pub fn answer(&self, yes: bool) -> u16 {
        let said = json!({ "viewer": self.viewer, "yes": yes });
        self.server.post("/s/1/live/answer", &said).status
    }

    /// All events of this name so far.
    pub fn all(&self, name: &str) -> Vec<Value> {
        let heard = self.heard.lock().unwrap();
        let own = heard.iter().filter(|(own, _)| own == name);
        own.map(|(_, value)| value.clone()).collect()
    }

    /// Waits for an event like this.
    pub fn until(&self, name: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            if let Some(found) = self.all(name).into_iter().find(|value| is_it(value)) {
                return found;
            }
            assert!(
                begun.elapsed() < PATIENCE,
                "{name}: {:?}",
                self.all("phase")
            );
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits for a phase.
    pub fn phase(&self, phase: &str) -> Value {
        self.until("phase", |value| value["phase"] == phase)
    }

    /// Waits for a run of what is called so.
    pub fn runs(&self, what: &str) -> Value {
        self.until("phase", |value| {
            value["phase"] == "running" && value["what"] == what
        })
    }

    /// Says yes to every question until the robot balances.
    pub fn agrees_to_all(&self) {
        let mut answered = 0;
        let begun = Instant::now();
        loop {
            let phases = self.all("phase");
            let asked = phases
                .iter()
                .filter(|phase| phase["phase"] == "asking")
                .count();
            if asked > answered {
                assert_eq!(self.answer(true), 200);
                answered = asked;
            }
            if phases.iter().any(|phase| phase["what"] == "balancing") {
                return;
            }
            assert!(begun.elapsed() < PATIENCE, "{phases:?}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Watcher<'_> {
    fn drop(&mut self) {
        self.close();
    }
}

/// Hears until the connection ends; says on every tick that it is there.
fn hear(stream: TcpStream, heard: &Mutex<Vec<(String, Value)>>, mut here: impl FnMut(&Value)) {
    let (mut name, mut viewer) = (String::new(), Value::Null);
    for line in BufReader::new(stream).lines().map_while(Result::ok) {
        if let Some(event) = line.strip_prefix("event: ") {
            name = event.to_string();
        } else if let Some(data) = line.strip_prefix("data: ") {
            let value: Value = serde_json::from_str(data).unwrap();
            match name.as_str() {
                "hello" => viewer = value["viewer"].clone(),
                "tick" => here(&viewer),
                _ => {}
            }
            heard.lock().unwrap().push((name.clone(), value));
        }
    }
}

/// Says that the page is there. The lab may be over by then.
fn is_here(port: u16, cookies: &str, viewer: &Value) {
    let body = json!({ "viewer": viewer }).to_string();
    let head = format!(
        "POST /s/1/live/here HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookies}\r\n\
         Origin: http://127.0.0.1:{port}\r\nContent-Type: application/json\r\n\
         Content-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
    let Ok(mut stream) = TcpStream::connect(("127.0.0.1", port)) else {
        return;
    };
    if stream.write_all(head.as_bytes()).is_ok() {
        let _ = stream.read_to_end(&mut Vec::new());
    }
}
