//! A serial port of this computer.

use super::port::{LineWriter, SerialLink};
use crate::error::{Error, Result};
use serialport::{ClearBuffer, ErrorKind as Kind, SerialPort};
use std::io::{ErrorKind, Read as _, Write as _};
use std::time::{Duration, Instant};

/// FTDI and similar adapters hold bytes back for up to 16 ms each way.
const LATENCY: Duration = Duration::from_millis(34);

/// An open serial port: 8 data bits, no parity, one stop bit, nobody else on it.
pub struct Serial {
    name: String,
    baud: u32,
    port: Box<dyn SerialPort>,
    opened: Instant,
}

impl Serial {
    /// Opens it.
    ///
    /// # Errors
    /// [`Error::Device`]: it is not there, not ours to use, in use, or cannot run at this speed.
    pub fn open(name: &str, baud: u32) -> Result<Serial> {
        let port = serialport::new(name, baud)
            .timeout(Duration::from_millis(100))
            .open();
        let port = port.map_err(|error| refused(name, baud, &error))?;
        // What an earlier program left unread is no answer to us.
        port.clear(ClearBuffer::All)
            .map_err(|error| refused(name, baud, &error))?;
        Ok(Serial {
            name: name.to_string(),
            baud,
            port,
            opened: Instant::now(),
        })
    }

    fn lost(&self, error: &std::io::Error) -> Error {
        lost(&self.name, error)
    }
}

impl SerialLink for Serial {
    fn name(&self) -> &str {
        &self.name
    }

    fn baud(&self) -> u32 {
        self.baud
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.port
            .set_baud_rate(baud)
            .map_err(|error| refused(&self.name, baud, &error))?;
        self.baud = baud;
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        // Long texts take their time on a slow line.
        let time = self.line_time(bytes.len()) + Duration::from_secs(1);
        let slow = self.port.set_timeout(time).map_err(std::io::Error::from);
        slow.and_then(|()| self.port.write_all(bytes))
            .map_err(|error| self.lost(&error))
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let wait = wait.max(Duration::from_millis(1));
        self.port
            .set_timeout(wait)
            .map_err(|error| self.lost(&error.into()))?;
        match self.port.read(bytes) {
            Ok(count) => Ok(count),
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::TimedOut | ErrorKind::Interrupted | ErrorKind::WouldBlock
                ) =>
            {
                Ok(0)
            }
            Err(error) => Err(self.lost(&error)),
        }
    }

    fn clear(&mut self) -> Result<()> {
        self.port
            .clear(ClearBuffer::Input)
            .map_err(|error| self.lost(&error.into()))
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn pause(&mut self, time: Duration) {
        std::thread::sleep(time);
    }

    fn latency(&self) -> Duration {
        LATENCY
    }

    fn second_writer(&self) -> Option<LineWriter> {
        Some(Box::new(self.port.try_clone().ok()?))
    }
}

/// What to do about a port that may not be opened.
pub const PERMISSION_REMEDY: &str = "join the group that owns serial ports, then log in again: \
     sudo usermod -aG dialout $USER";

/// Whether this user may read and write a port; it is not opened, which would tell the device.
pub fn may_open(name: &str) -> bool {
    #[cfg(unix)]
    {
        use rustix::fs::{Access, access};
        access(name, Access::READ_OK | Access::WRITE_OK).is_ok()
    }
    #[cfg(not(unix))]
    {
        ports().iter().any(|port| port == name)
    }
}

/// Names of the serial ports that are there.
pub fn ports() -> Vec<String> {
    let found = serialport::available_ports().unwrap_or_default();
    found.into_iter().map(|port| port.port_name).collect()
}

fn lost(name: &str, error: &std::io::Error) -> Error {
    Error::device(
        format!("{name}: the port failed: {error}"),
        "was the adapter unplugged? plug it in and try again",
    )
}

fn refused(name: &str, baud: u32, error: &serialport::Error) -> Error {
    let text = error.description.to_lowercase();
    let (what, remedy) = match error.kind() {
        Kind::Io(ErrorKind::PermissionDenied) => (
            "no permission to open it".to_string(),
            PERMISSION_REMEDY.to_string(),
        ),
        _ if text.contains("busy") || text.contains("lock") => (
            "another program uses it".to_string(),
            format!("close that program; `fuser {name}` names it"),
        ),
        Kind::NoDevice | Kind::Io(ErrorKind::NotFound) => {
            ("there is no such port".to_string(), there_are())
        }
        Kind::InvalidInput => (
            format!("it cannot run at {baud} baud"),
            "57600 is the CM-5's speed, 1000000 the servos' own".to_string(),
        ),
        _ => (
            format!("cannot be opened: {}", error.description),
            there_are(),
        ),
    };
    Error::device(format!("{name}: {what}"), remedy)
}

fn there_are() -> String {
    match ports().as_slice() {
        [] => "no serial port is there: plug the adapter in, or try without hardware: --port sim"
            .to_string(),
        names => format!("there are: {}", names.join(", ")),
    }
}
