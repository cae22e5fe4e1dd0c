//! Three links on a bar, carried forward at 20 kHz: the laws of a chain, written down a second
//! time on purpose.
//!
//! As the arm: the midpoint rule, drift-kick-drift, and dry friction as impulses that can stop
//! joints but never reverse them. Forces are those of absolute angles, where the equations are
//! shortest; state, drives and friction are the joints'.

mod laws;

use super::encoder::Encoder;
use super::gyro::Gyro;
use super::history::History;
use super::moving_base::BaseState;
use super::physics::DriveCommand;
use laws::ChainForces;
use rand_chacha::ChaCha8Rng;

pub use laws::Laws;

/// Links of the robot.
pub const LINKS: usize = 3;
/// A value per joint, or per link.
pub type Joints = [f64; LINKS];
/// Longest integration step, s.
const STEP_S: f64 = 1.0 / 20_000.0;
/// Rounds in which the joints' dry friction settles, and the change of speed, rad/s, that ends
/// them.
const ROUNDS: (usize, f64) = (60, 1e-13);

/// The inverse of a symmetric positive matrix of three rows, by its adjugate.
fn inverse(m: &[Joints; LINKS]) -> [Joints; LINKS] {
    let minor = |a: usize, b: usize| {
        let (r, s) = ((a + 1) % 3, (a + 2) % 3);
        let (c, d) = ((b + 1) % 3, (b + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let whole = (0..3).map(|k| m[0][k] * minor(0, k)).sum::<f64>();
    std::array::from_fn(|a| std::array::from_fn(|b| minor(b, a) / whole))
}

/// State of the robot and its encoders.
#[derive(Debug, Clone)]
pub struct Robot<'a> {
    laws: &'a Laws,
    /// Joint angles, rad.
    pub angle: Joints,
    /// Joint speeds, rad/s.
    pub speed: Joints,
    encoders: [Encoder; LINKS],
    gyros: [Gyro; LINKS],
    histories: [History; LINKS],
    /// Torques of dry friction in the last kick, N m: where the next one begins to settle.
    dry: Joints,
    base: BaseState,
}

impl<'a> Robot<'a> {
    /// At these angles and speeds, the encoders in the middle of their play.
    pub fn new(laws: &'a Laws, angle: Joints, speed: Joints) -> Self {
        let encoder = |k: usize| Encoder::at_rest(laws.joints[k].encoded(angle[k]));
        Robot {
            laws,
            angle,
            speed,
            encoders: std::array::from_fn(encoder),
            gyros: laws::summed(&speed).map(Gyro::turning),
            histories: Default::default(),
            dry: [0.0; LINKS],
            base: laws.sagged(),
        }
    }

    /// Goes on for `span_s`; `push` tells the drives' state, given the seconds since the beginning
    /// of the span.
    pub fn advance(&mut self, span_s: f64, push: impl Fn(f64) -> [DriveCommand; LINKS]) {
        let steps = (span_s / STEP_S).ceil().max(1.0);
        let h = span_s / steps;
        for step in 0..steps as usize {
            self.step(h, &push((step as f64 + 0.5) * h));
        }
    }

    fn step(&mut self, h: f64, push: &[DriveCommand; LINKS]) {
        let (joints, before) = (&self.laws.joints, self.angle);
        let push: &[DriveCommand; LINKS] =
            &std::array::from_fn(|k| self.histories[k].ramp(&joints[k], push[k], h));
        self.drift(0.5 * h);
        let (halfway, dry, base) = self.kicked(0.5 * h, push, (&self.speed, self.base));
        self.dry = dry;
        let (speed, dry, base) = self.kicked(h, push, (&halfway, base));
        for (k, history) in self.histories.iter_mut().enumerate() {
            history.kick(
                &joints[k],
                |speed| joints[k].drive(push[k], speed),
                halfway[k],
                h,
            );
        }
        let rates = [laws::summed(&self.speed), laws::summed(&speed)];
        for (k, gyro) in self.gyros.iter_mut().enumerate() {
            if let Some(law) = joints[k].gyro {
                gyro.follow(law, rates.map(|rate| rate[k]), h);
            }
        }
        (self.speed, self.dry, self.base) = (speed, dry, base);
        self.drift(0.5 * h);
        for (k, encoder) in self.encoders.iter_mut().enumerate() {
            let physics = &joints[k];
            self.histories[k].pass(physics, push[k], self.angle[k] - before[k], h);
            encoder.follow(physics, physics.encoded(self.angle[k]), h);
        }
    }

    fn drift(&mut self, h: f64) {
        self.base.drift(h);
        let histories = self.histories.iter_mut();
        for ((angle, speed), history) in self.angle.iter_mut().zip(&self.speed).zip(histories) {
            *angle += h * speed;
            history.drift(h, *speed);
        }
    }

    /// Speeds after all torques have acted for `h` seconds, as they are at this pose and these
    /// speeds of joints and base, the torques of dry friction, N m, and the base.
    fn kicked(
        &self,
        h: f64,
        push: &[DriveCommand; LINKS],
        (at_speed, at_base): (&Joints, BaseState),
    ) -> (Joints, Joints, BaseState) {
        let joints = &self.laws.joints;
        let ChainForces {
            mut mass,
            on_base,
            needed,
        } = self.laws.forces(&self.angle, at_speed);
        let mut pulled = [0.0; LINKS];
        let moving = self.laws.base().map(|base| {
            let force = at_base.force(base, &on_base, self.laws.tilt());
            for k in 0..LINKS {
                pulled[k] = base.pulls(&on_base, k, force);
                for (l, mass) in mass[k].iter_mut().enumerate() {
                    *mass -= base.yields(&on_base, k, l);
                }
            }
            (base, force)
        });
        let histories = &self.histories;
        let drive = self.laws.drives(push, at_speed, histories);
        let inverse = inverse(&mass);
        let pull: Joints = std::array::from_fn(|k| {
            let bristle = histories[k].bristle_nm(&joints[k]);
            let smooth = joints[k].smooth(self.angle[k], at_speed[k]);
            drive[k] - needed[k] + smooth + bristle - pulled[k]
        });
        let mut speed: Joints = std::array::from_fn(|k| {
            let gained: f64 = (0..LINKS).map(|l| inverse[k][l] * pull[l]).sum();
            self.speed[k] + h * gained
        });
        // Impulses of dry friction, least and most.
        let limits: [(f64, f64); LINKS] = std::array::from_fn(|k| {
            let (motor, holding) = if joints[k].stall_nm > 0.0 {
                (drive[k], needed[k])
            } else {
                (0.0, 0.0)
            };
            let state = [self.angle[k], at_speed[k]];
            let most = |direction| h * joints[k].friction(state, direction, motor, holding);
            (-most(1.0), most(-1.0))
        });
        let impulse = self.dry_impulses(h, &inverse, &limits, &mut speed);
        let base = moving.map_or(self.base, |(base, force)| {
            let gained = std::array::from_fn(|k| speed[k] - self.speed[k]);
            self.base.kicked(base, &on_base, (force, h), &gained)
        });
        (speed, impulse.map(|impulse| impulse / h), base)
    }

    /// The impulses of dry friction that stop every joint as far as their limits let them, N m s,
    /// by Gauss and Seidel's rounds from those of the step before; they change the speeds.
    fn dry_impulses(
        &self,
        h: f64,
        inverse: &[Joints; LINKS],
        limits: &[(f64, f64); LINKS],
        speed: &mut Joints,
    ) -> Joints {
        let mut impulse: Joints =
            std::array::from_fn(|k| (h * self.dry[k]).clamp(limits[k].0, limits[k].1));
        for (k, speed) in speed.iter_mut().enumerate() {
            *speed += (0..LINKS).map(|l| inverse[k][l] * impulse[l]).sum::<f64>();
        }
        for _ in 0..ROUNDS.0 {
            let mut moved = 0.0_f64;
            for k in 0..LINKS {
                let (least, most) = limits[k];
                let wanted = impulse[k] - speed[k] / inverse[k][k];
                let change = wanted.clamp(least, most) - impulse[k];
                impulse[k] += change;
                for (l, speed) in speed.iter_mut().enumerate() {
                    *speed += inverse[l][k] * change;
                }
                moved = moved.max((inverse[k][k] * change).abs());
            }
            if moved < ROUNDS.1 {
                break;
            }
        }
        impulse
    }

    /// The encoders' values before noise and rounding, rad.
    pub fn sensed(&self) -> Joints {
        std::array::from_fn(|k| self.encoders[k].sensed())
    }

    /// What a log holds of the links' gyros, rad/s, from the bar outwards.
    pub fn rates(&self, rng: &mut ChaCha8Rng) -> Vec<f64> {
        let gyros = self.gyros.iter().zip(&self.laws.joints);
        gyros
            .filter_map(|(gyro, joint)| Some(gyro.read(joint.gyro?, rng)))
            .collect()
    }

    /// Those that columns whose times are off hold in a row of so many seconds since the beginning,
    /// rad.
    pub fn logged(&self, row_s: f64) -> Joints {
        std::array::from_fn(|k| self.encoders[k].logged(&self.laws.joints[k], row_s))
    }

    /// Kinetic and potential energy in gravity, J, without tilt; tests only look at its change.
    #[cfg(test)]
    pub fn energy_j(&self) -> f64 {
        let mass = self.laws.forces(&self.angle, &self.speed).mass;
        let kinetic: f64 = (0..LINKS)
            .flat_map(|k| (0..LINKS).map(move |l| (k, l)))
            .map(|(k, l)| 0.5 * mass[k][l] * self.speed[k] * self.speed[l])
            .sum();
        let theta = laws::summed(&self.angle);
        let mut joint_height = 0.0;
        let mut potential = 0.0;
        for (k, link) in self.laws.joints.iter().enumerate() {
            let height = joint_height - link.com_m * (theta[k] + link.com_angle).cos();
            potential += link.mass_kg * super::physics::GRAVITY_M_S2 * height;
            joint_height -= self.laws.length_m[k] * theta[k].cos();
        }
        kinetic + potential
    }
}
