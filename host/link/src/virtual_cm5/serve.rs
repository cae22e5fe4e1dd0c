//! Serve a simulated device on a pseudo terminal in real time.

use crate::error::Result;
use crate::{Pty, SerialLink};
use std::time::{Duration, Instant};

/// The line counts as busy for this long after its last byte.
const BUSY: Duration = Duration::from_millis(100);

/// Pass bytes between `device` and the program at `pty`, simulated time following real time, while
/// `goes_on`, which gets the time since the beginning.
///
/// # Errors
/// The pseudo terminal fails, or those of `goes_on`.
pub fn serve(
    device: &mut dyn SerialLink,
    pty: &Pty,
    mut goes_on: impl FnMut(Duration) -> Result<bool>,
) -> Result<()> {
    let (started, offset) = (Instant::now(), device.now());
    let mut last_byte = Duration::ZERO;
    let mut bytes = [0; 512];
    loop {
        let now = started.elapsed();
        if !goes_on(now)? {
            return Ok(());
        }
        device.pause((now + offset).saturating_sub(device.now()));
        let count = device.receive(&mut bytes, Duration::ZERO)?;
        if count > 0 {
            pty.send(&bytes[..count])?;
            last_byte = now;
        }
        // Replies are near while the line is busy; an idle port should cost nothing.
        let wait = if now.saturating_sub(last_byte) < BUSY {
            Duration::from_micros(100)
        } else {
            Duration::from_millis(2)
        };
        let count = pty.receive(&mut bytes, wait)?;
        if count > 0 {
            last_byte = now;
            device.pause((started.elapsed() + offset).saturating_sub(device.now()));
            device.set_baud(pty.baud())?;
            device.send(&bytes[..count])?;
        }
    }
}
