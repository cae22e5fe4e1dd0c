//! Writing down all that passes a line.

use super::port::{SerialLink, left_to_inner};
use crate::error::{Error, Result};
use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

/// Which way bytes went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// To the device.
    Out,
    /// From the device.
    In,
}

/// Bytes that passed, and when.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exchange {
    /// By the line's clock.
    pub time: Duration,
    /// Which way.
    pub way: Way,
    /// The bytes.
    pub bytes: Vec<u8>,
}

impl Exchange {
    /// As a line of text: `0.001234 > ff ff 01 02 01 fb`.
    pub fn line(&self) -> String {
        let mut line = format!(
            "{:.6} {}",
            self.time.as_secs_f64(),
            if self.way == Way::Out { '>' } else { '<' }
        );
        for byte in &self.bytes {
            let _ = write!(line, " {byte:02x}");
        }
        line
    }

    /// Reads [`Exchange::line`].
    pub fn parse(line: &str) -> Option<Exchange> {
        let mut words = line.split_whitespace();
        let time: f64 = words.next()?.parse().ok()?;
        let way = match words.next()? {
            ">" => Way::Out,
            "<" => Way::In,
            _ => return None,
        };
        let bytes = words
            .map(|word| u8::from_str_radix(word, 16).ok())
            .collect::<Option<_>>()?;
        Some(Exchange {
            time: Duration::try_from_secs_f64(time).ok()?,
            way,
            bytes,
        })
    }
}

/// A line that writes down what passes.
pub struct Tap<L> {
    inner: L,
    hear: Box<dyn FnMut(&Exchange) + Send>,
}

impl<L: SerialLink> Tap<L> {
    /// Hands everything that passes to `hear`.
    pub fn new(inner: L, hear: impl FnMut(&Exchange) + Send + 'static) -> Self {
        Tap {
            inner,
            hear: Box::new(hear),
        }
    }

    /// Writes everything that passes to a file, line by line.
    ///
    /// # Errors
    /// The file exists, or the system refuses it.
    pub fn to_file(inner: L, path: &Path) -> Result<Self> {
        use std::io::Write as _;
        let refused = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => {
                Error::usage(format!("{} exists", path.display()), "choose another name")
            }
            _ => Error::file(path, "write", error),
        };
        let mut file = std::fs::File::create_new(path).map_err(refused)?;
        // A full disk must not stop a robot in motion: what cannot be written is lost.
        Ok(Tap::new(inner, move |exchange| {
            let _ = writeln!(file, "{}", exchange.line());
        }))
    }

    fn tell(&mut self, way: Way, bytes: &[u8]) {
        if !bytes.is_empty() {
            let time = self.inner.now();
            (self.hear)(&Exchange {
                time,
                way,
                bytes: bytes.to_vec(),
            });
        }
    }
}

impl<L: SerialLink> SerialLink for Tap<L> {
    left_to_inner!();

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        self.tell(Way::Out, bytes);
        self.inner.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let count = self.inner.receive(bytes, wait)?;
        self.tell(Way::In, &bytes[..count]);
        Ok(count)
    }
}
