//! What each step does.

use super::IDS;
use super::judged::{Judged, list};
use super::steps::{Flood, ServoFault, Step, Token, Upload};
use crate::rig::{bytes, gyro_plan, plan};
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::app::State;
use handstand_shared::control_table::TORQUE_ENABLE;
use handstand_shared::crc::crc32;
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::plan::Plan;

/// A frame that arrives during a tick is taken at its end, and arming lasts 30 ticks of up to 18
/// ms: torque comes on so much later at most, ms.
pub(super) const TAKEN_MS: f64 = 25.0 + 30.0 * 18.0;

impl Judged {
    pub(super) fn step(&mut self, step: &Step) {
        match step {
            Step::Wait(ms) => self.run(*ms),
            Step::Hello(version) => self.hello(*version),
            Step::Mode(mode) => {
                self.send(&Command::Mode(*mode));
            }
            Step::Arm(token, limits) => self.arm(*token, *limits),
            Step::Disarm => {
                self.send(&Command::Disarm);
            }
            Step::LetDown => {
                self.send(&Command::LetDown);
            }
            Step::KeepAlive => {
                self.send(&Command::KeepAlive);
            }
            Step::Attitude(angle) => {
                let (angle, rate) = (*angle, 0);
                self.send(&Command::Attitude(Attitude { angle, rate }));
            }
            Step::Goals(code) => {
                self.send(&Command::Goals(Positions::pack([*code; SERVOS])));
            }
            Step::Ready(mode) => self.ready(*mode),
            Step::Ask => {
                self.send(&Command::Ask(Subject::Telemetry));
            }
            Step::PlanRead(offset) => {
                self.send(&Command::PlanRead { offset: *offset });
            }
            Step::Chunk(at, which) => {
                let table = table(*which);
                let mut bytes = [0; PLAN_CHUNK];
                let piece = table.chunks(PLAN_CHUNK).nth(*at).unwrap_or(&[]);
                bytes[..piece.len()].copy_from_slice(piece);
                let offset = (at * PLAN_CHUNK) as u16;
                self.send(&Command::PlanChunk { offset, bytes });
            }
            Step::Store(which) => {
                let table = table(*which);
                let (length, check) = (table.len() as u16, crc32(&table));
                self.send(&Command::PlanStore { length, check });
            }
            Step::Flood(what, ms) => self.flood(*what, *ms),
            Step::Gyro(code) => self.set_gyro(*code),
            Step::List(whole) => {
                let list = if *whole {
                    Command::ServoList(ServoList::default())
                } else {
                    list()
                };
                self.send(&list);
            }
            Step::Button(down) => {
                self.release_buttons();
                self.cm5.board.buttons = *down;
                self.button_ms = (*down != 0).then(|| self.cm5.now_ms());
            }
            Step::Supply(volts) => {
                self.supply_ms = self.cm5.now_ms();
                (0..IDS.len()).for_each(|at| self.servo(at).supply_v = *volts);
            }
            Step::Dead(at, dead) => {
                let id = IDS[*at];
                // What it missed it may hear again in 200 ms, or for ever in a fault.
                if *dead || self.servo(*at).faults.dead {
                    self.odd.push(id);
                }
                self.servo(*at).faults.dead = *dead;
                self.deafen();
                self.disturb(*at);
            }
            Step::Overload(at) => {
                // Without torque there was nothing to give up: arming, which for balancing switches
                // torque on a tick later, brings it back.
                let had_torque = self.servo(*at).torque_is_on();
                self.servo(*at).overload();
                if had_torque {
                    self.gave_up.push(IDS[*at]);
                }
            }
            Step::Hot(at, hot) => {
                self.servo(*at).temperature = if *hot { 90.0 } else { 30.0 };
            }
            Step::TorqueLost(at) => self.servo(*at).set(TORQUE_ENABLE, 0),
            Step::Shaft(at, code) => self.set_shaft(*at, *code),
            Step::Noise(every_us) => {
                let now_ns = self.cm5.board.now_ns();
                let every_ns = every_us.map(|us| us * 1000);
                self.has_noise = every_us.is_some();
                (0..IDS.len()).for_each(|at| self.disturb(at));
                self.cm5.board.bus.set_noise(now_ns, every_ns);
            }
            Step::Garbage(bytes) => {
                self.garbage(bytes);
            }
            Step::Servo(at, fault) => self.servo_fault(*at, *fault),
            Step::Restart(cause) => self.restart(*cause),
            Step::Flash(by_gyro) => {
                self.cm5.board.eeprom.fill(0xff);
                self.cm5.board.compiled = compiled(*by_gyro);
                self.restart(ResetCause::POWER);
            }
        }
        self.judge();
    }

