//! Words that benches name their columns by.

/// Unit suffixes, words joined by `_`, longest first; only those that are no unit's own name.
pub(super) const UNIT_WORDS: &[(&str, &str)] = &[
    ("rad_s", "rad/s"),
    ("rad_sec", "rad/s"),
    ("rads", "rad/s"),
    ("radps", "rad/s"),
    ("rad_per_s", "rad/s"),
    ("deg_s", "deg/s"),
    ("deg_sec", "deg/s"),
    ("deg_per_s", "deg/s"),
    ("dps", "deg/s"),
    ("rpm", "rpm"),
    ("mn_m", "mN m"),
    ("mnm", "mN m"),
    ("n_mm", "mN m"),
    ("nmm", "mN m"),
    ("n_m", "N m"),
    ("nm", "N m"),
    ("kgf_cm", "kgf cm"),
    ("kgfcm", "kgf cm"),
    ("kg_cm", "kgf cm"),
    ("kgcm", "kgf cm"),
    ("rad", "rad"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("deg", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("turn", "turn"),
    ("turns", "turn"),
    ("rev", "turn"),
    ("tick", "ticks"),
    ("ticks", "ticks"),
    ("step", "ticks"),
    ("steps", "ticks"),
    ("count", "ticks"),
    ("counts", "ticks"),
    ("sec", "s"),
    ("secs", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("nsec", "ns"),
    ("ms", "ms"),
    ("us", "us"),
    ("ns", "ns"),
    ("s", "s"),
    ("mv", "mV"),
    ("v", "V"),
    ("volt", "V"),
    ("volts", "V"),
    ("percent", "%"),
    ("pct", "%"),
    ("kg", "kg"),
    ("g", "g"),
];

/// Units of angles that are fractions of one that has a name, and how many make a turn.
pub(super) const PER_TURN: &[(&str, f64)] = &[
    ("cdeg", 36_000.0),
    ("centideg", 36_000.0),
    ("mdeg", 360_000.0),
    ("millideg", 360_000.0),
    ("mrad", 1000.0 * std::f64::consts::TAU),
];

pub(super) const TIME: &[&str] = &[
    "t",
    "time",
    "times",
    "timestamp",
    "stamp",
    "elapsed",
    "clock",
    "secs",
];
pub(super) const SEGMENT: &[&str] = &["segment", "seg", "trial", "episode", "run"];
pub(super) const SUPPLY: &[&str] = &[
    "supply", "voltage", "volts", "volt", "vin", "vbat", "battery", "vbus",
];
pub(super) const ON: &[&str] = &["on", "enable", "enabled"];
pub(super) const GOAL: &[&str] = &[
    "goal",
    "goals",
    "target",
    "desired",
    "des",
    "cmd",
    "command",
    "commanded",
    "commands",
    "ref",
    "reference",
    "setpoint",
    "sp",
];
pub(super) const TORQUE: &[&str] = &["tau", "torque", "torques", "trq"];
pub(super) const EFFORT: &[&str] = &["effort", "u", "input", "control", "action"];
pub(super) const DUTY: &[&str] = &["duty", "pwm"];
pub(super) const VELOCITY: &[&str] = &[
    "vel",
    "velocity",
    "velocities",
    "speed",
    "dq",
    "qd",
    "qdot",
    "dtheta",
    "thetadot",
    "dth",
    "dphi",
    "omega",
    "w",
    "rate",
    "gyro",
    "dpos",
    "dangle",
];
pub(super) const POSITION: &[&str] = &[
    "pos",
    "position",
    "positions",
    "q",
    "angle",
    "angles",
    "theta",
    "th",
    "phi",
    "ang",
    "encoder",
    "enc",
];
/// Directions in space, which say something of a speed alone.
pub(super) const AXES: &[&str] = &["x", "y", "z"];
/// Quantities that no model reads.
pub(super) const OTHER: &[&str] = &[
    "acc",
    "accel",
    "acceleration",
    "ddq",
    "qdd",
    "ddtheta",
    "jerk",
    "fric",
    "friction",
    "temp",
    "temperature",
    "error",
    "err",
    "load",
    "current",
    "index",
    "row",
    "code",
    "zero",
    "celsius",
    "power",
];
pub(super) const MEASURED: &[&str] = &[
    "meas", "measured", "actual", "act", "present", "fb", "feedback",
];
pub(super) const DERIVED: &[&str] = &[
    "filt",
    "filtered",
    "est",
    "estimated",
    "estimate",
    "sim",
    "simulated",
    "con",
    "ctrl",
    "raw",
    "smooth",
    "smoothed",
    "lp",
    "pred",
    "predicted",
];
/// Words that say nothing of which joint is meant.
pub(super) const PLAIN: &[&str] = &[
    "joint", "joints", "servo", "servos", "motor", "axis", "link", "state", "states", "dof", "j",
    "data", "dot", "in", "per",
];
