//! The firmware on its simulated board, and what must be remembered to judge it.

use super::IDS;
use super::acts::compiled;
use crate::rig::{DRIVEN, bytes, gyro_plan};
use handstand_cm5_sim::{Bus, SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, GOAL_POSITION};
use handstand_shared::crc::crc32;
use handstand_shared::message::*;
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::Position;
use std::collections::VecDeque;

/// The firmware, and what must be remembered to judge it.
#[derive(Debug)]
pub(super) struct Judged {
    pub(super) cm5: VirtualCm5,
    pub(super) tokens: Vec<u16>,
    /// The token that may arm: of the last greeting, unless it has armed.
    pub(super) fresh: Option<u16>,
    pub(super) armed: bool,
    /// Fingerprint of the plan when it was armed.
    pub(super) plan: Option<u32>,
    /// When signs of life, and attitudes, arrived, the last ones.
    pub(super) lives: Arrivals,
    pub(super) attitudes: Arrivals,
    /// When torque came on last.
    pub(super) armed_ms: f64,
    /// Whether the robot was armed and not yet let down at the last look, and balanced.
    pub(super) was_on: bool,
    pub(super) was_balancing: bool,
    pub(super) was_armed: bool,
    /// Since when the gyro is at a rail, or further from the plan's zero than at rest.
    pub(super) rail_ms: Option<f64>,
    pub(super) far_ms: Option<f64>,
    /// Since when torque may be on in a servo that hears: torque off was ordered.
    pub(super) off_ms: Option<f64>,
    /// Servos whose torque is not the firmware's doing: deaf, or switched by a fault.
    pub(super) odd: Vec<u8>,
    pub(super) button_ms: Option<f64>,
    /// Since when a driven joint is out of its range.
    pub(super) out_ms: Option<f64>,
    pub(super) goals: Vec<u16>,
    pub(super) was_streaming: bool,
    pub(super) looked_ms: f64,
    /// What arming named.
    pub(super) limits: ArmLimits,
    /// When each servo was last disturbed, ms, and when it may have missed a request.
    pub(super) disturbed_ms: Vec<f64>,
    pub(super) deaf_ms: Vec<f64>,
    pub(super) has_noise: bool,
    /// Whether each servo restarted and may not have been read since.
    pub(super) has_restarted: Vec<bool>,
    /// Which servos had torque at the last look.
    pub(super) had_torque: Vec<bool>,
    /// When the supply was changed last.
    pub(super) supply_ms: f64,
    /// Commands to arm that may still be taken: until when, token, limits.
    pub(super) arms: Vec<(f64, u16, ArmLimits)>,
    /// Servos that gave up since arming.
    pub(super) gave_up: Vec<u8>,
    /// Fingerprints of the plans that balance with the gyro.
    by_gyro: [u32; 2],
}

/// When frames of a kind arrived, ms; some may be on the line.
#[derive(Debug, Default)]
pub(super) struct Arrivals(VecDeque<f64>);

impl Arrivals {
    fn add(&mut self, at_ms: f64) {
        self.0.push_back(at_ms);
        if self.0.len() > 8 {
            self.0.pop_front();
        }
    }

    /// The last that had arrived.
    pub(super) fn last_by(&self, now_ms: f64) -> f64 {
        let arrived = self.0.iter().rev().find(|at_ms| **at_ms <= now_ms);
        arrived.copied().unwrap_or(f64::NEG_INFINITY)
    }
}

impl Judged {
    pub(super) fn new() -> Self {
        let mut cm5 = VirtualCm5::with_plan(compiled(false), vec![0xff; 4096], ResetCause(1));
        cm5.board.bus = Bus::new(IDS);
        cm5.board.take_time();
        for id in DRIVEN {
            let servo = cm5.bus().servo(id).expect("it is there");
            servo.set(CW_LIMIT, 0);
            servo.set(CCW_LIMIT, 0);
            servo.free = false;
        }
        let mut judged = Judged {
            cm5,
            tokens: Vec::new(),
            fresh: None,
            armed: false,
            plan: None,
            lives: Arrivals::default(),
            attitudes: Arrivals::default(),
            armed_ms: f64::NEG_INFINITY,
            was_on: false,
            was_balancing: false,
            was_armed: false,
            rail_ms: None,
            far_ms: None,
            off_ms: Some(0.0),
            odd: Vec::new(),
            button_ms: None,
            out_ms: None,
            goals: vec![512; IDS.len()],
            was_streaming: false,
            looked_ms: 0.0,
            limits: ArmLimits::NONE,
            disturbed_ms: vec![f64::NEG_INFINITY; IDS.len()],
            deaf_ms: vec![f64::NEG_INFINITY; IDS.len()],
            has_noise: false,
            has_restarted: vec![false; IDS.len()],
            had_torque: vec![false; IDS.len()],
            supply_ms: 0.0,
            arms: Vec::new(),
            gave_up: Vec::new(),
            by_gyro: [bytes(&gyro_plan()), compiled(true)].map(|table| crc32(&table)),
        };
        judged.hello(VERSION);
        judged.send(&Command::Mode(Mode::Stream));
        judged.send(&list());
        judged
    }

