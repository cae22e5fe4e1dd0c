//! Sensors of a rate that joints have beside those of their angles.

/// What a rate sensor that a joint has beside the one of its angle is fixed to, and so whose rate
/// it reads, whatever the log's angles are measured from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum RateSensor {
    /// The link: its rate against the world.
    #[default]
    Gyro,
    /// The joint: its rate against the link before.
    Tachometer,
}

impl RateSensor {
    /// All there are.
    pub const ALL: [RateSensor; 2] = [RateSensor::Gyro, RateSensor::Tachometer];

    /// Its key in model files.
    pub fn key(self) -> &'static str {
        match self {
            RateSensor::Gyro => "gyro",
            RateSensor::Tachometer => "tachometer",
        }
    }
}
