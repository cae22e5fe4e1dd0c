//! What every line of bytes can do.

use crate::error::Result;
use std::time::Duration;

/// Sends bytes on a line that another thread holds.
pub type LineWriter = Box<dyn std::io::Write + Send>;

/// A line of bytes, with the clock it runs by.
///
/// Waiting goes through the line, so that a simulated one needs no real time.
pub trait SerialLink: Send {
    /// How people know it: `/dev/ttyUSB0`.
    fn name(&self) -> &str;

    /// Its speed, baud; 10 bits make a byte.
    fn baud(&self) -> u32;

    /// Changes its speed.
    ///
    /// # Errors
    /// The device is gone, or cannot run so.
    fn set_baud(&mut self, baud: u32) -> Result<()>;

    /// Sends all bytes.
    ///
    /// # Errors
    /// The device is gone.
    fn send(&mut self, bytes: &[u8]) -> Result<()>;

    /// Waits at most `wait` for bytes; how many came. 0: none in time.
    ///
    /// # Errors
    /// The device is gone.
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize>;

    /// Forgets what came and was not received.
    ///
    /// # Errors
    /// The device is gone.
    fn clear(&mut self) -> Result<()>;

    /// Time since it was opened.
    fn now(&self) -> Duration;

    /// Lets time pass.
    fn pause(&mut self, time: Duration);

    /// The longest a byte may lie about on its way beside the line's own time: drivers, USB, other
    /// programs.
    fn latency(&self) -> Duration;

    /// Another way to speak on this line, for a thread that must not wait for this one; none on a
    /// line that ends with the program.
    fn second_writer(&self) -> Option<LineWriter> {
        None
    }

    /// Time of so many bytes on the line.
    fn line_time(&self, bytes: usize) -> Duration {
        Duration::from_secs_f64(bytes as f64 * 10.0 / f64::from(self.baud().max(1)))
    }
}

/// A line behind a pointer is a line.
macro_rules! passed_on {
    ($pointer:ty $(, $($generic:tt)*)?) => {
        impl$(<$($generic)*>)? SerialLink for $pointer {
            fn name(&self) -> &str {
                (**self).name()
            }
            fn baud(&self) -> u32 {
                (**self).baud()
            }
            fn set_baud(&mut self, baud: u32) -> Result<()> {
                (**self).set_baud(baud)
            }
            fn send(&mut self, bytes: &[u8]) -> Result<()> {
                (**self).send(bytes)
            }
            fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
                (**self).receive(bytes, wait)
            }
            fn clear(&mut self) -> Result<()> {
                (**self).clear()
            }
            fn now(&self) -> Duration {
                (**self).now()
            }
            fn pause(&mut self, time: Duration) {
                (**self).pause(time);
            }
            fn latency(&self) -> Duration {
                (**self).latency()
            }
            fn second_writer(&self) -> Option<LineWriter> {
                (**self).second_writer()
            }
        }
    };
}

passed_on!(Box<dyn SerialLink>);
passed_on!(&mut L, L: SerialLink);

/// Receives until `enough` says so or `deadline` (by the link's clock) has passed; what came.
///
/// # Errors
/// The device is gone.
pub fn read_some(
    link: &mut dyn SerialLink,
    deadline: Duration,
    mut enough: impl FnMut(&[u8]) -> bool,
) -> Result<Vec<u8>> {
    let mut all = Vec::new();
    let mut some = [0; 512];
    loop {
        let left = deadline.saturating_sub(link.now());
        let count = link.receive(&mut some, left)?;
        all.extend_from_slice(&some[..count]);
        if enough(&all) || link.now() >= deadline {
            return Ok(all);
        }
    }
}

/// What a line that wraps another in `inner` leaves to it: everything but `send` and `receive`.
macro_rules! left_to_inner {
    () => {
        fn name(&self) -> &str {
            self.inner.name()
        }

        fn baud(&self) -> u32 {
            self.inner.baud()
        }

        fn set_baud(&mut self, baud: u32) -> $crate::error::Result<()> {
            self.inner.set_baud(baud)
        }

        fn clear(&mut self) -> $crate::error::Result<()> {
            self.inner.clear()
        }

        fn now(&self) -> std::time::Duration {
            self.inner.now()
        }

        fn pause(&mut self, time: std::time::Duration) {
            self.inner.pause(time);
        }

        fn latency(&self) -> std::time::Duration {
            self.inner.latency()
        }

        fn second_writer(&self) -> Option<$crate::port::LineWriter> {
            self.inner.second_writer()
        }
    };
}
pub(crate) use left_to_inner;
