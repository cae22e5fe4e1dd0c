//! Arguments for servos, limits and sensors of the robot.

use crate::cli::input::within;
use crate::cli::port::id_list;
use handstand::deploy::{Board, PlanBasis, ServoPair, ToldDrives};
use handstand::synth::controllers::BoardTiming;
use handstand::{Error, Model, Result};
use handstand_shared::message::Attitude;
use handstand_shared::plan::Gyro;
use handstand_shared::raw::Position;

/// Departure of the first link at which a robot counts as fallen, rad.
const FALLEN_RAD: f64 = 0.5;

/// Servos, limits and sensors of the robot.
#[derive(Debug, Clone, clap::Args)]
pub struct BoardArgs {
    /// Servos of shoulder and hip; a second one in a joint faces the other way
    #[arg(long, default_value = "1+2/11+12", value_parser = joints)]
    joints: JointServos,
    /// Torque of a joint that is left at full output, N m [default: the model's]
    #[arg(long)]
    full_torque: Option<f64>,
    /// Share of full output that a servo loses of every command; jumped over [default: what dead
    /// zone and dry friction of the model take]
    #[arg(long)]
    dead_zone: Option<f64>,
    /// Delay of the drives, s [default: the model's]
    #[arg(long)]
    drive_delay: Option<f64>,
    /// Supply that the robot will have, V [default: that of the model's figures]
    #[arg(long)]
    supply: Option<f64>,
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
    /// Time constant with which a servo's torque follows its command, s; 0: at once. No effect of a
    /// model says it; that of the paper's servo is 0.034
    #[arg(long, default_value_t = 0.0)]
    servo_lag: f64,
    /// Departure of the first link at which it counts as fallen, rad
    #[arg(long, default_value_t = FALLEN_RAD)]
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
    /// What a plan for this model is made with.
    ///
    /// # Errors
    /// Values that fit no register, or a model that there is no plan for.
    pub fn basis(&self, model: &Model) -> Result<PlanBasis> {
        PlanBasis::of(model, &self.board()?, &self.timing(), &self.told()?)
    }

    /// When readings are taken.
    pub fn timing(&self) -> BoardTiming {
        match self.gyro_per_code {
            Some(step) => BoardTiming::gyro(step.abs()),
            None => BoardTiming::HOST_ATTITUDE,
        }
    }

    /// What is told of the drives beside the model.
    ///
    /// # Errors
    /// Values that are none.
    pub fn told(&self) -> Result<ToldDrives> {
        let within = |name: &str, value: Option<f64>, least: f64, most: f64| {
            let value = value.map(|value| within(name, value, least, most));
            value.transpose()
        };
        // Shorter lags are lost in the period, and the state before them hardly to be computed.
        let lag_s = Some(self.servo_lag).filter(|lag_s| *lag_s != 0.0);
        Ok(ToldDrives {
            full_nm: within("--full-torque", self.full_torque, 1e-3, 1e3)?,
            dead_zone: within("--dead-zone", self.dead_zone, 0.0, 0.499)?,
            delay_s: within("--drive-delay", self.drive_delay, 0.0, 0.5)?,
            lag_s: within("--servo-lag", lag_s, 2e-3, 0.2)?.unwrap_or(0.0),
            supply_v: within("--supply", self.supply, 1.0, 100.0)?,
            most_share: within("--most", Some(self.most), 1e-3, 1.0)?.unwrap_or(1.0),
        })
    }

    /// The servos, sensors and safety limits they describe.
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
        let farthest_rad = f64::from(u16::MAX) * Attitude::ANGLE_LSB_RAD;
        Ok(Board {
            servos: [servo(shoulder)?, servo(hip)?],
            slew_nm: within("--slew", self.slew, 1e-3, 1e3)?,
            gyro: self.gyro()?,
            range_rad: within("--fallen", self.fallen, 0.0, farthest_rad)?,
            joint_range_rad: within("--joint-range", self.joint_range, 0.01, 2.6)?,
            joint_speed_rad_s: within("--joint-speed", self.joint_speed, 0.3, 100.0)?,
            ..Board::BIOLOID
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
            Some(step) => {
                let most = f64::from(i16::MAX) * Attitude::RATE_LSB_RAD_S / 16.0;
                within("--gyro-per-code", step, -most, most)? / Attitude::RATE_LSB_RAD_S * 16.0
            }
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
