//! From a design to the plan that the firmware runs: its table in the firmware's own steps, and how inputs meet servos.

use super::INPUTS;
use super::STATES;
use crate::cli::given::Given;
use handstand::link::SimRobot;
use handstand::model::Angles;
use handstand::synth::{Design, FixedLaw, Weight, upright};
use handstand::{Error, Model, Result};
use handstand_shared::gains::GainTable;
use handstand_shared::message::Attitude;
use handstand_shared::plan::{Gyro, Joint, Plan};
use handstand_shared::raw::Position;
use handstand_shared::velocity::Velocity;

/// The firmware's tick, s.
const PERIOD_S: f64 = 0.01;

/// How the robot meets the gains.
#[derive(Debug, Clone, clap::Args)]
pub struct Rig {
    /// Servos of shoulder and hip; a second one in a joint faces the other way
    #[arg(long, default_value = "1+2/11+12", value_parser = joints)]
    joints: Joints,
    /// Torque of a joint at full output, N m
    #[arg(long, default_value_t = 2.0)]
    full_torque: f64,
    /// Share of full output below which a servo does not move; jumped over
    #[arg(long, default_value_t = 0.085)]
    dead_zone: f64,
    /// Largest share of full output
    #[arg(long, default_value_t = 1.0)]
    most: f64,
    /// Take the first link's rate from the gyro at the ADC, so many rad/s per code; else from the PC
    #[arg(long, value_name = "RAD_S", allow_negative_numbers = true)]
    gyro_per_code: Option<f64>,
    /// ADC code of the gyro at rest
    #[arg(long, default_value_t = 512)]
    gyro_zero: u16,
    /// Departure of the first link at which it counts as fallen, rad
    #[arg(long, default_value_t = 0.5)]
    fallen: f64,
}

/// Servos of each joint.
#[derive(Debug, Clone)]
struct Joints(Vec<Vec<u8>>);

fn joints(text: &str) -> Result<Joints, String> {
    SimRobot::joints(text).map(Joints)
}

/// As the bench's: differences of positions, smoothed over two ticks.
const VELOCITY: Velocity = Velocity {
    fraction: 4,
    share: 128,
};

/// SI value of one step of each state, as the firmware measures them.
pub fn state_steps() -> Given {
    let (angle, position) = (Attitude::ANGLE_LSB_RAD, Position::LSB_RAD);
    let speed = position / PERIOD_S / f64::from(1 << VELOCITY.fraction);
    let rate = Attitude::RATE_LSB_RAD_S;
    Given::Numbers(Weight::Diagonal(vec![
        angle, position, position, rate, speed, speed,
    ]))
}

impl Rig {
    /// Steps of the inputs that the plan can turn into commands, if those of this law are too coarse for it.
    pub fn finer(&self, law: &FixedLaw) -> Option<Given> {
        // A plan holds commands per step in 16 bits behind the point.
        let most_nm =
            self.full_torque / (1023.0 - (self.dead_zone * 1023.0).round()) * 65_535.0 / 65_536.0;
        let is_coarse = law.input_step.iter().any(|step| *step > most_nm);
        let step = 2f64.powi(most_nm.log2().floor() as i32);
        is_coarse.then(|| Given::Numbers(Weight::Diagonal(vec![step; law.input_step.len()])))
    }

