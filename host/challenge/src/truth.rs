//! The arm that is measured: its state, carried forward at 20 kHz.
//!
//! The midpoint rule, drift-kick-drift: an Euler step is early or late by half of itself, and 25 us
//! are more than the error to which three logs tell a delay. Dry friction is an impulse that can
//! stop the arm but never reverse it, so that an arm at rest stays there until it is pushed harder
//! than the breakaway torque.

use super::encoder::Encoder;
use super::gyro::Gyro;
use super::history::History;
use super::moving_base::BaseState;
use super::physics::{DriveCommand, Mount, Physics};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Longest integration step, s.
const STEP_S: f64 = 1.0 / 20_000.0;

/// State of the arm and its encoder.
#[derive(Debug, Clone)]
pub struct Arm<'a> {
    physics: &'a Physics,
    mount: Mount,
    inertia: f64,
    /// Angle from hanging, counter-clockwise, rad.
    pub angle: f64,
    /// Speed, rad/s.
    pub speed: f64,
    encoder: Encoder,
    gyro: Gyro,
    history: History,
    base: BaseState,
}

impl<'a> Arm<'a> {
    /// At rest at `angle` rad, the encoder in the middle of its play.
    pub fn at_rest(physics: &'a Physics, mount: Mount, angle: f64) -> Self {
        Arm {
            physics,
            mount,
            inertia: physics.inertia_at_joint(mount),
            angle,
            speed: 0.0,
            encoder: Encoder::at_rest(physics.encoded(angle)),
            gyro: Gyro::default(),
            history: History::default(),
            base: physics.sagged(mount),
        }
    }

    /// Where the arm comes to rest by itself within 2 s, let go at hanging; starts there.
    pub fn settled(physics: &'a Physics, mount: Mount) -> Self {
        let mut arm = Arm::at_rest(physics, mount, 0.0);
        let released = DriveCommand {
            duty: 0.0,
            supply_v: physics.nominal_supply_v,
            torque_on: false,
        };
        arm.advance(2.0, |_| released);
        Arm::at_rest(physics, mount, arm.angle)
    }

    /// Goes on for `span_s`; `push` tells the drive's state, given the seconds since the beginning
    /// of the span.
    pub fn advance(&mut self, span_s: f64, push: impl Fn(f64) -> DriveCommand) {
        let steps = (span_s / STEP_S).ceil().max(1.0);
        let h = span_s / steps;
        for step in 0..steps as usize {
            self.step(h, push((step as f64 + 0.5) * h));
        }
    }

    /// `push` is that of the middle of the step.
    fn step(&mut self, h: f64, push: DriveCommand) {
        let (push, before) = (self.history.ramp(self.physics, push, h), self.angle);
        self.drift(0.5 * h);
        let (halfway, base) = self.kicked(0.5 * h, push, (self.speed, self.base));
        let (after, base) = self.kicked(h, push, (halfway, base));
        let physics = self.physics;
        let drive = |speed| physics.drive(push, speed);
        self.history.kick(physics, drive, halfway, h);
        if let Some(law) = physics.gyro {
            self.gyro.follow(law, [self.speed, after], h);
        }
        (self.speed, self.base) = (after, base);
        self.drift(0.5 * h);
        self.history.pass(physics, push, self.angle - before, h);
        let encoded = self.physics.encoded(self.angle);
        self.encoder.follow(self.physics, encoded, h);
    }

    fn drift(&mut self, h: f64) {
        self.angle += h * self.speed;
        self.history.drift(h, self.speed);
        self.base.drift(h);
    }

    /// Speeds of arm and base after all torques have acted for `h` seconds, as they are at this
    /// angle and `at` those speeds.
    fn kicked(
        &self,
        h: f64,
        push: DriveCommand,
        (at_speed, at_base): (f64, BaseState),
    ) -> (f64, BaseState) {
        let holding = self.physics.holding(self.mount, self.angle);
        let (physics, history) = (self.physics, &self.history);
        let drive = history.passed_on(physics, |speed| physics.drive(push, speed), at_speed);
        let mut smooth = physics.smooth(self.angle, at_speed) + history.bristle_nm(physics);
        if let Some(law) = &physics.unknown {
            smooth += law.torque_nm(self.angle, at_speed, drive);
        }
        let (mut inertia, mut torque) = (self.inertia, drive + smooth - holding);
        let moving = physics.base.map(|base| {
            let links = physics.on_base(self.mount, self.angle, at_speed);
            let force = at_base.force(base, &links, physics.gravity_turn(self.mount));
            inertia -= base.yields(&links, 0, 0);
            torque -= base.pulls(&links, 0, force);
            (base, links, force)
        });
        let pushed = self.speed + h / inertia * torque;
        let direction = if pushed < 0.0 { -1.0 } else { 1.0 };
        let friction = physics.friction([self.angle, at_speed], direction, drive, holding);
        let speed = direction * (pushed.abs() - h / inertia * friction).max(0.0);
        let base = moving.map_or(self.base, |(base, links, force)| {
            let gained = [speed - self.speed];
            self.base.kicked(base, &links, (force, h), &gained)
        });
        (speed, base)
    }

