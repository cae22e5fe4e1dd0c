//! Links to servos and controller: serial lines, and the protocols on them.
//!
//! A [`SerialLink`] is a line of bytes with a clock. [`Serial`] is a real one, [`Replay`] what a
//! [`Tap`] recorded; [`Tap`] and [`Faulty`] wrap any other. [`Servos`] communicates in Dynamixel
//! packets of either protocol, [`Session`] in frames with the CM-5. Read downward: `port` -> ports
//! -> `servos`, `session` -> `doctor`, `boot_loader`, [`record`]. The simulated CM-5 stands behind
//! a port like a real one, so that `settings`, which open ports, know it.

mod account;
pub mod boot_loader;
mod bridge;
pub mod bring_up;
mod discover;
pub mod doctor;
mod exchange;
mod fault_log;
mod faulty;
mod group_read;
mod one_servo;
pub(crate) mod port;
mod protocol;
#[cfg(unix)]
mod pty;
pub mod record;
mod replay;
mod reply;
mod serial;
mod servo_error;
mod servo_rows;
mod servos;
mod session;
mod session_error;
mod settings;
mod status_error;
mod tap;
#[cfg(feature = "virtual-cm5")]
pub mod virtual_cm5;

#[cfg(feature = "ros")]
use handstand_logs as log;
use handstand_model::error;
#[cfg(feature = "virtual-cm5")]
use handstand_model::model;
#[cfg(feature = "virtual-cm5")]
use handstand_sim::sim;

pub use account::{account_words, is_let_down};
pub use discover::{Answering, id_ranges};
pub use fault_log::{cause_words, fault_log};
pub use faulty::Faulty;
pub use group_read::{GroupItem, group_read_bytes};
pub use one_servo::{OneMode, OneServo};
pub use port::{LineWriter, SerialLink, read_some};
pub use protocol::Protocol;
use protocol::{emergency_packet, outlasting_answers};
#[cfg(unix)]
pub use pty::Pty;
pub use replay::Replay;
pub use reply::Reading;
pub use serial::{PERMISSION_REMEDY, Serial, may_open, ports};
pub use servo_error::{ServoError, ServoResult};
pub use servo_rows::{Identity, Model};
pub use servos::Servos;
pub use session::Session;
pub use session_error::{SessionError, condition_words, refusal_words};
pub use settings::Settings;
pub use status_error::StatusError;
pub use tap::{Exchange, Tap, Way};

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod group_tests;
#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
