//! The talk with the firmware of who balances a robot.

use super::attitude::AttitudeSource;
use super::outcome::{BalanceEnd, BalanceOutcome};
use super::status::BalanceStatus;
use crate::error::{Error, Result};
use crate::link::record::{EmergencyOff, ReportReader, RobotSample, emergency_off};
use crate::link::{SerialLink, Session, SessionError, is_let_down};
use handstand_shared::message::{
    Answer, ArmLimits, Command, Condition, Mode, Report, Subject, Telemetry,
};
use handstand_shared::packed::SERVOS;
use handstand_shared::plan::Plan;
use std::time::Duration;

/// A CM-5 that says nothing for so long says nothing any more.
const SILENT: Duration = Duration::from_millis(500);
/// Longest from being told to let the robot down until torque is off: 160 ms, and the line.
const LET_DOWN: Duration = Duration::from_millis(1000);
/// Longest from asking for torque to the answer, behind the reports.
const ARMED: Duration = Duration::from_millis(500);

/// Balances a robot through the CM-5's firmware.
pub struct Balancer<L: SerialLink> {
    pub(super) session: Session<L>,
    attitude: AttitudeSource,
    pub(super) ids: Vec<u8>,
    pub(super) reader: ReportReader,
    /// What is known of the robot.
    pub status: BalanceStatus,
    armed_at: Option<Duration>,
}

impl<L: SerialLink> Balancer<L> {
    /// Greets the firmware that reads the servos `ids`; torque goes off.
    ///
    /// # Errors
    /// No firmware, too many servos, or it refuses.
    pub fn new(link: L, ids: &[u8], attitude: AttitudeSource) -> Result<Self> {
        if ids.is_empty() || ids.len() > SERVOS {
            return Err(Error::usage(
                format!("{} servos", ids.len()),
                format!("the CM-5 has room for 1 to {SERVOS}"),
            ));
        }
        let mut session = Session::open(link)?;
        session.obey(&Command::Mode(Mode::Bridge), "stop")?;
        let account = telemetry(&mut session)?;
        let begun = session.link().now();
        Ok(Balancer {
            reader: ReportReader::new(ids, begun, &account),
            status: BalanceStatus::new(&Plan::ZERO, ids),
            session,
            attitude,
            ids: ids.to_vec(),
            armed_at: None,
        })
    }

    /// Torque on: it balances from now on.
    ///
    /// # Errors
    /// The CM-5 refuses and says why, or does not answer.
    pub fn arm(&mut self, limits: ArmLimits) -> Result<()> {
        self.session.greet()?;
        // A fresh attitude first: the greeting took its time.
        self.step()?;
        let token = self.session.hello.token;
        let sent = self.session.send(&Command::Arm { token, limits })?;
        let deadline = self.session.link().now() + ARMED;
        loop {
            let (_, answer) = self.hear(sent)?;
            let now = self.session.link().now();
            let is_armed = self.status.condition == Condition::BalanceArmed;
            match answer.map(|answer| answer.outcome) {
                Some(Err(refusal)) => {
                    let action = "switch torque on".into();
                    return Err(SessionError::Refused { action, refusal }.into());
                }
                outcome if outcome.is_some() || is_armed => {
                    self.armed_at = Some(now);
                    self.status.begin();
                    return Ok(());
                }
                _ if now > deadline => {
                    let port = self.session.link().name().to_string();
                    let action = "switch torque on".into();
                    return Err(SessionError::NoAnswer { port, action }.into());
                }
                _ => {}
            }
        }
    }

    /// The next sample, with a sign of life for the CM-5; none while an answer came instead.
    ///
    /// # Errors
    /// The CM-5 is silent, the port failed, or a line is no attitude.
    pub fn step(&mut self) -> Result<RobotSample> {
        loop {
            if let (Some(sample), _) = self.hear(0)? {
                return Ok(sample);
            }
        }
    }

