//! The port a command speaks over: a serial one, or a simulated one.

use super::cm5::Cm5;
use handstand::link::{InProcess, Link, Serial, Servos, SimWords, Tap, ids, ports};
use handstand::{Error, Result};
use std::path::PathBuf;

/// Where the servos are.
#[derive(Debug, Clone, clap::Args)]
pub struct Port {
    /// Serial port, or `sim` for simulated servos, `sim-cm5` for a CM-5 before them; `sim:ids=1-3,drop=0.01` and the like
    #[arg(long)]
    port: Option<String>,
    /// Speed: 57600 through a CM-5, 1000000 through an adapter on the servos' bus; simulated ports have their own
    #[arg(long, value_name = "BAUD")]
    baud: Option<u32>,
    /// Write down all bytes that pass
    #[arg(long, value_name = "FILE")]
    tap: Option<PathBuf>,
}

/// An open port of any kind.
pub type AnyLink = Box<dyn Link>;

impl Port {
    /// Opens it.
    ///
    /// # Errors
    /// No such port, not ours to use, in use; or several and none named.
    pub fn open(&self) -> Result<AnyLink> {
        let link = self.untapped()?;
        Ok(match &self.tap {
            Some(file) => Box::new(Tap::to_file(link, file)?),
            None => link,
        })
    }

    /// Opens it to speak with servos.
    ///
    /// # Errors
    /// As [`Port::open`].
    pub fn servos(&self) -> Result<Servos<AnyLink>> {
        Ok(Servos::new(self.open()?))
    }

    fn untapped(&self) -> Result<AnyLink> {
        let name = match &self.port {
            Some(name) => name.clone(),
            None => only_port()?,
        };
        let (kind, words) = name.split_once(':').unwrap_or((&name, ""));
        let mut link: AnyLink = match kind {
            "sim" => Box::new(InProcess::new(simulated(words)?.set_up()?)),
            "sim-cm5" => Box::new(Cm5::new(simulated(words)?.set_up()?)),
            _ => return Ok(Box::new(Serial::open(&name, self.baud.unwrap_or(57_600))?)),
        };
        if let Some(baud) = self.baud {
            link.set_baud(baud)?;
        }
        Ok(link)
    }
}

/// The error where no servo answers.
pub fn nobody() -> Error {
    Error::device("no servo answers", "`handstand bus doctor` finds the cause")
}

/// A simulated bus from its words.
///
/// # Errors
/// [`Error::Usage`] for words that mean nothing.
pub fn simulated(words: &str) -> Result<SimWords> {
    words
        .parse()
        .map_err(|what: String| Error::usage(what, "such as sim:ids=1-3,delay=0,dead=2"))
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

/// Ids as an argument: `1-18`, `1-4,9`.
pub fn id_list(text: &str) -> Result<Ids, String> {
    ids(text).map(Ids)
}

/// Servo ids.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ids(pub Vec<u8>);
