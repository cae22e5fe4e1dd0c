//! What each command of the host does.

use super::{App, Goal, State, Token, Torque};
use crate::board::Board;
use crate::plan_store::MAX_TABLE;
use handstand_shared::message::{
    Answer, Cause, Command, Hello, Mode, Numbered, PLAN_CHUNK, Refusal, Report, ServoList, Subject,
    Telemetry, VERSION,
};

/// What a command comes to.
enum Outcome {
    /// Nothing is answered.
    Quiet,
    /// The answer is sent now.
    Answer(Result<(), Refusal>),
    /// The answer follows when it is done.
    Later,
}

impl App {
    #[inline(never)]
    pub(super) fn obey<B: Board>(&mut self, board: &mut B, command: Numbered<Command>) {
        let Numbered { sequence, message } = command;
        if message.is_life() {
            self.life = self.heard;
        }
        let outcome = self.outcome(board, sequence, message);
        if let Outcome::Answer(outcome) = outcome {
            self.answer(board, sequence, outcome);
        }
    }

    #[inline(never)]
    pub(super) fn answer<B: Board>(
        &mut self,
        board: &mut B,
        sequence: u8,
        outcome: Result<(), Refusal>,
    ) {
        let report = Report::Answer(Answer { sequence, outcome });
        self.link.send(board, &report);
    }

    #[inline(never)]
    fn outcome<B: Board>(&mut self, board: &mut B, sequence: u8, command: Command) -> Outcome {
        match command {
            Command::Hello { version } => self.greet(board, version),
            Command::KeepAlive => Outcome::Quiet,
            Command::Disarm => Outcome::Answer(self.stop(board)),
            Command::LetDown => Outcome::Answer(self.let_down(board)),
            Command::Ask(Subject::Telemetry) => self.telemetry(board),
            Command::Ask(Subject::Statistics) => {
                self.link.send(board, &Report::Statistics(self.statistics));
                Outcome::Quiet
            }
            Command::Mode(mode) => Outcome::Answer(self.change(board, mode)),
            Command::ServoList(list) => Outcome::Answer(self.enlist(&list)),
            Command::Goals(goals) => self.set_goal(sequence, Goal::Positions(goals)),
            Command::Speeds(speeds) => self.set_goal(sequence, Goal::Speeds(speeds)),
            Command::Attitude(attitude) => {
                self.attitude = attitude;
                self.attitude_age = self.heard;
                Outcome::Quiet
            }
            Command::Arm { token, limits } => match self.arm(board, sequence, token, limits) {
                // When torque comes on.
                Ok(()) => Outcome::Later,
                Err(refusal) => Outcome::Answer(Err(refusal)),
            },
            Command::PlanChunk { offset, bytes } => {
                if self.is_armed() {
                    Outcome::Answer(Err(Refusal::Armed))
                } else if self.writer.chunk(offset, &bytes, sequence) {
                    Outcome::Later
                } else {
                    Outcome::Answer(Err(Refusal::BadPlan))
                }
            }
            Command::PlanStore { length, check } => {
                if self.is_armed() {
                    Outcome::Answer(Err(Refusal::Armed))
                } else if self.writer.store(board, length, check, sequence) {
                    Outcome::Later
                } else {
                    Outcome::Answer(Err(Refusal::BadPlan))
                }
            }
            Command::PlanRead { offset } => self.read_plan(board, offset),
            Command::FaultRead { back } => match self.read_fault(board, back) {
                Ok(()) => Outcome::Quiet,
                Err(refusal) => Outcome::Answer(Err(refusal)),
            },
        }
    }

    /// A piece of the plan it has: the one in EEPROM, or the one compiled in.
    #[inline(never)]
    fn read_plan<B: Board>(&mut self, board: &mut B, offset: u16) -> Outcome {
        let mut bytes = [0; PLAN_CHUNK];
        let newest = self.writer.newest().filter(|_| self.is_stored);
        let length = match newest {
            Some(stored) => {
                stored.read(board, offset, &mut bytes);
                stored.length
            }
            None => {
                for (at, byte) in bytes.iter_mut().enumerate() {
                    let at = offset.saturating_add(at as u16);
                    *byte = board.compiled_plan(at).unwrap_or(0);
                }
                (0..MAX_TABLE)
                    .find(|at| board.compiled_plan(*at).is_none())
                    .unwrap_or(MAX_TABLE)
            }
        };
        let report = Report::PlanChunk {
            offset,
            length,
            bytes,
        };
        self.link.send(board, &report);
        Outcome::Quiet
    }

