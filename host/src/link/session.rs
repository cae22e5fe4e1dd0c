//! Speaking with the CM-5's firmware in frames.

use super::port::Link;
use crate::error::{Error, Result};
use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{
    Cause, Command, Condition, Hello, Numbered, Refusal, Report, VERSION, decode, encode,
};
use std::collections::VecDeque;
use std::time::Duration;

/// The firmware's main loop answers within a tick; this is what it may take beside line and latency.
const TURN: Duration = Duration::from_millis(30);
const TRIES: u32 = 3;

/// A talk with the firmware.
pub struct Session<L> {
    link: L,
    decoder: Decoder,
    next_out: u8,
    next_in: Option<u8>,
    waiting: VecDeque<(Duration, Report)>,
    /// What the firmware said of itself at the greeting.
    pub hello: Hello,
    /// Sound frames received.
    pub frames: u64,
    /// Frames received with a wrong check or content.
    pub bad: u64,
    /// Frames whose number was skipped.
    pub lost: u64,
}

impl<L: Link> Session<L> {
    /// Greets the firmware.
    ///
    /// # Errors
    /// [`Error::Device`]: nobody answers in frames, or a firmware of another version does.
    pub fn open(link: L) -> Result<Self> {
        let nobody = Hello {
            version: 0,
            token: 0,
            condition: Condition::Bridge,
            plan: 0,
        };
        let mut session = Session {
            link,
            decoder: Decoder::default(),
            next_out: 0,
            next_in: None,
            waiting: VecDeque::new(),
            hello: nobody,
            frames: 0,
            bad: 0,
            lost: 0,
        };
        session.greet()?;
        (session.bad, session.lost) = (0, 0);
        Ok(session)
    }

    /// Greets anew, for a new token.
    ///
    /// # Errors
    /// As [`Session::open`].
    pub fn greet(&mut self) -> Result<()> {
        for _ in 0..TRIES {
            self.send(&Command::Hello { version: VERSION })?;
            let hello = self.wait(self.turn(), |report| match report {
                Report::Hello(hello) => Some(*hello),
                _ => None,
            })?;
            if let Some(hello) = hello {
                self.hello = hello;
                return match hello.version {
                    VERSION => Ok(()),
                    other => Err(Error::device(
                        format!(
                            "{}: the firmware speaks version {other}, this program version {VERSION}",
                            self.link.name()
                        ),
                        "build and flash the firmware that belongs to this program: docs/flash.md",
                    )),
                };
            }
        }
        Err(Error::device(
            format!("{}: no Handstand firmware answers", self.link.name()),
            "is it flashed (docs/flash.md), switched on, the cable in, and the speed right (--baud 57600)?",
        ))
    }

    /// The line.
    pub fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// A command as it goes over the line, to be sent by whoever comes first.
    pub fn bytes(&self, command: &Command) -> Vec<u8> {
        let mut frame = [0; MAX_FRAME];
        let length = encode(self.next_out, command, &mut frame).unwrap_or(0);
        // The zero in front ends whatever noise there was, and tells an adapter that this is no servo packet.
        [&[0], &frame[..length]].concat()
    }

    /// Sends a command, without waiting; its number.
    ///
    /// # Errors
    /// The port failed.
    pub fn send(&mut self, command: &Command) -> Result<u8> {
        let sequence = self.next_out;
        self.link.send(&self.bytes(command))?;
        self.next_out = self.next_out.wrapping_add(1);
        Ok(sequence)
    }

    /// Sends a command and waits until it is obeyed.
    ///
    /// # Errors
    /// No answer after three tries, or a refusal.
    pub fn obey(&mut self, command: &Command, name: &str) -> Result<()> {
        for _ in 0..TRIES {
            let sent = self.send(command)?;
            // Gains are answered when EEPROM is written: 8.5 ms a byte, a byte a tick.
            let slow = matches!(
                command,
                Command::PlanChunk { .. } | Command::PlanStore { .. }
            );
            let turn = self.turn()
                + if slow {
                    Duration::from_millis(600)
                } else {
                    Duration::ZERO
                };
            let outcome = self.wait(turn, |report| match report {
                Report::Answer(answer) if answer.sequence == sent => Some(answer.outcome),
                _ => None,
            })?;
            match outcome {
                Some(Ok(())) => return Ok(()),
                Some(Err(refusal)) => {
                    let (why, remedy) = refusal_words(refusal);
                    return Err(Error::device(
                        format!("the CM-5 refuses to {name}: {why}"),
                        remedy,
                    ));
                }
                None => {}
            }
        }
        Err(Error::device(
            format!("{}: no answer when asked to {name}", self.link.name()),
            "the line is disturbed or the CM-5 was reset: `handstand latency` measures the line",
        ))
    }

