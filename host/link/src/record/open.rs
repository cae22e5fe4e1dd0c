//! Which way servos behind a link are sampled: through a CM-5 that streams, or as an adapter.

use super::adapter::Adapter;
use super::group_adapter::GroupAdapter;
use super::latency::no_response;
use super::source::SampleSource;
use super::stream::Stream;
use crate::bridge::bridged;
use crate::error::Result;
use crate::{Answering, OneServo, Protocol, SerialLink, Servos, Session, SessionError};
use std::time::Duration;

/// A line at least as fast as this is an adapter's on the servos' bus, baud.
const SERVO_BUS_BAUD: u32 = 900_000;

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

/// How servos are to be reached.
#[derive(Debug, Clone, Copy)]
pub struct SourceOptions {
    /// A CM-5 streams them, 100 times a second.
    pub streams: bool,
    /// Time from one round to the next through an adapter.
    pub period: Duration,
    /// The servos' protocol; that of the first which answers without.
    pub protocol: Option<Protocol>,
    /// Whether servos of Protocol 2.0 are moved under their bus watchdog.
    pub watchdog: bool,
}

/// Opens servos to be sampled: from a CM-5 that `streams` them, 100 times a second; else through an
/// adapter, every `period`. Servos of Protocol 2.0 are moved under their bus watchdog.
///
/// # Errors
/// No firmware, or no servo answers.
pub fn open_source<L: SerialLink + 'static>(
    link: L,
    ids: &[u8],
    streams: bool,
    period: Duration,
) -> Result<Box<dyn SampleSource>> {
    let options = SourceOptions {
        streams,
        period,
        protocol: None,
        watchdog: true,
    };
    Ok(open_source_as(link, ids, options)?.0)
}

/// The same with all that can be chosen; also how the servos are reached.
///
/// # Errors
/// As [`open_source`]; of Protocol 2.0, a servo that does not answer or lacks the bus watchdog.
pub fn open_source_as<L: SerialLink + 'static>(
    link: L,
    ids: &[u8],
    options: SourceOptions,
) -> Result<(Box<dyn SampleSource>, SourceKind)> {
    let (period, watchdog) = (options.period, options.watchdog);
    if options.streams {
        let mut link = link;
        let known = cm5_servos(&mut link, ids)?;
        let source = Stream::of_servos(link, ids, known)?;
        return Ok((Box::new(source), SourceKind::Stream));
    }
    let mut servos = Servos::new(link);
    servos.protocol = options.protocol;
    if !ids.iter().any(|id| servos.ping(*id).is_ok()) {
        return Err(no_response());
    }
    if servos.protocol == Some(Protocol::Two) {
        let source = GroupAdapter::new(servos, ids, period, watchdog)?;
        return Ok((Box::new(source), SourceKind::Group { watchdog }));
    }
    let source = Adapter::new(servos, ids, period)?;
    Ok((Box::new(source), SourceKind::Adapter))
}

/// What the servos behind a CM-5 are; none of one that does not answer.
///
/// # Errors
/// No firmware, or a servo that it does not know how to read.
fn cm5_servos<L: SerialLink>(link: &mut L, ids: &[u8]) -> Result<Vec<Option<OneServo>>> {
    let mut servos = bridged(link)?;
    servos.protocol = Some(Protocol::One);
    // A line that loses answers loses no servo for the whole recording.
    servos.tries = 10;
    let one = |id: &u8| match servos.cm5_servo(*id) {
        Ok(servo) => Ok(Some(servo)),
        Err(error) if error.is_transient() => Ok(None),
        Err(error) => Err(error.into()),
    };
    ids.iter().map(one).collect()
}

/// Those of `ids` that answer through a CM-5, or an adapter if not `streams`; in the protocol that
/// is set, or in either.
///
/// # Errors
/// The device failed, or no CM-5 is there to stream.
pub fn answering<L: SerialLink>(
    link: &mut L,
    ids: &[u8],
    streams: bool,
    protocol: Option<Protocol>,
) -> Result<Answering> {
    let mut servos = if streams {
        bridged(link)?
    } else {
        Servos::new(link)
    };
    // A CM-5 reads servos of Protocol 1.0 only.
    servos.protocol = if streams {
        Some(Protocol::One)
    } else {
        protocol
    };
    Ok(servos.answering(ids)?)
}

/// Whether Handstand's firmware answers. A line as fast as the servos' bus is an adapter on it,
/// whose servos would hear what is said: it is not asked.
///
/// # Errors
/// The device failed.
pub fn is_cm5<L: SerialLink>(link: &mut L) -> Result<bool> {
    if link.baud() >= SERVO_BUS_BAUD {
        return Ok(false);
    }
    match Session::open(&mut *link) {
        Ok(_) => Ok(true),
        Err(SessionError::NoFirmware { .. }) => Ok(false),
        Err(error) => Err(error.into()),
    }
}