    /// A host of another version is told ours, and gets no token.
    #[inline(never)]
    fn greet<B: Board>(&mut self, board: &mut B, version: u8) -> Outcome {
        self.link.greet(&mut self.statistics);
        // It was armed with the token of the greeting before.
        self.abandon_arming(board, Refusal::Token);
        let token = self.tokens.greet(board.clock());
        self.tokens.set(if version == VERSION {
            Token::Fresh(token)
        } else {
            Token::None
        });
        let hello = Hello {
            version: VERSION,
            token,
            condition: self.condition(),
            plan: self.balance.fingerprint().unwrap_or(0),
        };
        self.link.send(board, &Report::Hello(hello));
        Outcome::Quiet
    }

    fn stop<B: Board>(&mut self, board: &mut B) -> Result<(), Refusal> {
        self.disarm(board);
        Ok(())
    }

    /// As if the line had been lost, but at once. Said again while torque falls it changes nothing.
    #[inline(never)]
    fn let_down<B: Board>(&mut self, board: &mut B) -> Result<(), Refusal> {
        match self.state.torque() {
            Some(Torque::On(_)) => self.soften(board, Cause::LetDown),
            Some(Torque::Fading(_)) => {}
            Some(Torque::Off) | None => return Err(Refusal::State),
        }
        Ok(())
    }

    fn change<B: Board>(&mut self, board: &mut B, mode: Mode) -> Result<(), Refusal> {
        // It needs no new greeting; arming does.
        let token = self.tokens.now();
        if token == Token::None {
            return Err(Refusal::Version);
        }
        self.enter(board, mode);
        self.tokens.set(token);
        Ok(())
    }

    fn enlist(&mut self, list: &ServoList) -> Result<(), Refusal> {
        if self.is_armed() {
            Err(Refusal::Armed)
        } else if !list.is_sound() {
            Err(Refusal::ServoList)
        } else {
            self.servos.start_over(list);
            self.order_servos();
            Ok(())
        }
    }

    /// Goals count only while streaming with torque on; before that they keep the link alive and no
    /// more.
    fn set_goal(&mut self, sequence: u8, goal: Goal) -> Outcome {
        if let State::Stream(Torque::On(armed)) = &mut self.state {
            armed.goal = goal;
            armed.obeyed = sequence;
        }
        Outcome::Quiet
    }

    #[inline(never)]
    fn telemetry<B: Board>(&mut self, board: &mut B) -> Outcome {
        let (stack_used, stack_size) = board.stack();
        let telemetry = Telemetry {
            reset: board.reset_cause(),
            condition: self.condition(),
            ticks: self.ticks,
            overruns: self.times.overruns,
            tick_us: self.times.last_us,
            longest_tick_us: self.times.longest_us,
            longest_law_us: self.times.longest_law_us,
            stack_used,
            stack_size,
            supply: self.servos.supply.map_or(0, |supply| supply.0),
            gyro: board.gyro(),
            gyro_zero: self.balance.gyro().zero,
            gyro_scale: self.balance.gyro().scale,
            tripped: self.servos.tripped,
            longest_silence_ms: u16::try_from(self.longest_silence_us / 1000).unwrap_or(u16::MAX),
        };
        if self.link.send(board, &Report::Telemetry(telemetry)) {
            self.times.forget_longest();
        }
        Outcome::Quiet
    }

    /// The token that armed since the last greeting; none if none has, or torque went off since.
    pub fn used_token(&self) -> Option<u16> {
        match self.tokens.now() {
            Token::Used(token) => Some(token),
            Token::Fresh(_) | Token::None => None,
        }
    }

    /// Whether torque is on, falling included.
    pub fn is_armed(&self) -> bool {
        self.state.is_armed()
    }
}
