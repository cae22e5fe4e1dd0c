//! A boot loader that behaves like the CM-5's, on a pseudo terminal: ours, after its protocol.

use handstand::link::Pty;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trouble {
    None,
    /// It never answers.
    Silence,
    /// It falls silent after `Ready..`.
    SilentAfterReady,
    /// Every hundredth byte gets lost.
    LosesBytes,
    /// A byte arrives wrong.
    WrongByte,
    /// Flash does not hold what was received.
    BadFlash,
}

/// The port it is on, and what it did: `sys`, `flash`, `app`, `go`.
pub struct Loader {
    pub port: String,
    pub did: Receiver<(String, Vec<u8>)>,
}

/// Starts it; it ends by itself after a few seconds of silence.
pub fn start(trouble: Trouble) -> Loader {
    start_then(trouble, |_, _| ())
}

/// The same; after every `go` the line and what was flashed are `then`'s until it returns.
pub fn start_then(trouble: Trouble, mut then: impl FnMut(&Pty, &[u8]) + Send + 'static) -> Loader {
    let pty = Pty::open().unwrap();
    let port = pty.name().to_string();
    let (tell, did) = channel();
    std::thread::spawn(move || {
        let say = |text: &str| pty.send(text.as_bytes()).unwrap();
        let waiting = RefCell::new(VecDeque::<u8>::new());
        let hear = |ms| {
            let mut waiting = waiting.borrow_mut();
            if waiting.is_empty() {
                let mut bytes = [0; 512];
                let count = pty.receive(&mut bytes, Duration::from_millis(ms)).unwrap();
                waiting.extend(&bytes[..count]);
            }
            waiting.pop_front()
        };
        if trouble == Trouble::Silence {
            while hear(3000).is_some() {}
            return;
        }
        let (mut knocks, mut line, mut flash) = (0, String::new(), Vec::new());
        // Whoever is to knock may have a program to build first.
        while let Some(byte) = hear(if knocks == 0 { 120_000 } else { 5000 }) {
            // The reset button is pressed at the fifth knock.
            if knocks < 5 {
                knocks += u32::from(byte == b'#');
                if knocks == 5 {
                    say("\r\nSYSTEM O.K. (CM5 Boot loader V1.31)\r\n");
                }
                continue;
            }
            if byte != b'\r' {
                line.push(char::from(byte));
                continue;
            }
            match std::mem::take(&mut line).trim_matches('#') {
                "load 0" => {
                    say("Ready..\r\n");
                    let mut received: Vec<u8> = Vec::new();
                    let mut count = 0;
                    // The first byte may take its time.
                    while let Some(byte) = hear(if received.is_empty() { 2000 } else { 150 }) {
                        count += 1;
                        let lost = trouble == Trouble::LosesBytes && count % 100 == 0;
                        let wrong = trouble == Trouble::WrongByte && count == 77;
                        if !lost {
                            received.push(if wrong { !byte } else { byte });
                        }
                    }
                    if trouble == Trouble::SilentAfterReady {
                        continue;
                    }
                    let theirs = received.pop().unwrap_or(0);
                    let ours = received
                        .iter()
                        .fold(0u8, |sum, byte| sum.wrapping_add(*byte));
                    let word = if ours == theirs { "Success" } else { "Error" };
                    say(&format!(
                        "{word}\r\nSize:{}\r\nChecksum:{ours:02X}-{theirs:02X}\r\n- ",
                        received.len()
                    ));
                    flash = received;
                    tell.send(("flash".to_string(), flash.clone())).unwrap();
                }
                "verify" if trouble == Trouble::BadFlash => say("Error at 0100\r\n- "),
                "verify" => say(&format!("{} bytes O.K.\r\n- ", flash.len())),
                "go" => {
                    tell.send(("go".to_string(), Vec::new())).unwrap();
                    then(&pty, &flash);
                }
                word @ ("app" | "sys") => {
                    tell.send((word.to_string(), Vec::new())).unwrap();
                    say("\r\n- ");
                }
                _ => say("\r\n- "),
            }
        }
    });
    Loader { port, did }
}