    /// The encoder's value before noise and rounding, rad.
    pub fn sensed(&self) -> f64 {
        self.encoder.sensed()
    }

    /// What a log holds of its gyro, rad/s, if it has one.
    pub fn rate(&self, rng: &mut ChaCha8Rng) -> Option<f64> {
        Some(self.gyro.read(self.physics.gyro?, rng))
    }

    /// The same that a log whose times are off holds in a row of so many seconds since the
    /// beginning.
    fn logged(&self, row_s: f64) -> f64 {
        self.encoder.logged(self.physics, row_s)
    }

    /// Kinetic and potential energy in gravity, J, of an arm without tilt; tests only look at its
    /// change.
    #[cfg(test)]
    pub fn energy_j(&self) -> f64 {
        let height = |angle: f64| {
            self.physics
                .holding(self.mount, angle + std::f64::consts::FRAC_PI_2)
        };
        0.5 * self.inertia * self.speed.powi(2) - height(self.angle)
    }
}

/// Commands as they were logged: each holds from its time to the next.
#[derive(Debug, Clone, Default)]
pub struct ArmCommands {
    /// When each is given, s.
    pub time_s: Vec<f64>,
    /// Duty, -1 to 1.
    pub duty: Vec<f64>,
    /// Whether the motor is energised.
    pub torque_on: Vec<bool>,
    /// Supply, V.
    pub supply_v: Vec<f64>,
}

impl ArmCommands {
    /// Duty that arrives at `time_s` by a wire that delays by `delay_s`; 0 before the first
    /// command.
    fn arriving(&self, time_s: f64, delay_s: f64, last: usize) -> f64 {
        let sent_s = time_s - delay_s;
        // Sought from the end: a delay spans few commands.
        let index = self.time_s[..=last].iter().rposition(|&t| t <= sent_s);
        index.map_or(0.0, |index| self.duty[index])
    }

    /// Carries `arm` on from the last command by `span_s`.
    pub(super) fn carry(&self, arm: &mut Arm, last: usize, span_s: f64) {
        let (from_s, delay_s) = (self.time_s[last], arm.physics.delay_s);
        let (supply_v, torque_on) = (self.supply_v[last], self.torque_on[last]);
        let sent = |since_s: f64| {
            if delay_s == 0.0 {
                self.duty[last]
            } else {
                self.arriving(from_s + since_s, delay_s, last)
            }
        };
        arm.advance(span_s, |since_s| DriveCommand {
            duty: sent(since_s),
            supply_v,
            torque_on,
        });
    }

    /// What a log whose column is off in time holds of every command, before noise and rounding,
    /// rad, after these commands have driven an arm to the last; none where the column is on time.
    pub(super) fn logged(&self, arm: &mut Arm) -> Option<Vec<f64>> {
        let early_s = -arm.physics.logged_late_s;
        let last = self.time_s.len().checked_sub(1)?;
        if early_s == 0.0 {
            return None;
        }
        if early_s > 0.0 {
            self.carry(arm, last, early_s);
        }
        let rows_s = self.time_s.iter().map(|time_s| time_s - self.time_s[0]);
        Some(rows_s.map(|row_s| arm.logged(row_s)).collect())
    }

    /// Encoder values before noise and rounding, rad, at every command, when these commands drive
    /// the settled arm, and readings of a gyro.
    pub fn replay(&self, physics: &Physics, mount: Mount) -> (Vec<f64>, Vec<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(0);
        let mut arm = Arm::settled(physics, mount);
        let mut sensed = Vec::with_capacity(self.time_s.len());
        let mut rates = Vec::new();
        for k in 0..self.time_s.len() {
            sensed.push(arm.sensed());
            rates.extend(arm.rate(&mut rng));
            if let Some(next_s) = self.time_s.get(k + 1) {
                self.carry(&mut arm, k, next_s - self.time_s[k]);
            }
        }
        (self.logged(&mut arm).unwrap_or(sensed), rates)
    }
}
