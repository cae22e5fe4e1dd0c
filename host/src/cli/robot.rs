//! Servos to sample and move, as `record`, `replay` and `latency` take them.

use super::port::{AnyLink, Ids, Port, id_list};
use handstand::link::record::{Adapter, GroupAdapter, SampleSource, Stream};
use handstand::link::{Protocol, SerialLink as _, Session, SessionError};
use handstand::{Error, Result};
use std::time::Duration;

/// Which servos, and how they are read.
#[derive(Debug, Clone, clap::Args)]
pub struct RobotArgs {
    #[command(flatten)]
    pub port: Port,
    /// Servos
    #[arg(long, default_value = "1-18", value_parser = id_list)]
    pub ids: Ids,
    /// Let a CM-5 with Handstand's firmware read them: 100 times a second, whatever --hz says
    #[arg(long)]
    pub stream: bool,
    /// Rounds per second, if the line is fast enough
    #[arg(long, default_value_t = 100.0)]
    pub hz: f64,
}

impl RobotArgs {
    /// Opens it.
    ///
    /// # Errors
    /// No port, no firmware, or a rate that is none.
    pub fn open(&self) -> Result<Box<dyn SampleSource>> {
        Ok(self.opened(self.port.open()?, self.stream, true)?.0)
    }

    /// Opens it to move the robot: a CM-5 with Handstand's firmware streams unless `adapter`, for
    /// as an adapter nothing lets the robot down when the line breaks. Servos of Protocol 2.0 stop
    /// by themselves then, with their `watchdog`. Also in which way they are reached.
    ///
    /// # Errors
    /// As [`RobotArgs::open`].
    pub fn open_to_move(
        &self,
        adapter: bool,
        watchdog: bool,
    ) -> Result<(Box<dyn SampleSource>, SourceKind)> {
        let mut link = self.port.open()?;
        let is_two = self.port.protocol() == Some(Protocol::Two);
        let streams = self.stream || (!adapter && !is_two && is_cm5(&mut link)?);
        self.opened(link, streams, watchdog)
    }

    fn opened(
        &self,
        link: AnyLink,
        streams: bool,
        watchdog: bool,
    ) -> Result<(Box<dyn SampleSource>, SourceKind)> {
        let ids = &self.ids.0;
        if streams {
            return Ok((Box::new(Stream::new(link, ids)?), SourceKind::Stream));
        }
        let mut servos = self.port.on(link);
        let present = ids.iter().any(|id| servos.ping(*id).is_ok());
        if !present {
            return Err(handstand::link::record::no_response());
        }
        let period = self.period()?;
        Ok(match servos.protocol {
            Some(Protocol::Two) => {
                let source = GroupAdapter::new(servos, ids, period, watchdog)?;
                (Box::new(source), SourceKind::Group { watchdog })
            }
            _ => (
                Box::new(Adapter::new(servos, ids, period)),
                SourceKind::Adapter,
            ),
        })
    }

    /// Time between two samples.
    ///
    /// # Errors
    /// A rate that is none.
    pub fn period(&self) -> Result<Duration> {
        if self.stream {
            return Ok(Duration::from_millis(10));
        }
        let sensible = (0.01..=1000.0).contains(&self.hz);
        sensible
            .then(|| Duration::from_secs_f64(1.0 / self.hz))
            .ok_or_else(|| {
                Error::usage(
                    format!("--hz {} is no rate", self.hz),
                    "give 0.01 to 1000 rounds per second",
                )
            })
    }
}

/// How servos are reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceKind {
    /// A CM-5 reads them.
    Stream,
    /// One by one through an adapter, Protocol 1.0.
    Adapter,
    /// Together through an adapter, Protocol 2.0.
    Group {
        /// Whether their bus watchdog stops them when the line breaks.
        watchdog: bool,
    },
}

/// Whether Handstand's firmware answers. A line as fast as the servos' bus is an adapter on it,
/// whose servos would hear what is said.
fn is_cm5(link: &mut AnyLink) -> Result<bool> {
    const SERVO_BUS_BAUD: u32 = 900_000;
    if link.baud() >= SERVO_BUS_BAUD {
        return Ok(false);
    }
    match Session::open(&mut *link) {
        Ok(_) => Ok(true),
        Err(SessionError::NoFirmware { .. }) => Ok(false),
        Err(error) => Err(error.into()),
    }
}
