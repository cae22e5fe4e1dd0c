//! The robot behind servos as they are, balanced through the firmware's logic in process as
//! `handstand balance` does it.

use handstand::Model;
use handstand::deploy::balance::{AttitudeSource, Balancer};
use handstand::deploy::{self, Board, BoardLaw};
use handstand::link::virtual_cm5::{Cm5Port, SimLink, attitude_sensor, set_up, spec};
use handstand::synth::controllers::BoardTiming;
use handstand_shared::message::{ArmLimits, Attitude};
use handstand_shared::plan::{Gyro, Plan};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::path::{Path, PathBuf};

/// Servos and sensors of a simulated robot, and what its plan believes of them.
#[derive(Debug, Clone)]
pub struct Rig {
    /// The robot's model in `host/models`; its plan is made for the same.
    pub model: &'static str,
    /// Lag of the servos' torque, s, known to the plan.
    pub lag_s: f64,
    /// Dead zone that the plan jumps over, a share of full output.
    pub dead_zone: f64,
    /// Rate of a gyro's code, rad/s, where nothing else tells of the first link.
    pub gyro_step_rad_s: Option<f64>,
    /// How far the gyro's code at rest is from the plan's, codes.
    pub gyro_off: f64,
}

impl Rig {
    /// Servos as they are: lag, back-EMF, friction, backlash, dead zone and a supply that sags.
    pub const REAL: Rig = Rig {
        model: "robot_servos.toml",
        lag_s: BoardTiming::SERVO_LAG_S,
        dead_zone: 0.08,
        gyro_step_rad_s: None,
        gyro_off: 0.0,
    };

    /// Ideal servos: the torque is the command's, at once.
    pub const IDEAL: Rig = Rig {
        model: "handstand.toml",
        lag_s: 0.0,
        dead_zone: 0.0,
        gyro_step_rad_s: None,
        gyro_off: 0.0,
    };

    fn file(&self) -> PathBuf {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host/models");
        models.join(self.model)
    }

    /// The plan for this robot.
    ///
    /// # Panics
    /// The repository's own model cannot be read or designed for: a bug.
    pub fn plan(&self) -> Plan {
        let timing = match self.gyro_step_rad_s {
            Some(step) => BoardTiming::gyro(step),
            None => BoardTiming::HOST_ATTITUDE,
        };
        let gyro = self.gyro_step_rad_s.map(|step| Gyro {
            from_host: false,
            zero: 512,
            scale: (step / Attitude::RATE_LSB_RAD_S * 16.0).round() as i16,
        });
        let board = Board {
            dead_zone: [self.dead_zone; 2],
            gyro: gyro.unwrap_or(Board::BIOLOID.gyro),
            joint_range_rad: 1.5,
            joint_speed_rad_s: 20.0,
            ..Board::BIOLOID
        };
        let model = Model::load(&self.file()).expect("the repository's own model");
        let machine = deploy::observer_design(&model, &board, &timing.with_lag(self.lag_s));
        let machine = machine.expect("an observer can be designed");
        deploy::plan(&model, BoardLaw::Observer(&machine), &board).expect("a plan can be made")
    }

    /// How long the robot stands, s, at most `seconds`, let go at these angles from upright and
    /// straight, rad.
    ///
    /// # Panics
    /// The firmware refuses to balance: a bug.
    pub fn stands_s(&self, plan: &Plan, start_rad: [f64; 3], seconds: f64) -> f64 {
        let [first, second, third] = start_rad.map(f64::to_degrees);
        let step = self.gyro_step_rad_s.unwrap_or(0.01).to_degrees();
        let text = format!(
            "ids=1-18,delay=0,robot={},start=held,lean={first}/{second}/{third},lag={},gyro={}/{step}",
            self.file().display(),
            self.lag_s,
            512.0 + self.gyro_off,
        );
        let spec = spec(&text).expect("a sound text");
        let mut bus = set_up(&spec).expect("the repository's own model");
        let sensor = attitude_sensor(&mut bus, &spec).expect("the repository's own model");
        let source = match (self.gyro_step_rad_s, sensor) {
            (None, Some(sensor)) => AttitudeSource::Simulated(sensor),
            _ => AttitudeSource::Gyro,
        };
        let ids: Vec<u8> = (1..=18).collect();
        let link = SimLink(Cm5Port::new(bus));
        let mut balancer = Balancer::new(link, &ids, source).expect("it answers");
        balancer.deploy(plan, |_| {}).expect("it takes the plan");
        let changes = balancer.wheel_changes(plan).expect("servos answer");
        balancer.set_up(&changes).expect("servos answer");
        balancer.make_ready(plan).expect("it hears them");
        balancer.arm(ArmLimits::FULL).expect("it arms");
        while balancer.status.balanced_s < seconds {
            balancer.step().expect("it reports");
            if let Some(outcome) = balancer.end().expect("it answers") {
                return outcome.balanced_s;
            }
        }
        seconds
    }
}

/// Starts drawn from `seed`, each angle within `most_rad` of upright and straight.
pub fn random_starts(count: usize, most_rad: f64, seed: u64) -> Vec<[f64; 3]> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut start = || std::array::from_fn(|_| random.random_range(-most_rad..=most_rad));
    (0..count).map(|_| start()).collect()
}

/// The eight corners of a cube of starts, each angle this far off, rad.
pub fn corners(off_rad: f64) -> Vec<[f64; 3]> {
    let corner = |at: usize| {
        std::array::from_fn(|joint| {
            if at >> joint & 1 == 0 {
                off_rad
            } else {
                -off_rad
            }
        })
    };
    (0..8).map(corner).collect()
}