    pub(super) fn hello(&mut self, version: u8) {
        // Its answer must be told from those before it: the line empties, noise ends, and an
        // adapter gives up what was begun.
        let now_ns = self.cm5.board.now_ns();
        self.cm5.board.bus.set_noise(now_ns, None);
        self.end_noise();
        self.run(75.0);
        // What an adapter passed on may have spoilt the first.
        for _ in 0..3 {
            self.send(&Command::Hello { version });
            self.run(70.0);
            let mut reports = self.cm5.reports().into_iter();
            let hello = reports.find_map(|(_, report)| match report {
                Report::Hello(hello) => Some(hello),
                _ => None,
            });
            if let Some(hello) = hello {
                self.tokens.push(hello.token);
                self.fresh = (version == VERSION).then_some(hello.token);
                return;
            }
        }
        panic!("no answer to a greeting in {:?}", self.cm5.app.state());
    }

    fn arm(&mut self, token: Token, limits: ArmLimits) {
        let token = match token {
            Token::Last => self.tokens.last().copied(),
            Token::Earlier(back) => self.tokens.iter().rev().nth(back).copied(),
            Token::Any(token) => Some(token),
        };
        let token = token.unwrap_or(0);
        self.judge();
        self.cm5.clear();
        self.cm5.send(&Command::Arm { token, limits });
        let arrived_ms = self.cm5.board.last_byte_ns() as f64 * 1e-6;
        self.arms.push((arrived_ms + TAKEN_MS, token, limits));
        while self.cm5.now_ms() < arrived_ms + 0.01 {
            let left_ms = arrived_ms + 0.01 - self.cm5.now_ms();
            self.cm5.run_ms(left_ms.clamp(0.01, 10.0));
            self.judge();
        }
    }

    /// Faults that spoil requests change: what was missed under them is said again.
    fn deafen(&mut self) {
        let now_ms = self.cm5.now_ms();
        self.deaf_ms.fill(now_ms);
    }

    fn ready(&mut self, mode: Mode) {
        self.deafen();
        for at in 0..IDS.len() {
            let servo = self.servo(at);
            servo.faults.dead = false;
            servo.faults.corrupt_request = 0.0;
            servo.faults.stray = 0.0;
            servo.faults.late = 0.0;
            servo.temperature = 30.0;
            servo.supply_v = 9.6;
            self.disturb(at);
            self.set_shaft(at, 512);
        }
        let now_ns = self.cm5.board.now_ns();
        self.cm5.board.bus.set_noise(now_ns, None);
        self.end_noise();
        self.release_buttons();
        self.set_gyro(512);
        self.supply_ms = self.cm5.now_ms();
        self.hello(VERSION);
        self.send(&Command::Mode(mode));
        // As long as it takes to ask all for their supply and mode.
        for _ in 0..16 {
            self.send(&Command::Attitude(Attitude::default()));
            self.run(8.0);
        }
        self.arm(Token::Last, ArmLimits::FULL);
        for _ in 0..50 {
            if self.cm5.app.is_armed() {
                break;
            }
            self.send(&Command::Attitude(Attitude::default()));
            self.run(8.0);
        }
    }

