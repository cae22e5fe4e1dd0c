//! The link to servos and CM-5: ports, and the protocols on them.
//!
//! A [`Link`] is a line of bytes with a clock. [`Serial`] is a real one, `virtual_cm5::SimLink` the simulated bus in
//! simulated time, [`Replay`] what a [`Tap`] recorded; [`Tap`] and [`Faulty`] wrap any other. On top communicate
//! [`Servos`] (Dynamixel packets) and [`Session`] (frames with the CM-5). Read downward: `port` -> ports -> `servos`,
//! `session`.

pub mod boot_loader;
pub mod doctor;
mod faulty;
mod port;
#[cfg(unix)]
mod pty;
mod replay;
mod reply;
mod serial;
mod servo_error;
mod servos;
mod session;
mod session_error;
mod settings;
mod tap;

pub use faulty::Faulty;
pub use port::{LineWriter, Link, read_some};
#[cfg(unix)]
pub use pty::Pty;
pub use replay::Replay;
pub use reply::Reading;
pub use serial::{Serial, ports};
pub use servo_error::{ServoError, ServoResult};
pub use servos::Servos;
pub use session::Session;
pub use session_error::{SessionError, condition_words, refusal_words};
pub use settings::Settings;
pub use tap::{Exchange, Tap, Way};

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
