//! Three links and the servos on them. Angles are relative, the first from hanging.

use super::SimulatedCm5;
use super::balance::Conditions;
use handstand::Model;
use handstand::dynamics::{Chain, Workspace};
use handstand_shared::message::Attitude;
use std::f64::consts::PI;
use std::path::Path;

/// Torque of a joint at full output, N m: the paper's limit.
pub const FULL_NM: f64 = 2.0;
/// Step of the simulation, ms.
pub const STEP_MS: f64 = 0.5;
/// The gyro's rate of one ADC code: the paper's.
pub const GYRO_STEP_RAD_S: f64 = 10.0 * PI / 180.0;
/// Its code at rest.
pub const GYRO_ZERO: u16 = 512;
/// A first link that leans further has fallen, rad.
const FALLEN_RAD: f64 = 0.8;

/// The robot.
pub struct Robot {
    chain: Chain,
    work: Workspace,
    angle_rad: [f64; 3],
    speed_rad_s: [f64; 3],
    dead_zone: f64,
}

/// The paper's robot.
pub fn model() -> Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host/models/handstand.toml");
    Model::load(&file).expect("the repository's own model")
}

impl Robot {
    /// At rest where it starts.
    pub fn new(conditions: &Conditions) -> Self {
        let mut chain = model().chain();
        for (link, aside_m) in chain.links.iter_mut().zip(conditions.eccentric_m) {
            link.com_angle_rad = (aside_m / link.com_m).atan();
        }
        let [first, second, third] = conditions.start_rad;
        Robot {
            chain,
            work: Workspace::new(3),
            angle_rad: [PI + first, second, third],
            speed_rad_s: [0.0; 3],
            dead_zone: conditions.dead_zone,
        }
    }

    /// The first link's angle from upright, rad.
    pub fn lean_rad(&self) -> f64 {
        self.angle_rad[0] - PI
    }

    /// Angles from upright and straight, rad, and the first link's speed, rad/s.
    pub fn readings(&self) -> [f64; 4] {
        let [_, second, third] = self.angle_rad;
        [self.lean_rad(), second, third, self.speed_rad_s[0]]
    }

    /// Whether it has fallen.
    pub fn has_fallen(&self) -> bool {
        self.lean_rad().abs() > FALLEN_RAD
    }

    /// What an attitude sensor says of the first link.
    pub fn attitude(&self) -> Attitude {
        Attitude {
            angle: (self.lean_rad() / Attitude::ANGLE_LSB_RAD).round() as i16,
            rate: (self.speed_rad_s[0] / Attitude::RATE_LSB_RAD_S).round() as i16,
        }
    }

    /// The code that a gyro on the first link makes.
    pub fn gyro(&self) -> u16 {
        let code = f64::from(GYRO_ZERO) + (self.speed_rad_s[0] / GYRO_STEP_RAD_S).round();
        code.clamp(0.0, 1023.0) as u16
    }

    /// The servos' torques.
    pub fn torques(&self, bench: &mut impl SimulatedCm5) -> [f64; 2] {
        [1, 11].map(|id| {
            let servo = bench.bus().servo(id).expect("18 servos");
            self.torque(servo.regulator().duty(0.0))
        })
    }

    /// Torque for a share of full output: linear outside the dead zone.
    pub fn torque(&self, duty: f64) -> f64 {
        let beyond = (duty.abs() - self.dead_zone).max(0.0) / (1.0 - self.dead_zone);
        FULL_NM * beyond.copysign(duty)
    }

    /// Puts the servos' shafts where the joints are.
    pub fn place(&self, bench: &mut impl SimulatedCm5) {
        for (joint, id) in [(1, 1), (2, 11)] {
            for (id, sign) in [(id, 1.0), (id + 1, -1.0)] {
                let servo = bench.bus().servo(id).expect("18 servos");
                servo.shaft.angle_rad = sign * self.angle_rad[joint];
                servo.shaft.speed_rad_s = sign * self.speed_rad_s[joint];
            }
        }
    }

    /// One step of classical Runge-Kutta.
    pub fn advance(&mut self, torque_nm: [f64; 2]) {
        let dt_s = STEP_MS * 1e-3;
        let (q, v) = (self.angle_rad, self.speed_rad_s);
        let at = |a: [f64; 3], b: [f64; 3], h: f64| std::array::from_fn(|i| a[i] + h * b[i]);
        let a1 = self.accelerate(&q, &v, torque_nm);
        let (q2, v2): ([f64; 3], [f64; 3]) = (at(q, v, dt_s / 2.0), at(v, a1, dt_s / 2.0));
        let a2 = self.accelerate(&q2, &v2, torque_nm);
        let (q3, v3): ([f64; 3], [f64; 3]) = (at(q, v2, dt_s / 2.0), at(v, a2, dt_s / 2.0));
        let a3 = self.accelerate(&q3, &v3, torque_nm);
        let (q4, v4): ([f64; 3], [f64; 3]) = (at(q, v3, dt_s), at(v, a3, dt_s));
        let a4 = self.accelerate(&q4, &v4, torque_nm);
        for i in 0..3 {
            self.angle_rad[i] += dt_s / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
            self.speed_rad_s[i] += dt_s / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
        }
    }

    fn accelerate(&mut self, q: &[f64; 3], v: &[f64; 3], torque_nm: [f64; 2]) -> [f64; 3] {
        let torque = [0.0, torque_nm[0], torque_nm[1]];
        let mut out = [0.0; 3];
        let base = self.chain.base_m_s2(0.0);
        self.chain
            .forward(&mut self.work, base, q, v, &torque, &[false; 3], &mut out);
        out
    }
}