    fn servo_fault(&mut self, at: usize, fault: ServoFault) {
        if let ServoFault::Corrupt(_) | ServoFault::Late(_) = fault {
            self.deafen();
        }
        self.disturb(at);
        self.has_restarted[at] |= matches!(fault, ServoFault::Restarts);
        let servo = self.servo(at);
        match fault {
            ServoFault::Restarts => servo.restart(),
            ServoFault::Corrupt(share) => servo.faults.corrupt_request = share,
            ServoFault::Stray(share) => servo.faults.stray = share,
            ServoFault::Late(share) => servo.faults.late = share,
            ServoFault::NeedsTime(ns) => servo.faults.write_ns = ns,
            ServoFault::GoalSwitchesOn(does) => servo.goal_switches_on = does,
        }
    }

    fn end_noise(&mut self) {
        if std::mem::take(&mut self.has_noise) {
            (0..IDS.len()).for_each(|at| self.disturb(at));
        }
    }

    fn restart(&mut self, cause: u8) {
        let bus = std::mem::replace(&mut self.cm5.board.bus, Bus::new([]));
        let eeprom = std::mem::take(&mut self.cm5.board.eeprom);
        let compiled = std::mem::take(&mut self.cm5.board.compiled);
        let tokens = std::mem::take(&mut self.tokens);
        let now_ns = self.cm5.board.now_ns();
        let mut board = HostBoard::at(now_ns, bus);
        board.take_time();
        board.gyro = self.cm5.board.gyro;
        (board.eeprom, board.compiled) = (eeprom, compiled);
        board.reset_cause = ResetCause(cause);
        let deaf = board.bus.servos.iter().filter(|servo| servo.faults.dead);
        let odd = deaf.map(|servo| servo.id()).collect();
        self.cm5 = VirtualCm5::start(board);
        assert!(!self.cm5.app.is_armed());
        (self.armed, self.fresh, self.tokens) = (false, None, tokens);
        (self.off_ms, self.odd) = (Some(self.cm5.now_ms()), odd);
        self.button_ms = None;
    }

    fn flood(&mut self, what: Flood, ms: f64) {
        let command = match what {
            Flood::Telemetry => Command::Ask(Subject::Telemetry),
            Flood::Statistics => Command::Ask(Subject::Statistics),
            Flood::PlanRead => Command::PlanRead { offset: 0 },
            Flood::FaultRead => Command::FaultRead { back: 0 },
            Flood::WrongPlan => Command::PlanStore {
                length: 1200,
                check: 1,
            },
            Flood::Arm => Command::Arm {
                token: self.tokens.last().map_or(0, |token| token ^ 0x5555),
                limits: ArmLimits::FULL,
            },
        };
        let until_ms = self.cm5.now_ms() + ms;
        while self.cm5.now_ms() < until_ms {
            // The line never falls silent.
            while self.cm5.board.last_byte_ns() < self.cm5.board.now_ns() + 15_000_000 {
                self.cm5.send(&command);
            }
            self.run(5.0);
        }
        let left_ms = self.cm5.board.last_byte_ns() as f64 * 1e-6 - self.cm5.now_ms();
        self.run(left_ms.max(0.0) + 0.01);
        self.cm5.clear();
    }

    /// As an adapter it passes them on: any could be a packet that switches torque on.
    fn garbage(&mut self, bytes: &[u8]) {
        if let State::Bridge = self.cm5.app.state() {
            return;
        }
        self.cm5.send_bytes(bytes);
        self.cm5.send_bytes(&[0]);
        self.run(4.0);
    }
}

/// A plan's bytes.
fn table(which: Upload) -> Vec<u8> {
    match which {
        Upload::ByHost => bytes(&plan()),
        Upload::ByGyro => bytes(&gyro_plan()),
        Upload::Part => {
            let other = Plan {
                range: 7000,
                ..plan()
            };
            bytes(&other)[..60].to_vec()
        }
    }
}

/// The plan compiled in: another one than those that are uploaded.
pub(super) fn compiled(by_gyro: bool) -> Vec<u8> {
    let mut table = bytes(&if by_gyro { gyro_plan() } else { plan() });
    if let Some(last) = table.last_mut() {
        *last ^= 1;
    }
    table
}
