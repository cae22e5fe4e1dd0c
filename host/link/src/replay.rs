//! A device that answers as it once did.

use super::port::SerialLink;
use super::tap::{Exchange, Way};
use crate::error::{Error, Place, Result};
use std::collections::VecDeque;
use std::path::Path;
use std::time::Duration;

/// What a [`super::Tap`] wrote down, as a port: whoever sends the same bytes gets the same answers
/// at the same times.
#[derive(Debug)]
pub struct Replay {
    name: String,
    baud: u32,
    left: VecDeque<Exchange>,
    /// Bytes sent and not yet met in the record.
    sent: VecDeque<u8>,
    now: Duration,
}

impl Replay {
    /// Of these exchanges.
    pub fn new(name: &str, baud: u32, exchanges: impl IntoIterator<Item = Exchange>) -> Self {
        Replay {
            name: name.to_string(),
            baud,
            left: exchanges.into_iter().collect(),
            sent: VecDeque::new(),
            now: Duration::ZERO,
        }
    }

    /// Of a file a tap wrote.
    ///
    /// # Errors
    /// A file that cannot be read, a line that is no exchange.
    pub fn open(path: &Path, baud: u32) -> Result<Self> {
        let text =
            std::fs::read_to_string(path).map_err(|error| Error::file(path, "read", error))?;
        let exchange = |(at, line): (usize, &str)| {
            Exchange::parse(line).ok_or_else(|| {
                let what = "not a recorded exchange such as `0.001234 > ff ff 01 02 01 fb`";
                Error::data(
                    Place::at(path, at + 1, 1),
                    what,
                    "give a file written by --tap, or delete the line",
                )
            })
        };
        let exchanges: Vec<Exchange> = text
            .lines()
            .enumerate()
            .map(exchange)
            .collect::<Result<_>>()?;
        Ok(Replay::new(&path.display().to_string(), baud, exchanges))
    }

    fn meet(&mut self) -> Result<()> {
        while let Some(next) = self.left.front().filter(|next| next.way == Way::Out) {
            if self.sent.len() < next.bytes.len() {
                return Ok(());
            }
            if !next
                .bytes
                .iter()
                .eq(self.sent.iter().take(next.bytes.len()))
            {
                return Err(Error::device(
                    format!(
                        "{}: at {:.6} s other bytes are sent than were recorded",
                        self.name,
                        next.time.as_secs_f64()
                    ),
                    "replay a record with the very command that made it",
                ));
            }
            self.sent.drain(..next.bytes.len());
            self.now = self.now.max(next.time);
            self.left.pop_front();
        }
        Ok(())
    }
}

impl SerialLink for Replay {
    fn name(&self) -> &str {
        &self.name
    }

    fn baud(&self) -> u32 {
        self.baud
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.baud = baud;
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        self.sent.extend(bytes);
        self.meet()
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let until = self.now + wait;
        let Some(next) = self
            .left
            .front_mut()
            .filter(|next| next.way == Way::In && next.time <= until)
        else {
            self.now = until;
            return Ok(0);
        };
        let count = next.bytes.len().min(bytes.len());
        bytes[..count].copy_from_slice(&next.bytes[..count]);
        next.bytes.drain(..count);
        self.now = self.now.max(next.time);
        if next.bytes.is_empty() {
            self.left.pop_front();
        }
        self.meet()?;
        Ok(count)
    }

    fn clear(&mut self) -> Result<()> {
        Ok(())
    }

    fn now(&self) -> Duration {
        self.now
    }

    fn pause(&mut self, time: Duration) {
        self.now += time;
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(34)
    }
}
