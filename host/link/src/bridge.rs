//! A CM-5 as an adapter: it passes bytes on.

use super::port::SerialLink;
use super::servos::Servos;
use super::session::Session;
use crate::error::Result;
use handstand_shared::message::{Command, Mode};
use std::time::Duration;

/// For so long after a mode was chosen the CM-5 repeats that torque is off.
const INSISTS: Duration = Duration::from_millis(250);

/// The servos behind a CM-5, which passes bytes on from now on.
///
/// # Errors
/// No firmware, or it refuses.
pub(super) fn bridged<L: SerialLink>(link: &mut L) -> Result<Servos<&mut L>> {
    Session::open(&mut *link)?.obey(&Command::Mode(Mode::Bridge), "pass bytes on")?;
    link.pause(INSISTS);
    link.clear()?;
    Ok(Servos::new(link))
}
