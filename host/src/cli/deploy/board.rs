//! Arguments for servos, limits and sensors of the robot.

use crate::cli::port::id_list;
use handstand::deploy::{Board, ServoPair};
use handstand::synth::controllers::BoardTiming;
use handstand::{Error, Result};
use handstand_shared::message::Attitude;
use handstand_shared::plan::Gyro;
use handstand_shared::raw::Position;

/// Servos, limits and sensors of the robot.
#[derive(Debug, Clone, clap::Args)]
pub struct BoardArgs {
    /// Servos of shoulder and hip; a second one in a joint faces the other way
    #[arg(long, default_value = "1+2/11+12", value_parser = joints)]
    joints: JointServos,
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
    /// Take the first link's rate from the gyro at the ADC, so many rad/s per code; else from the
    /// PC
    #[arg(long, value_name = "RAD_S", allow_negative_numbers = true)]
    gyro_per_code: Option<f64>,
    /// ADC code of the gyro at rest
    #[arg(long, default_value_t = 512)]
    gyro_zero: u16,
    /// Time constant with which a servo's torque follows its command, s; 0: at once
    #[arg(long, default_value_t = BoardTiming::SERVO_LAG_S)]
    servo_lag: f64,
    /// Departure of the first link at which it counts as fallen, rad
    #[arg(long, default_value_t = 0.5)]
    fallen: f64,
    /// Departure of a driven joint from straight at which torque goes off, rad
    #[arg(long, default_value_t = Board::BIOLOID.joint_range_rad)]
    joint_range: f64,
    /// Speed of a driven joint at which torque goes off, rad/s
    #[arg(long, default_value_t = Board::BIOLOID.joint_speed_rad_s)]
    joint_speed: f64,
}

/// Servos of each joint.
#[derive(Debug, Clone)]
struct JointServos(Vec<Vec<u8>>);

fn joints(text: &str) -> Result<JointServos, String> {
    let joints: Result<_, _> = text.split('/').map(|ids| Ok(id_list(ids)?.0)).collect();
    joints.map(JointServos)
}

impl BoardArgs {
    /// When readings are taken and torques act.
    ///
    /// # Errors
    /// A lag that is none.
    pub fn timing(&self) -> Result<BoardTiming> {
        let timing = match self.gyro_per_code {
            Some(step) => BoardTiming::gyro(step.abs()),
            None => BoardTiming::HOST_ATTITUDE,
        };
        // Shorter ones are lost in the period, and the state before them hardly to be computed.
        match self.servo_lag {
            0.0 => Ok(timing),
            lag => Ok(timing.with_lag(within("--servo-lag", lag, 2e-3, 0.2)?)),
        }
    }

    /// The board they describe.
    ///
    /// # Errors
    /// Values that fit no register.
    pub fn board(&self) -> Result<Board> {
        let [shoulder, hip] = &self.joints.0[..] else {
            return Err(Error::usage(
                format!("--joints names {} joints", self.joints.0.len()),
                "name the servos of shoulder and hip: 1+2/11+12",
            ));
        };
        let full_nm = within("--full-torque", self.full_torque, 1e-3, 1e3)?;
        let range = within(
            "--fallen",
            self.fallen / Attitude::ANGLE_LSB_RAD,
            0.0,
            65_535.0,
        )?;
        Ok(Board {
            period_s: Board::BIOLOID.period_s,
            servos: [servo(shoulder)?, servo(hip)?],
            full_nm,
            most_nm: full_nm * within("--most", self.most, 1e-3, 1.0)?,
            dead_zone: within("--dead-zone", self.dead_zone, 0.0, 0.499)?,
            starts_at_zero: true,
            slew_nm: within("--slew", self.slew, 1e-3, 1e3)?,
            gyro: self.gyro()?,
            range_rad: range * Attitude::ANGLE_LSB_RAD,
            joint_range_rad: within("--joint-range", self.joint_range, 0.01, 2.6)?,
            joint_speed_rad_s: within("--joint-speed", self.joint_speed, 0.3, 100.0)?,
        })
    }

    fn gyro(&self) -> Result<Gyro> {
        let scale = match self.gyro_per_code {
            // A scale that rounds to nothing would be no gyro.
            Some(step) if (step / Attitude::RATE_LSB_RAD_S * 16.0).abs() < 0.5 => {
                return Err(Error::usage(
                    format!("--gyro-per-code {step} rad/s is no rate"),
                    "give the gyro's rad/s per ADC code, as its data sheet and the ADC say",
                ));
            }
            Some(step) => within(
                "--gyro-per-code",
                step / Attitude::RATE_LSB_RAD_S * 16.0,
                -32_768.0,
                32_767.0,
            )?,
            None => 0.0,
        };
        if self.gyro_zero > 1023 {
            return Err(Error::usage(
                format!("--gyro-zero {} is no ADC code", self.gyro_zero),
                "give the gyro's code at rest, 0 to 1023",
            ));
        }
        Ok(Gyro {
            from_host: self.gyro_per_code.is_none(),
            zero: self.gyro_zero,
            scale: scale.round() as i16,
        })
    }
}

fn servo(ids: &[u8]) -> Result<ServoPair> {
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
    Ok(ServoPair {
        id,
        mirror,
        reversed: false,
        centre: Position::CENTRE.0,
    })
}

fn within(name: &str, value: f64, least: f64, most: f64) -> Result<f64> {
    match (least..=most).contains(&value) {
        true => Ok(value),
        false => Err(Error::usage(
            format!("{name} comes to {value}, which does not fit"),
            format!("it has to lie between {least} and {most}"),
        )),
    }
}
