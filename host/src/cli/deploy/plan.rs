//! What the robot is like beside its model, and the plan that follows.

use super::{INPUTS, STATES};
use crate::cli::port::id_list;
use crate::cli::weight_arg::WeightArg;
use handstand::controllers::{Fitting, Servo, Timing, board_plan, regulator_plan};
use handstand::model::Angles;
use handstand::synth::{Design, FixedLaw, Weight, upright};
use handstand::{Error, Model, Result};
use handstand_shared::gains::GainTable;
use handstand_shared::message::Attitude;
use handstand_shared::plan::{Gyro, Plan};
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
    /// Largest change of a torque in a tick, N m
    #[arg(long, default_value_t = 1.0)]
    slew: f64,
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
    let joints: Result<_, _> = text.split('/').map(|ids| Ok(id_list(ids)?.0)).collect();
    joints.map(Joints)
}

/// As the bench's: differences of positions, smoothed over two ticks.
const VELOCITY: Velocity = Velocity {
    fraction: 4,
    share: 128,
};

/// SI value of one step of each state, as the firmware measures them.
pub fn state_steps() -> WeightArg {
    let (angle, position) = (Attitude::ANGLE_LSB_RAD, Position::LSB_RAD);
    let speed = position / PERIOD_S / f64::from(1 << VELOCITY.fraction);
    let rate = Attitude::RATE_LSB_RAD_S;
    WeightArg::Numbers(Weight::Diagonal(vec![
        angle, position, position, rate, speed, speed,
    ]))
}

impl Rig {
    /// Steps of the inputs that the plan can turn into commands, if those of this law are too coarse for it.
    pub fn finer(&self, law: &FixedLaw) -> Option<WeightArg> {
        // A plan holds commands per step in 16 bits behind the point.
        let most_nm =
            self.full_torque / (1023.0 - (self.dead_zone * 1023.0).round()) * 65_535.0 / 65_536.0;
        let is_coarse = law.input_step.iter().any(|step| *step > most_nm);
        let step = 2f64.powi(most_nm.log2().floor() as i32);
        is_coarse.then(|| WeightArg::Numbers(Weight::Diagonal(vec![step; law.input_step.len()])))
    }

    /// The plan of a law on an estimated state.
    ///
    /// # Errors
    /// A model the firmware has no law for, or values that fit no register.
    pub fn observing(&self, model: &Model) -> Result<Plan> {
        relative(model)?;
        let timing = match self.gyro_per_code {
            Some(_) => Timing::GYRO,
            None => Timing::HOST_ATTITUDE,
        };
        Ok(board_plan(model, &self.fitting()?, &timing)?.1)
    }

    /// The plan of this design: its gains on plain states.
    ///
    /// # Errors
    /// A design the firmware has no law for, or values that fit no register.
    pub fn regulating(&self, model: &Model, design: &Design, law: &FixedLaw) -> Result<Plan> {
        let ts_s = design.sampled.as_ref().map_or(0.0, |(plant, _)| plant.ts_s);
        if (ts_s - PERIOD_S).abs() > 1e-9 {
            return Err(Error::design(
                format!("the firmware ticks every {PERIOD_S} s, the gains are for {ts_s} s"),
                "leave --ts out",
            ));
        }
        let table = table(law)?;
        let steps = [law.input_step[0], law.input_step[1]];
        regulator_plan(model, &self.fitting()?, table, VELOCITY, steps)
    }

    fn fitting(&self) -> Result<Fitting> {
        let [shoulder, hip] = &self.joints.0[..] else {
            return Err(Error::usage(
                format!("--joints names {} joints", self.joints.0.len()),
                "name the servos of shoulder and hip: 1+2/11+12",
            ));
        };
        let full_nm = fitting("--full-torque", self.full_torque, 1e-3, 1e3)?;
        let range = fitting(
            "--fallen",
            self.fallen / Attitude::ANGLE_LSB_RAD,
            0.0,
            65_535.0,
        )?;
        Ok(Fitting {
            period_s: PERIOD_S,
            servos: [servo(shoulder)?, servo(hip)?],
            full_nm,
            most_nm: full_nm * fitting("--most", self.most, 1e-3, 1.0)?,
            dead_zone: fitting("--dead-zone", self.dead_zone, 0.0, 0.999)?,
            begins_at_nothing: true,
            slew_nm: fitting("--slew", self.slew, 1e-3, 1e3)?,
            gyro: self.gyro()?,
            range_rad: range * Attitude::ANGLE_LSB_RAD,
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

/// A joint's servos.
fn servo(ids: &[u8]) -> Result<Servo> {
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
    Ok(Servo {
        id,
        mirror,
        reversed: false,
        centre: Position::CENTRE.0,
    })
}

/// Tells the operating point from upright, as the firmware tells angles.
///
/// # Errors
/// Angles that are not relative: the firmware's are the servos' own.
pub fn tell_from_upright(design: &mut Design, model: &Model) -> Result<()> {
    relative(model)?;
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

fn relative(model: &Model) -> Result<()> {
    match model.angles {
        Angles::Relative => Ok(()),
        Angles::Absolute => Err(Error::design(
            format!(
                "`{}` has absolute angles, servos measure relative ones",
                model.name
            ),
            "give a model with `angles = \"relative\"`",
        )),
    }
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
            format!("{name} comes to {value}, which does not fit"),
            format!("it has to lie between {least} and {most}"),
        )),
    }
}
