//! The port of a command: a serial one, or a simulated one.

use super::bus::garbled_words;
use super::simulated::Attitude;
use super::{Console, simulated};
use handstand::link::{Answering, Protocol, Serial, SerialLink, Servos, Tap, id_ranges, ports};
use handstand::{Error, Result};
use handstand_shared::dynamixel::{ID_LIST_SYNTAX, ids};
use std::path::PathBuf;

/// Where the servos are.
#[derive(Debug, Clone, clap::Args)]
pub struct Port {
    /// Serial port, or `sim` for simulated servos, `sim-cm5` for a CM-5 before them;
    /// `sim:ids=1-3,drop=0.01` and the like
    #[arg(long)]
    port: Option<String>,
    /// Speed: 57600 through a CM-5, 1000000 through an adapter on the servos' bus; simulated ports
    /// have their own
    #[arg(long, value_name = "BAUD")]
    baud: Option<u32>,
    /// Dynamixel protocol, 1 or 2; that of the first servo that answers without
    #[arg(long, value_name = "1|2", value_parser = protocol)]
    protocol: Option<Protocol>,
    /// Write down all bytes that pass
    #[arg(long, value_name = "FILE")]
    tap: Option<PathBuf>,
}

/// An open port of any kind.
pub type AnyLink = Box<dyn SerialLink>;

impl Port {
    /// The port of this name.
    #[cfg(feature = "lab")]
    pub fn named(name: &str, baud: Option<u32>) -> Port {
        Port {
            port: Some(name.to_string()),
            baud,
            protocol: None,
            tap: None,
        }
    }

    /// Opens it.
    ///
    /// # Errors
    /// No such port, not ours to use, in use; or several and none named.
    pub fn open(&self) -> Result<AnyLink> {
        let (link, _) = self.untapped()?;
        self.tapped(link)
    }

    /// Opens it; with the attitude of the simulated robot behind it, if there is one.
    ///
    /// # Errors
    /// As [`Port::open`].
    #[cfg(feature = "robot")]
    pub fn open_with_attitude(&self) -> Result<(AnyLink, Option<Attitude>)> {
        let (link, attitude) = self.untapped()?;
        Ok((self.tapped(link)?, attitude))
    }

    fn tapped(&self, link: AnyLink) -> Result<AnyLink> {
        Ok(match &self.tap {
            Some(file) => Box::new(Tap::to_file(link, file)?),
            None => link,
        })
    }

    /// Opens it to communicate with servos.
    ///
    /// # Errors
    /// As [`Port::open`].
    pub fn servos(&self) -> Result<Servos<AnyLink>> {
        Ok(self.on(self.open()?))
    }

    /// Servos on this line, of the protocol that was asked for.
    pub fn on<L: SerialLink>(&self, link: L) -> Servos<L> {
        let mut servos = Servos::new(link);
        servos.protocol = self.protocol;
        servos
    }

    /// The protocol that was asked for.
    pub fn protocol(&self) -> Option<Protocol> {
        self.protocol
    }

    fn untapped(&self) -> Result<(AnyLink, Option<Attitude>)> {
        let name = match &self.port {
            Some(name) => name.clone(),
            None => only_port()?,
        };
        let (kind, spec) = name.split_once(':').unwrap_or((&name, ""));
        let (mut link, attitude) = match kind {
            "sim" => (simulated::open(spec, false)?, None),
            "sim-cm5" => simulated::open_with_attitude(spec, true)?,
            _ => {
                let serial = Serial::open(&name, self.baud.unwrap_or(57_600))?;
                return Ok((Box::new(serial), None));
            }
        };
        if let Some(baud) = self.baud {
            link.set_baud(baud)?;
        }
        Ok((link, attitude))
    }
}

fn only_port() -> Result<String> {
    match ports().as_slice() {
        [only] => Ok(only.clone()),
        [] => Err(Error::device(
            "no serial port is there",
            "plug the adapter in, or try without hardware: --port sim",
        )),
        several => Err(Error::usage(
            format!("there are several serial ports: {}", several.join(", ")),
            "choose one with --port",
        )),
    }
}

fn protocol(text: &str) -> Result<Protocol, String> {
    match text {
        "1" | "1.0" => Ok(Protocol::One),
        "2" | "2.0" => Ok(Protocol::Two),
        _ => Err("give 1 or 2".to_string()),
    }
}

/// Ids as an argument: `1-18`, `1-4,9`.
pub fn id_list(text: &str) -> Result<Ids, String> {
    let ids: Option<_> = ids(text).collect();
    let wrong = || format!("`{text}` names no ids: {ID_LIST_SYNTAX}");
    ids.map(Ids).ok_or_else(wrong)
}

/// Servo ids.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ids(pub Vec<u8>);

/// Ids that are asked where none are given: those of the Bioloid.
pub const DEFAULT_IDS: [u8; 18] = [
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18,
];

/// The ids that were given; without, those that `ask` finds among [`DEFAULT_IDS`], which are said.
///
/// # Errors
/// None answers, or the port failed.
pub fn chosen(
    given: Option<&Ids>,
    ask: impl FnOnce() -> Result<Answering>,
    console: &Console,
) -> Result<Vec<u8>> {
    if let Some(Ids(ids)) = given {
        return Ok(ids.clone());
    }
    let found = ask()?;
    let ids = found.ids();
    say_found(&found, console);
    if ids.is_empty() {
        return Err(Error::device(
            "no servo of ids 1-18 answers",
            "`handstand bus scan` looks for others, --ids names them; of none, `handstand bus \
             doctor` finds the cause",
        ));
    }
    Ok(ids)
}

/// Says in a line each which servos answer, and of which only bytes came.
pub fn say_found(found: &Answering, console: &Console) {
    let ids = found.ids();
    if !ids.is_empty() {
        let (who, verb) = match ids.len() {
            1 => ("servo", "answers"),
            _ => ("servos", "answer"),
        };
        console.say(&format!(
            "{who} {} {verb}, of ids 1-18; --ids names others",
            id_ranges(&ids)
        ));
    }
    if !found.garbled.is_empty() {
        console.say(&garbled_words(&found.garbled));
    }
}
