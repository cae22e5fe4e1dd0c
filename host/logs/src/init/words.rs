//! Words that benches name their columns by, parted by blanks.

/// Units, and the suffixes that stand for them, words joined by `_`; units' own names too.
pub(super) const UNIT_WORDS: &[(&str, &str)] = &[
    ("rad/s", "rad_s rad_sec rads radps rad_per_s"),
    ("deg/s", "deg_s deg_sec deg_per_s dps"),
    ("rpm", "rpm"),
    ("mN m", "mn_m mnm n_mm nmm"),
    ("N m", "n_m nm"),
    ("kgf cm", "kgf_cm kgfcm kg_cm kgcm"),
    ("rad", "rad radian radians"),
    ("deg", "deg degree degrees"),
    ("turn", "turn turns rev"),
    ("ticks", "tick ticks step steps count counts"),
    ("s", "sec secs seconds s"),
    ("ms", "msec ms"),
    ("us", "usec us"),
    ("ns", "nsec ns"),
    ("mV", "mv"),
    ("V", "v volt volts"),
    ("%", "percent pct"),
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

pub(super) const TIME: &str = "t time times timestamp stamp elapsed clock secs";
pub(super) const SEGMENT: &str = "segment seg trial episode run";
pub(super) const SUPPLY: &str = "supply voltage volts volt vin vbat battery vbus";
pub(super) const ON: &str = "on enable enabled";
pub(super) const GOAL: &str = "goal goals target desired des cmd command commanded commands ref \
    reference setpoint sp";
pub(super) const TORQUE: &str = "tau torque torques trq";
pub(super) const EFFORT: &str = "effort u input control action";
pub(super) const DUTY: &str = "duty pwm";
pub(super) const VELOCITY: &str = "vel velocity velocities speed dq qd qdot dtheta thetadot dth \
    dphi omega w rate gyro dpos dangle";
pub(super) const POSITION: &str = "pos position positions q angle angles theta th phi ang encoder \
    enc";
/// Directions in space, which say something of a speed alone.
pub(super) const AXES: &str = "x y z";
/// Quantities that no model reads.
pub(super) const OTHER: &str = "acc accel acceleration ddq qdd ddtheta jerk fric friction temp \
    temperature error err load current index row code zero celsius power";
pub(super) const MEASURED: &str = "meas measured actual act present fb feedback";
pub(super) const DERIVED: &str = "filt filtered est estimated estimate sim simulated con ctrl raw \
    smooth smoothed lp pred predicted";
/// Words that say nothing of which joint is meant.
pub(super) const PLAIN: &str = "joint joints servo servos motor axis link state states dof j data \
    dot in per";

/// Whether a word is one of a list's.
pub(super) fn is_one_of(list: &str, word: &str) -> bool {
    list.split(' ').any(|known| known == word)
}
