//! Position regulator and wheel mode of a servo: from registers to duty cycle.

use super::servo::Servo;
use super::shaft::Shaft;
use handstand_shared::control_table::*;
use handstand_shared::raw::{MovingSpeed, Position, Signed};

/// The regulator as the registers set it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regulator {
    mode: Regulation,
    /// Torque limit, of full output.
    pub limit: f64,
    /// Largest speed, rad/s.
    pub speed_limit_rad_s: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Regulation {
    Off,
    Wheel(f64),
    Joint {
        goal_rad: f64,
        margin_rad: f64,
        slope_rad: f64,
        punch: f64,
    },
}

impl Regulator {
    /// Duty cycle at this angle, -1 to 1, counter-clockwise positive.
    pub fn duty(&self, angle_rad: f64) -> f64 {
        let duty = match self.mode {
            Regulation::Off => 0.0,
            Regulation::Wheel(output) => output,
            Regulation::Joint {
                goal_rad,
                margin_rad,
                slope_rad,
                punch,
            } => {
                let error = goal_rad - angle_rad;
                let beyond = (error.abs() - margin_rad).max(0.0);
                let share = if beyond > 0.0 {
                    punch + beyond / slope_rad
                } else {
                    0.0
                };
                share.min(1.0).copysign(error)
            }
        };
        duty.clamp(-self.limit, self.limit)
    }

    /// The same for a moving shaft: no duty that accelerates it beyond its speed limit.
    pub fn duty_in_motion(&self, shaft: &Shaft) -> f64 {
        let duty = self.duty(shaft.angle_rad);
        let is_fast = shaft.speed_rad_s.abs() > self.speed_limit_rad_s;
        if is_fast && duty * shaft.speed_rad_s > 0.0 {
            0.0
        } else {
            duty
        }
    }

    /// Whether torque is on.
    pub fn is_on(&self) -> bool {
        self.mode != Regulation::Off
    }
}

impl Servo {
    /// The regulator now.
    pub fn regulator(&self) -> Regulator {
        let wheel = self.get(CW_LIMIT) == 0 && self.get(CCW_LIMIT) == 0;
        let mode = if !self.torque_is_on() {
            Regulation::Off
        } else if wheel {
            let command = Signed(self.get(MOVING_SPEED)).get();
            Regulation::Wheel(f64::from(command) * Signed::OUTPUT_LSB)
        } else {
            self.joint()
        };
        let speed = MovingSpeed(self.get(MOVING_SPEED));
        Regulator {
            mode,
            limit: f64::from(self.get(TORQUE_LIMIT)) / 1023.0,
            speed_limit_rad_s: if wheel {
                f64::INFINITY
            } else {
                speed.to_rad_s()
            },
        }
    }

    fn joint(&self) -> Regulation {
        let goal = Position(self.get(GOAL_POSITION));
        let ccw = goal.to_rad() > self.shaft.angle_rad;
        let (margin, slope) = if ccw {
            (CCW_MARGIN, CCW_SLOPE)
        } else {
            (CW_MARGIN, CW_SLOPE)
        };
        // The slope snaps to the next lower power of two: 2, 4, .. 128.
        let slope = 1 << self.get(slope).clamp(2, 128).ilog2();
        Regulation::Joint {
            goal_rad: goal.to_rad(),
            margin_rad: f64::from(self.get(margin)) * Position::LSB_RAD,
            slope_rad: f64::from(slope) * Position::LSB_RAD,
            punch: f64::from(self.get(PUNCH)) / 1023.0,
        }
    }
}
