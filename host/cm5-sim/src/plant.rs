//! The plant behind the servos, which the caller simulates.

use std::fmt::Debug;

/// A chain of links whose driven joints are moved by servo motors: duty cycle in, angle and speed
/// out.
///
/// Joints count from the base, 0 the first. Angles are in the model's own convention, rad and
/// rad/s.
pub trait Plant: Debug + Send {
    /// Number of joints.
    fn joint_count(&self) -> usize;

    /// Step of its integration, s. Where it is shorter than that of the servos, they regulate and
    /// measure as often.
    fn step_s(&self) -> f64;

    /// Delay of a joint's drive, s.
    fn delay_s(&self, joint: usize) -> f64;

    /// Set a drive's duty cycle, -1 to 1, at this supply, V; `None` switches its torque off.
    fn set_duty(&mut self, joint: usize, duty: Option<f64>, supply_v: f64);

    /// Advance by `span_s` under constant duty cycles.
    fn advance(&mut self, span_s: f64);

    /// Angle of a joint, rad.
    fn angle_rad(&self, joint: usize) -> f64;

    /// Speed of a joint, rad/s.
    fn speed_rad_s(&self, joint: usize) -> f64;

    /// Angle and speed of the shaft in a joint, relative to the link before it, rad and rad/s.
    fn shaft(&self, joint: usize) -> (f64, f64);
}

/// Initial pose of a robot at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// All links straight down.
    #[default]
    Hanging,
    /// All links straight up.
    Upright,
    /// The same, and held until torque is on.
    Held,
}
