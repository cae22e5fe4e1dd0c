//! Simulated servos as a simulated controller meets them: what the host simulates, and the firmware's logic is run before on a PC.

/// A bus in simulated time: each byte has the moment its last stop bit ends, ns since the start.
pub trait TimedBus {
    /// A byte from the controller.
    fn hear(&mut self, now_ns: u64, byte: u8);

    /// The next byte from the servos, if it has ended by `now_ns`, and when it did.
    fn take(&mut self, now_ns: u64) -> Option<(u64, u8)>;

    /// When the next byte from the servos ends, if one is on its way.
    fn next_ns(&self) -> Option<u64>;

    /// Lets motors, and a robot that hangs on them, move until `now_ns`.
    fn advance(&mut self, now_ns: u64);

    /// How fast the robot's first link turns, rad/s; none without a robot.
    fn rate_rad_s(&mut self) -> Option<f64>;
}