    /// Says it, until it has arrived and was taken; but for arming, torque comes on by nothing.
    pub(super) fn send(&mut self, command: &Command) -> Option<Result<(), Refusal>> {
        self.cm5.clear();
        let sequence = self.cm5.send(command);
        let arrived_ms = self.cm5.board.last_byte_ns() as f64 * 1e-6;
        let before_ms = self.cm5.now_ms();
        if command.is_life() {
            self.lives.add(arrived_ms);
        }
        if let Command::Attitude(_) = command {
            self.attitudes.add(arrived_ms);
        }
        self.run((arrived_ms - before_ms).max(0.0) + 0.01);
        self.cm5
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            })
    }

    pub(super) fn run(&mut self, ms: f64) {
        // Looked at often enough to see what lasts for a tick.
        let until_ms = self.cm5.now_ms() + ms;
        loop {
            let left_ms = until_ms - self.cm5.now_ms();
            if left_ms <= 0.0 {
                break;
            }
            self.cm5.run_ms(left_ms.clamp(0.01, 10.0));
            self.judge();
        }
    }

    pub(super) fn goals_now(&self) -> Vec<u16> {
        let servos = self.cm5.board.bus.servos.iter();
        servos.map(|servo| servo.get(GOAL_POSITION)).collect()
    }

    pub(super) fn servo(&mut self, at: usize) -> &mut handstand_cm5_sim::Servo {
        &mut self.cm5.board.bus.servos[at]
    }

    pub(super) fn set_shaft(&mut self, at: usize, code: u16) {
        self.servo(at).shaft.angle_rad = Position(code).to_rad();
        let [low, high] = [312, 692];
        let out = [0, 2].into_iter().any(|at| {
            let code = Position::from_rad(self.servo(at).shaft.angle_rad).0;
            code < low || code > high
        });
        let now_ms = self.cm5.now_ms();
        self.out_ms = if out {
            Some(self.out_ms.unwrap_or(now_ms))
        } else {
            None
        };
    }

    /// A servo that restarted, or was silent, or whose answers were spoilt: the firmware knows its
    /// goal, and whether it gave up, only when it was read.
    pub(super) fn disturb(&mut self, at: usize) {
        self.disturbed_ms[at] = self.cm5.now_ms();
    }

    /// Whether the servo may not have been read yet since it was disturbed last, or is not read.
    pub(super) fn is_disturbed(&self, at: usize) -> bool {
        // Each is read in every second round of the housekeeping: of 18 servos, most of which are
        // silent, those are 18 ticks of up to 18 ms.
        const READ_MS: f64 = 350.0;
        let faults = &self.cm5.board.bus.servos[at].faults;
        let is_unsure = faults.corrupt_request + faults.stray + faults.late > 0.0;
        let is_new = self.cm5.now_ms() - self.disturbed_ms[at] < READ_MS;
        faults.dead || is_unsure || self.has_noise || is_new
    }

    /// Whether a servo may not have heard torque off, which is said again for 200 ms: it is dead,
    /// or requests to it are corrupted, or meet an answer that comes late. Noise is the
    /// controller's alone, and a stray byte comes with an answer.
    pub(super) fn may_be_deaf(&self, at: usize) -> bool {
        const SAID_MS: f64 = 250.0;
        let servos = &self.cm5.board.bus.servos;
        let faults = &servos[at].faults;
        let collides = servos.iter().any(|servo| servo.faults.late > 0.0);
        let is_new = self.cm5.now_ms() - self.deaf_ms[at] < SAID_MS;
        faults.dead || faults.corrupt_request > 0.0 || collides || is_new
    }

    pub(super) fn set_gyro(&mut self, code: u16) {
        let now_ms = self.cm5.now_ms();
        self.cm5.board.gyro = code;
        let since = |is_so: bool, since: Option<f64>| is_so.then(|| since.unwrap_or(now_ms));
        self.rail_ms = since(!(8..=1015).contains(&code), self.rail_ms);
        self.far_ms = since(code.abs_diff(512) > 50, self.far_ms);
    }

    /// Whether the plan that it balances with is one of the gyro's.
    pub(super) fn is_by_gyro(&self) -> bool {
        self.plan.is_some_and(|plan| self.by_gyro.contains(&plan))
    }

    pub(super) fn release_buttons(&mut self) {
        self.cm5.board.buttons = 0;
        self.button_ms = None;
    }
}

/// The list of the servos that are there.
pub(super) fn list() -> Command {
    let mut list = ServoList {
        count: IDS.len() as u8,
        ids: [0; SERVOS],
    };
    list.ids[..IDS.len()].copy_from_slice(&IDS);
    Command::ServoList(list)
}