    /// How it ended, if the CM-5 let the robot down or no attitude will come; else none.
    ///
    /// # Errors
    /// The CM-5 falls silent.
    pub fn end(&mut self) -> Result<Option<BalanceOutcome>> {
        if is_let_down(self.status.condition) {
            return self.finish(None).map(Some);
        }
        if self.attitude.has_ended() {
            self.let_down(BalanceEnd::AttitudeEnded).map(Some)
        } else {
            Ok(None)
        }
    }

    /// Lets the robot down softly.
    ///
    /// # Errors
    /// The CM-5 does not answer: it lets the robot down by itself.
    pub fn let_down(&mut self, end: BalanceEnd) -> Result<BalanceOutcome> {
        match self.session.obey(&Command::LetDown, "let the robot down") {
            // It has begun by itself.
            Ok(()) | Err(SessionError::Refused { .. }) => {}
            Err(error) => return Err(error.into()),
        }
        self.finish(Some(end))
    }

    /// Hears until torque is off, and asks for the account.
    fn finish(&mut self, end: Option<BalanceEnd>) -> Result<BalanceOutcome> {
        let balanced_s = self.status.balanced_s;
        let deadline = self.session.link().now() + LET_DOWN;
        while !matches!(self.status.condition, Condition::Fault(_))
            && self.session.link().now() < deadline
        {
            self.step()?;
        }
        self.armed_at = None;
        // A line that is dying may not tell.
        let account = telemetry(&mut self.session).ok();
        self.session.greet()?;
        self.session
            .obey(&Command::Mode(Mode::Bridge), "switch torque off")?;
        Ok(BalanceOutcome {
            end: end.unwrap_or(BalanceEnd::Stopped(self.status.condition)),
            balanced_s,
            account,
        })
    }

    /// What switches torque off at once from another thread.
    pub fn emergency_off(&mut self) -> Option<EmergencyOff> {
        emergency_off(&mut self.session)
    }

    /// The line.
    pub fn link(&mut self) -> &mut L {
        self.session.link()
    }

    /// Sends the newest attitude, or that the host is there, and takes the next report: a sample,
    /// or the answer to the command `sent`.
    fn hear(&mut self, sent: u8) -> Result<(Option<RobotSample>, Option<Answer>)> {
        match self.attitude.newest()? {
            Some(attitude) => {
                self.session.send(&Command::Attitude(attitude))?;
                self.status.sent(self.session.link().now(), attitude);
            }
            None => {
                self.session.send(&Command::KeepAlive)?;
            }
        }
        let deadline = self.session.link().now() + SILENT;
        loop {
            let left = deadline.saturating_sub(self.session.link().now());
            match self.session.next(left)? {
                None => {
                    return Err(Error::device(
                        "the CM-5 has sent nothing for half a second",
                        "it lets the robot down by itself; check line and battery",
                    ));
                }
                Some((time, Report::Stream(report))) => {
                    let sample = self.reader.sample(time, &report, |_| None);
                    self.status.heard(time, report.condition, &sample);
                    if let Some(armed_at) = self.armed_at {
                        self.status.balanced_s = time.saturating_sub(armed_at).as_secs_f64();
                    }
                    return Ok((Some(sample), None));
                }
                Some((_, Report::Answer(answer))) if answer.sequence == sent => {
                    return Ok((None, Some(answer)));
                }
                Some(_) => {}
            }
        }
    }
}

pub(super) fn telemetry<L: SerialLink>(
    session: &mut Session<L>,
) -> Result<Telemetry, SessionError> {
    session.fetch(&Command::Ask(Subject::Telemetry), |report| match report {
        Report::Telemetry(telemetry) => Some(*telemetry),
        _ => None,
    })
}

impl<L: SerialLink> Drop for Balancer<L> {
    fn drop(&mut self) {
        // Nobody is left who could be told that it failed; the firmware lets the robot down by
        // itself when the line is silent.
        if self.armed_at.is_some() {
            let _ = self.session.obey(&Command::Disarm, "switch torque off");
        }
        let _ = self.session.send(&Command::Mode(Mode::Bridge));
    }
}
