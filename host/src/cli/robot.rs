//! Servos to sample and move, as `record`, `replay` and `latency` take them.

use super::port::{AnyLink, Ids, Port, id_list};
use handstand::link::Protocol;
use handstand::link::record::{SampleSource, SourceKind, SourceOptions, is_cm5, open_source_as};
use handstand::{Error, Result};
use std::time::Duration;

/// Period of a CM-5's reports.
const CM5_PERIOD: Duration = Duration::from_millis(10);

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
        let options = SourceOptions {
            streams,
            period: if streams { CM5_PERIOD } else { self.period()? },
            protocol: self.port.protocol(),
            watchdog,
        };
        open_source_as(link, &self.ids.0, options)
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
