//! What a tick does in each state.

use super::{App, Goal, Onset};
use crate::balance::Stop;
use crate::board::{Board, since_us};
use crate::bus;
use handstand_shared::message::{Cause, Report, StreamReport};

impl App {
    /// Torque off, or about to be: reads and reports.
    #[inline(never)]
    pub(super) fn watch<B: Board>(&mut self, board: &mut B, started: u16) {
        self.read(board, started);
        self.report(board);
    }

    /// Reads the gyro, before the servos: their answers take another time in every tick. The
    /// estimate goes on while they are waited for: after the commands it would lengthen the tick.
    #[inline(never)]
    fn read<B: Board>(&mut self, board: &mut B, started: u16) {
        self.gyro = board.gyro();
        let balance = &mut self.balance;
        let meanwhile = || balance.step_update();
        self.servos
            .read(board, &mut self.statistics, started, meanwhile);
    }

    /// Torque must stay off: says so every eighth tick, for a servo may have missed it.
    pub(super) fn insist<B: Board>(&mut self, board: &mut B, started: u16) {
        if self.ticks & 7 == 0 {
            bus::torque_off(board);
        }
        self.watch(board, started);
    }

    /// Goals first, for their delay counts most; then reads and reports.
    #[inline(never)]
    pub(super) fn stream<B: Board>(&mut self, board: &mut B, started: u16) {
        if let Some(cause) = self.must_stop(started) {
            self.soften(board, cause);
        } else if let Some(armed) = self.state.armed_mut() {
            if armed.onset == Onset::Torque {
                // Goals were sent after the last tick: long enough ago for servos to obey both.
                self.servos.switch_on(board);
                armed.onset = Onset::Done;
            } else {
                match &armed.goal {
                    Goal::Hold => {}
                    Goal::Positions(goals) => self.servos.go_to(board, goals),
                    Goal::Speeds(speeds) => self.servos.spin(board, speeds),
                }
            }
        }
        self.watch(board, started);
    }

    /// Reads, then the law at once, then the report.
    #[inline(never)]
    pub(super) fn balance<B: Board>(&mut self, board: &mut B, started: u16) {
        if let Some(cause) = self.must_stop(started) {
            self.soften(board, cause);
            return self.watch(board, started);
        }
        self.read(board, started);
        let mut commanded = board.clock();
        match self.servos.gave_up() {
            None if self.has_attitude(board) && self.balance.has_gyro(self.gyro) => {
                self.command(board);
                commanded = board.clock();
            }
            None => self.soften(board, Cause::AttitudeLost),
            // It leaves the other ones to throw the robot: not one command more.
            Some(cause) => self.soften(board, cause),
        }
        // While commands go out.
        self.report(board);
        self.come_on(board, commanded);
    }

    /// The law's commands at these readings.
    #[inline(always)]
    fn command<B: Board>(&mut self, board: &mut B) {
        let law_started = board.clock();
        self.gyro = board.gyro();
        self.balance.sense(self.attitude, self.gyro);
        let readings = match self.balance.readings(&self.servos) {
            Ok(readings) => readings,
            Err(Stop::Fallen) => return self.give_up(board, Cause::Fallen),
            Err(Stop::JointRange) => return self.give_up(board, Cause::JointRange),
            Err(Stop::JointSpeed) => return self.give_up(board, Cause::JointSpeed),
            Err(Stop::ServoLost) => return self.give_up(board, Cause::ServoLost),
        };
        let commands = self.balance.commands(&readings);
        let law_us = since_us(board, law_started);
        self.times.longest_law_us = self.times.longest_law_us.max(law_us);
        self.servos.turn(board, commands);
        self.balance.begin_update();
    }

    /// Torque comes on by another step, behind the commands handed over at this reading of the
    /// clock.
    #[inline(never)]
    fn come_on<B: Board>(&mut self, board: &mut B, commanded: u16) {
        let Some(armed) = self.state.armed_mut() else {
            return;
        };
        if armed.onset == Onset::Done {
            return;
        }
        bus::pause_since(board, commanded);
        let balancing = self.balance.servos();
        match armed.onset {
            // With the first command, not before: without one the robot would fall.
            Onset::Balance => {
                self.servos.switch_on_these(board, balancing);
                armed.onset = Onset::Goals(0);
            }
            Onset::Goals(from) => {
                let next = self.servos.hold_third(board, from, balancing);
                armed.onset = next.map_or(Onset::Others(0), Onset::Goals);
            }
            Onset::Others(from) => {
                let next = self.servos.switch_on_third(board, from);
                armed.onset = next.map_or(Onset::Done, Onset::Others);
            }
            Onset::Torque | Onset::Done => {}
        }
    }

    #[inline(never)]
    fn report<B: Board>(&mut self, board: &mut B) {
        let report = Report::Stream(StreamReport {
            tick: self.ticks as u16,
            condition: self.condition(),
            obeyed: self.state.obeyed(),
            positions: self.servos.positions,
            missing: self.servos.missing(),
            housekeeping_from: self.servos.housekeeping_from,
            housekeeping: self.servos.housekeeping,
            gyro: self.gyro,
        });
        self.link.send(board, &report);
    }

    /// What the tick took since it was due, and what it lost.
    pub(super) fn account<B: Board>(&mut self, board: &mut B, due: u16) {
        self.times.end(board, due);
        let lost = u16::from(board.link_overruns());
        self.statistics.overruns = self.statistics.overruns.saturating_add(lost);
    }
}
