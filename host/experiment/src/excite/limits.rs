//! Within which limits servos are moved, and why a motion cannot be held in them.

use crate::error::Error;

/// Half of the angle that an AX-12 turns through, rad: 150 degrees either way.
const SERVO_RAD: f64 = 2.617_993_877_991_494;
/// Unloaded speed of an AX-12 at 12 V, rad/s: 59 turns a minute.
const SERVO_RAD_S: f64 = 6.18;

/// One joint: its servos, and how far and fast it may move.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLimits {
    /// Servos that turn it; those after the first face the other way.
    pub servos: Vec<u8>,
    /// Lowest angle, rad.
    pub low_rad: f64,
    /// Highest angle, rad.
    pub high_rad: f64,
    /// Fastest change of the goal, rad/s.
    pub speed_rad_s: f64,
}

/// Why a motion cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExciteError {
    /// No joint or no servo of one.
    #[error("no servo is named")]
    NoServo,
    /// A servo twice.
    #[error("servo {0} is named twice")]
    ServoTwice(u8),
    /// Angles that are no range, or beyond what a servo reaches.
    #[error("angles {low_rad} to {high_rad} rad of servo {servo}")]
    Angles {
        /// The joint's first servo.
        servo: u8,
        /// Lowest angle.
        low_rad: f64,
        /// Highest angle.
        high_rad: f64,
    },
    /// A speed that no servo reaches, or none.
    #[error("{0} rad/s")]
    Speed(f64),
    /// A rate of samples that is none, or of which a step does not fit.
    #[error("{0} samples per second")]
    Rate(f64),
    /// A band that is none, or that the samples cannot hold.
    #[error("frequencies {low_hz} to {high_hz} Hz at {hz} samples per second")]
    Band {
        /// Lowest frequency.
        low_hz: f64,
        /// Highest frequency.
        high_hz: f64,
        /// Samples per second.
        hz: f64,
    },
    /// Too little time for a kind of motion.
    #[error("{kind} within {given_s} s")]
    Short {
        /// The kind.
        kind: &'static str,
        /// Seconds given.
        given_s: f64,
        /// Seconds needed.
        needed_s: f64,
    },
    /// No kind of motion, or one twice.
    #[error("no kind of motion, or one twice")]
    Kinds,
}

impl From<ExciteError> for Error {
    fn from(error: ExciteError) -> Error {
        let remedy = match &error {
            ExciteError::NoServo => "name the servos of each joint: --joints 1+2/11+12".into(),
            ExciteError::ServoTwice(_) => "name each servo once".into(),
            ExciteError::Angles { .. } => {
                format!("give a lower and a higher angle within {SERVO_RAD:.2} rad of the centre")
            }
            ExciteError::Speed(_) => format!("give more than 0, up to {SERVO_RAD_S} rad/s"),
            ExciteError::Rate(_) => "give 10 to 1000 samples per second".into(),
            ExciteError::Band { .. } => {
                "give a lower and a higher frequency, ten samples to a period at least".into()
            }
            ExciteError::Short { needed_s, .. } => {
                let needed = (10.0 * needed_s).ceil() / 10.0;
                format!("give {needed} s at least for each kind, a higher speed or less range")
            }
            ExciteError::Kinds => "name each once: multisine,steps,triangles,holds,drop".into(),
        };
        Error::usage(error.to_string(), remedy)
    }
}

impl JointLimits {
    /// Middle of its range, rad.
    pub fn middle_rad(&self) -> f64 {
        0.5 * (self.low_rad + self.high_rad)
    }

    /// Half of its range, rad.
    pub fn half_rad(&self) -> f64 {
        0.5 * (self.high_rad - self.low_rad)
    }

    /// Whether a servo can be held within them.
    ///
    /// # Errors
    /// Which limit it cannot.
    pub fn check(&self) -> Result<(), ExciteError> {
        let (low_rad, high_rad) = (self.low_rad, self.high_rad);
        let servo = *self.servos.first().ok_or(ExciteError::NoServo)?;
        let is_range = low_rad < high_rad && low_rad >= -SERVO_RAD && high_rad <= SERVO_RAD;
        let speed = self.speed_rad_s;
        match is_range {
            false => Err(ExciteError::Angles {
                servo,
                low_rad,
                high_rad,
            }),
            true if !(speed > 0.0 && speed <= SERVO_RAD_S) => Err(ExciteError::Speed(speed)),
            true => Ok(()),
        }
    }
}
