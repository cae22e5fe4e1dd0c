//! Measured values at one moment.

/// One servo. What it did not say is none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoSample {
    /// Angle from the centre, rad, counter-clockwise positive.
    pub position_rad: Option<f64>,
    /// Speed, rad/s.
    pub speed_rad_s: Option<f64>,
    /// Load as the servo infers it, a share of full output, -1 to 1.
    pub load: Option<f64>,
    /// Goal it has, rad: what it was told in this tick, or the one before that still counts.
    pub goal_rad: Option<f64>,
    /// Supply, V.
    pub supply_v: Option<f64>,
    /// Temperature, degrees Celsius.
    pub temperature_celsius: Option<f64>,
    /// Error bits of its answer.
    pub error: Option<u8>,
    /// Current, A, where it measures one.
    pub current_a: Option<f64>,
}

impl ServoSample {
    /// Its values in the order of [`ServoSample::NAMES`].
    pub fn values(&self) -> [Option<f64>; 8] {
        [
            self.position_rad,
            self.speed_rad_s,
            self.load,
            self.goal_rad,
            self.supply_v,
            self.temperature_celsius,
            self.error.map(f64::from),
            self.current_a,
        ]
    }

    /// The inverse of [`ServoSample::values`].
    pub fn of(values: [Option<f64>; 8]) -> Self {
        let [
            position_rad,
            speed_rad_s,
            load,
            goal_rad,
            supply_v,
            temperature_celsius,
            error,
            current_a,
        ] = values;
        ServoSample {
            position_rad,
            speed_rad_s,
            load,
            goal_rad,
            supply_v,
            temperature_celsius,
            error: error.map(|bits| bits as u8),
            current_a,
        }
    }

    /// Column of each value, before and behind the servo's id: `q3_rad`.
    pub const NAMES: [(&str, &str); 8] = [
        ("q", "_rad"),
        ("dq", "_rad_s"),
        ("load", ""),
        ("goal", "_rad"),
        ("supply", "_v"),
        ("temperature", "_celsius"),
        ("error", ""),
        ("current", "_a"),
    ];
}

/// The gyro on the first link, as a CM-5 measures it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GyroSample {
    /// ADC code, 0..=1023.
    pub code: f64,
    /// Code at rest, as the plan on the CM-5 has it; none without a plan.
    pub zero: Option<f64>,
    /// Angular rate of the first link, rad/s; none where zero or scale are not known.
    pub rate_rad_s: Option<f64>,
}

impl GyroSample {
    /// Columns of a recording.
    pub const NAMES: [&str; 3] = ["gyro_code", "gyro_zero", "gyro_rad_s"];

    /// Its values in the order of [`GyroSample::NAMES`].
    pub fn values(&self) -> [Option<f64>; 3] {
        [Some(self.code), self.zero, self.rate_rad_s]
    }

    /// The inverse of [`GyroSample::values`]; none without a code.
    pub fn of([code, zero, rate_rad_s]: [Option<f64>; 3]) -> Option<Self> {
        Some(GyroSample {
            code: code?,
            zero,
            rate_rad_s,
        })
    }
}

/// All servos at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RobotSample {
    /// Since the recording began, s.
    pub time_s: f64,
    /// In the recording's order of ids.
    pub joints: Vec<ServoSample>,
    /// The gyro, where the source has one.
    pub gyro: Option<GyroSample>,
    /// Whether torque is on, where the source knows.
    pub torque_on: Option<bool>,
    /// Whether there is a servo that measures current; a recording then has a column of each.
    pub has_current: bool,
}

impl RobotSample {
    /// Current of each servo, A; empty where none measures it.
    #[cfg(feature = "ros")]
    pub(super) fn currents(&self) -> Vec<Option<f64>> {
        let joints = self.joints.iter().filter(|_| self.has_current);
        joints.map(|joint| joint.current_a).collect()
    }
}
