//! Servos to sample and move, as `record`, `replay` and `latency` take them.

use super::Console;
use super::port::{AnyLink, DEFAULT_IDS, Ids, Port, chosen, id_list};
use handstand::link::Protocol;
use handstand::link::record::{
    SampleSource, SourceKind, SourceOptions, answering, is_cm5, open_source_as,
};
use handstand::{Error, Result};
use std::time::Duration;

/// Period of a CM-5's reports.
const CM5_PERIOD: Duration = Duration::from_millis(10);

/// Which servos, and how they are read.
#[derive(Debug, Clone, clap::Args)]
pub struct RobotArgs {
    #[command(flatten)]
    pub port: Port,
    /// Servos; without, those of 1-18 that answer, or of a motion all
    #[arg(long, value_parser = id_list)]
    pub ids: Option<Ids>,
    /// Let a CM-5 with Handstand's firmware read them: 100 times a second, whatever --hz says
    #[arg(long)]
    pub stream: bool,
    /// Rounds per second, if the line is fast enough
    #[arg(long, default_value_t = 100.0)]
    pub hz: f64,
}

impl RobotArgs {
    /// Opens it; also the servos, which are said where they were not given.
    ///
    /// # Errors
    /// No port, no firmware, no servo, or a rate that is none.
    pub fn open(&self, console: &Console) -> Result<(Box<dyn SampleSource>, Vec<u8>)> {
        let mut link = self.port.open()?;
        let ids = self.chosen(&mut link, console)?;
        Ok((self.opened(link, &ids, self.stream, true)?.0, ids))
    }

    /// The servos that were given, or those that answer.
    ///
    /// # Errors
    /// None answers, or the port failed.
    pub fn chosen(&self, link: &mut AnyLink, console: &Console) -> Result<Vec<u8>> {
        let (streams, protocol) = (self.stream, self.port.protocol());
        let ask = || answering(link, &DEFAULT_IDS, streams, protocol);
        chosen(self.ids.as_ref(), ask, console)
    }

    /// Opens these servos to move the robot: a CM-5 with Handstand's firmware streams unless
    /// `adapter`, for as an adapter nothing lets the robot down when the line breaks. Servos of
    /// Protocol 2.0 stop by themselves then, with their `watchdog`. Also in which way they are
    /// reached.
    ///
    /// # Errors
    /// As [`RobotArgs::open`].
    pub fn open_to_move(
        &self,
        ids: &[u8],
        adapter: bool,
        watchdog: bool,
    ) -> Result<(Box<dyn SampleSource>, SourceKind)> {
        let mut link = self.port.open()?;
        let is_two = self.port.protocol() == Some(Protocol::Two);
        let streams = self.stream || (!adapter && !is_two && is_cm5(&mut link)?);
        self.opened(link, ids, streams, watchdog)
    }

    fn opened(
        &self,
        link: AnyLink,
        ids: &[u8],
        streams: bool,
        watchdog: bool,
    ) -> Result<(Box<dyn SampleSource>, SourceKind)> {
        let options = SourceOptions {
            streams,
            period: if streams { CM5_PERIOD } else { self.period()? },
            protocol: self.port.protocol(),
            watchdog,
        };
        open_source_as(link, ids, options)
    }

    /// Time between two samples.
    ///
    /// # Errors
    /// A rate that is none.
    pub fn period(&self) -> Result<Duration> {
        if self.stream {
            return Ok(CM5_PERIOD);
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
