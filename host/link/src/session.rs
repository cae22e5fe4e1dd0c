//! A session with the CM-5's firmware: commands and reports in frames.

use super::port::SerialLink;
use super::session_error::SessionError;
use handstand_shared::frame::{Decoder, MAX_FRAME};
use handstand_shared::message::{
    Command, Condition, Hello, Numbered, Report, VERSION, decode, encode,
};
use std::collections::VecDeque;
use std::time::Duration;

/// The firmware's main loop answers within a tick; this is what it may take beside line and
/// latency.
const TURN: Duration = Duration::from_millis(30);
const TRIES: u32 = 3;

type Result<T> = std::result::Result<T, SessionError>;

/// A session with the firmware.
pub struct Session<L> {
    link: L,
    decoder: Decoder,
    next_out: u8,
    next_in: Option<u8>,
    waiting: VecDeque<(Duration, Report)>,
    /// Whether ticks that are reported while an answer is awaited are kept for [`Session::next`]:
    /// for who wants them all, and not the newest.
    pub keeps_ticks: bool,
    /// The firmware's answer to the greeting.
    pub hello: Hello,
    /// Sound frames received.
    pub frames: u64,
    /// Frames received with a wrong check or content.
    pub bad: u64,
    /// Frames whose number was skipped.
    pub lost: u64,
}

impl<L: SerialLink> Session<L> {
    /// Greets the firmware.
    ///
    /// # Errors
    /// No firmware responds, or one of another version.
    pub fn open(link: L) -> Result<Self> {
        let unknown = Hello {
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
            keeps_ticks: false,
            hello: unknown,
            frames: 0,
            bad: 0,
            lost: 0,
        };
        session.greet()?;
        (session.bad, session.lost) = (0, 0);
        Ok(session)
    }

    /// Greet again, for a new token.
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
                    theirs => Err(SessionError::Version {
                        port: self.port(),
                        theirs,
                    }),
                };
            }
        }
        Err(SessionError::NoFirmware { port: self.port() })
    }

    /// The line.
    pub fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// A command as it goes over the line, to be sent by whoever comes first.
    pub fn bytes(&self, command: &Command) -> Vec<u8> {
        let mut frame = [0; MAX_FRAME];
        let length = encode(self.next_out, command, &mut frame).unwrap_or(0);
        // The zero in front ends whatever noise there was, and tells an adapter that this is no
        // servo packet.
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
    pub fn obey(&mut self, command: &Command, action: &str) -> Result<()> {
        for _ in 0..TRIES {
            let sent = self.send(command)?;
            // Gains are answered when EEPROM is written: 8.5 ms a byte, a byte a tick. Arming is
            // when every servo has said that it holds its limits: 200 ms at most.
            let slow = matches!(
                command,
                Command::PlanChunk { .. } | Command::PlanStore { .. } | Command::Arm { .. }
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
                    let action = action.into();
                    return Err(SessionError::Refused { action, refusal });
                }
                None => {}
            }
        }
        Err(SessionError::NoAnswer {
            port: self.port(),
            action: action.into(),
        })
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
        Err(SessionError::NoReport { port: self.port() })
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

    /// Waits for a report that `pick` takes; others that come meanwhile are dropped, but for ticks
    /// that are to be kept.
    fn wait<T>(
        &mut self,
        wait: Duration,
        mut pick: impl FnMut(&Report) -> Option<T>,
    ) -> Result<Option<T>> {
        let deadline = self.link.now() + wait;
        let mut kept = Vec::new();
        let mut picked = None;
        while let Some((time, report)) = self.next(deadline.saturating_sub(self.link.now()))? {
            picked = pick(&report);
            if picked.is_some() {
                break;
            }
            if self.keeps_ticks && matches!(report, Report::Stream(_)) {
                kept.push((time, report));
            }
        }
        kept.extend(self.waiting.drain(..));
        self.waiting.extend(kept);
        Ok(picked)
    }

    fn port(&self) -> String {
        self.link.name().to_string()
    }

    /// Longest time from command to answer: both lines, the stream's frames before it, the
    /// firmware's turn.
    fn turn(&self) -> Duration {
        self.link.line_time(4 * MAX_FRAME) + self.link.latency() + TURN
    }
}