    /// Sends a command and waits for the report that `pick` takes.
    ///
    /// # Errors
    /// No such report after three tries.
    pub fn fetch<T>(
        &mut self,
        command: &Command,
        mut pick: impl FnMut(&Report) -> Option<T>,
    ) -> Result<T> {
        for _ in 0..TRIES {
            self.send(command)?;
            if let Some(picked) = self.wait(self.turn(), &mut pick)? {
                return Ok(picked);
            }
        }
        Err(Error::device(
            format!("{}: the CM-5 does not answer", self.link.name()),
            "the line is disturbed or the CM-5 was reset: `handstand latency` measures the line",
        ))
    }

    /// The next report and when it came, waiting at most `wait`.
    ///
    /// # Errors
    /// The port failed.
    pub fn next(&mut self, wait: Duration) -> Result<Option<(Duration, Report)>> {
        let deadline = self.link.now() + wait;
        let mut some = [0; 256];
        loop {
            if let Some(report) = self.waiting.pop_front() {
                return Ok(Some(report));
            }
            let left = deadline.saturating_sub(self.link.now());
            let count = self.link.receive(&mut some, left)?;
            some[..count].iter().for_each(|byte| self.take(*byte));
            if self.waiting.is_empty() && self.link.now() >= deadline {
                return Ok(None);
            }
        }
    }

    fn take(&mut self, byte: u8) {
        let Some(body) = self.decoder.push(byte) else {
            return;
        };
        let Some(Numbered { sequence, message }) =
            body.ok().and_then(|body| decode::<Report>(body).ok())
        else {
            self.bad += 1;
            return;
        };
        self.frames += 1;
        if let Some(expected) = self.next_in {
            self.lost += u64::from(sequence.wrapping_sub(expected));
        }
        self.next_in = Some(sequence.wrapping_add(1));
        self.waiting.push_back((self.link.now(), message));
    }

    /// Waits for a report that `pick` takes; others that come meanwhile are dropped.
    fn wait<T>(
        &mut self,
        wait: Duration,
        mut pick: impl FnMut(&Report) -> Option<T>,
    ) -> Result<Option<T>> {
        let deadline = self.link.now() + wait;
        while let Some((_, report)) = self.next(deadline.saturating_sub(self.link.now()))? {
            if let Some(picked) = pick(&report) {
                return Ok(Some(picked));
            }
        }
        Ok(None)
    }

    /// Longest time from command to answer: both lines, the stream's frames before it, the firmware's turn.
    fn turn(&self) -> Duration {
        self.link.line_time(4 * MAX_FRAME) + self.link.latency() + TURN
    }
}

/// Why a command is refused, and what to do.
pub fn refusal_words(refusal: Refusal) -> (&'static str, &'static str) {
    match refusal {
        Refusal::Version => (
            "no greeting of its version came first",
            "reset the CM-5 and try again",
        ),
        Refusal::State => (
            "not in this state",
            "choose a mode first; after a fault, greet anew",
        ),
        Refusal::Armed => ("torque is on", "disarm first"),
        Refusal::Token => ("the greeting is out of date", "try again"),
        Refusal::Supply => (
            "the supply is too low, or no servo has told it",
            "charge the battery: `handstand bus monitor` shows the voltage",
        ),
        Refusal::Servo => (
            "a servo it needs does not answer",
            "`handstand bus scan` shows who does",
        ),
        Refusal::NoPlan => (
            "there are no gains on it",
            "`handstand deploy` puts them there",
        ),
        Refusal::BadPlan => (
            "the gain table is unsound",
            "make it anew; if it stays so, firmware and program do not belong together",
        ),
        Refusal::ServoList => (
            "the list of servos is empty, too long, or names an id twice",
            "give 1 to 18 different ids",
        ),
        Refusal::Pose => (
            "the robot is too far from the pose its gains are for",
            "bring it there by hand, then arm",
        ),
    }
}

/// What the firmware is doing, in words.
pub fn condition_words(condition: Condition) -> &'static str {
    match condition {
        Condition::Bridge => "adapter",
        Condition::Stream => "streaming, torque off",
        Condition::StreamArmed => "streaming, torque on",
        Condition::Balance => "ready to balance, torque off",
        Condition::BalanceArmed => "balancing",
        Condition::Soft => "letting down",
        Condition::Fault(Cause::LinkLost) => "stopped: the link was lost",
        Condition::Fault(Cause::LowSupply) => "stopped: the supply is low",
        Condition::Fault(Cause::ServoLost) => "stopped: a servo stopped answering",
        Condition::Fault(Cause::ServoError) => "stopped: a servo is overloaded or too hot",
        Condition::Fault(Cause::Fallen) => "stopped: it left the range its gains hold in",
        Condition::Fault(Cause::Watchdog) => "stopped: the watchdog reset the controller",
    }
}