    /// The plan of this design.
    ///
    /// # Errors
    /// A design the firmware has no law for, or values that fit no register.
    pub fn plan(&self, design: &Design, law: &FixedLaw) -> Result<Plan> {
        let ts_s = design.sampled.as_ref().map_or(0.0, |(plant, _)| plant.ts_s);
        if (ts_s - PERIOD_S).abs() > 1e-9 {
            return Err(Error::design(
                format!("the firmware ticks every {PERIOD_S} s, the gains are for {ts_s} s"),
                "leave --ts out",
            ));
        }
        let table = table(law)?;
        let [shoulder, hip] = &self.joints.0[..] else {
            return Err(Error::usage(
                format!("--joints names {} joints", self.joints.0.len()),
                "name the servos of shoulder and hip: 1+2/11+12",
            ));
        };
        let plan = Plan {
            table,
            joints: [
                self.joint(shoulder, law.input_step[0])?,
                self.joint(hip, law.input_step[1])?,
            ],
            velocity: VELOCITY,
            gyro: self.gyro()?,
            range: fitting(
                "--fallen",
                self.fallen / Attitude::ANGLE_LSB_RAD,
                0.0,
                65_535.0,
            )? as u16,
        };
        let mut bytes = Vec::new();
        plan.bytes(|byte| bytes.push(byte));
        match Plan::from_bytes(&bytes) {
            Some(read) if read == plan => Ok(plan),
            _ => Err(Error::design(
                "the firmware would refuse this plan: the table could overflow, or the dead zone is beyond the largest output",
                "weigh the inputs more (a larger --r), or give other --dead-zone and --most",
            )),
        }
    }

    fn joint(&self, ids: &[u8], input_step_nm: f64) -> Result<Joint> {
        let (id, mirror) = match ids {
            [id] => (*id, 255),
            [id, mirror] => (*id, *mirror),
            _ => {
                return Err(Error::usage(
                    format!("{} servos in a joint", ids.len()),
                    "the firmware drives one or two: 1+2/11+12",
                ));
            }
        };
        let dead = fitting("--dead-zone", self.dead_zone * 1023.0, 0.0, 1023.0)?;
        let full = fitting("--full-torque", self.full_torque, 1e-3, 1e3)?;
        let gain = input_step_nm / full * (1023.0 - dead.round()) * 65_536.0;
        Ok(Joint {
            id,
            mirror,
            reversed: false,
            centre: Position::CENTRE.0,
            dead: dead.round() as u16,
            gain: fitting("a joint's command per step of torque", gain, 1.0, 65_535.0)?.round()
                as u16,
            most: fitting("--most", self.most * 1023.0, 1.0, 1023.0)?.round() as u16,
        })
    }

    fn gyro(&self) -> Result<Gyro> {
        let scale = match self.gyro_per_code {
            Some(step) => fitting(
                "--gyro-per-code",
                step / Attitude::RATE_LSB_RAD_S * 16.0,
                -32_768.0,
                32_767.0,
            )?,
            None => 0.0,
        };
        Ok(Gyro {
            from_host: self.gyro_per_code.is_none(),
            zero: self.gyro_zero,
            scale: scale.round() as i16,
        })
    }
}

/// Tells the operating point from upright, as the firmware tells angles.
///
/// # Errors
/// Angles that are not relative: the firmware's are the servos' own.
pub fn tell_from_upright(design: &mut Design, model: &Model) -> Result<()> {
    if model.angles == Angles::Absolute {
        return Err(Error::design(
            format!(
                "`{}` has absolute angles, servos measure relative ones",
                model.name
            ),
            "give a model with `angles = \"relative\"`",
        ));
    }
    let up = upright(model);
    design.x0.iter_mut().zip(&up).for_each(|(x0, up)| *x0 -= up);
    if let Some(fixed) = &mut design.fixed {
        let law = &mut fixed.law;
        for ((x0, up), step) in law.x0.iter_mut().zip(&up).zip(&law.state_step) {
            *x0 -= (up / step).round() as i64;
        }
    }
    Ok(())
}

fn table(law: &FixedLaw) -> Result<GainTable<INPUTS, STATES>> {
    GainTable::from_bytes(&law.bytes()).ok_or_else(|| {
        Error::design(
            format!(
                "the firmware's law has {INPUTS} inputs and {STATES} states; this one has {} and {}",
                law.k.nrows(),
                law.k.ncols()
            ),
            "give a model of three joints, two of them driven, without delay (--delay 0)",
        )
    })
}

fn fitting(name: &str, value: f64, least: f64, most: f64) -> Result<f64> {
    match (least..=most).contains(&value) {
        true => Ok(value),
        false => Err(Error::usage(
            format!("{name} comes to {value:.1}, which fits no register"),
            format!("it has to lie between {least} and {most}"),
        )),
    }
}
