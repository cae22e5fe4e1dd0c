//! The table of everything that can be varied.

use super::case::Case;
use super::quantity::{Levels, Quantity, Spread, SpreadOver};
use crate::effects;
use crate::model::{EffectInstance, effect_on};
use crate::output::number::given;
use crate::sim::closed_loop::Gyro;

/// Every quantity, each at one place in memory. A new one is an entry here.
pub static QUANTITIES: &[Quantity] = &[
    Quantity {
        id: "float-fixed",
        title: "arithmetic",
        meaning: "Word length of the law: floating point, or the 16 bits of the board.",
        levels: Some(Levels {
            unit: "bits",
            values: &[0.0, 16.0],
            bounds: (0.0, 32.0),
            set: |case, level| case.control.word_bits = level as u32,
            label: |level| match level {
                0.0 => "float".to_string(),
                bits => format!("fixed, {bits} bits"),
            },
        }),
        spread: None,
    },
    Quantity {
        id: "word-length",
        title: "word length",
        meaning: "Word length of the fixed-point law's states, gains and torques.",
        levels: Some(Levels {
            unit: "bits",
            values: &[8.0, 9.0, 10.0, 11.0, 12.0, 14.0, 16.0, 20.0, 24.0, 32.0],
            bounds: (8.0, 32.0),
            set: |case, level| case.control.word_bits = level.round() as u32,
            label: given,
        }),
        spread: None,
    },
    Quantity {
        id: "position-resolution",
        title: "position resolution",
        meaning: "Smallest step of an angle; the AX-12 has 300 / 1024 = 0.293 deg.",
        levels: Some(Levels {
            unit: "deg",
            values: &[0.0, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.293, 0.5, 1.0],
            bounds: (0.0, 45.0),
            set: |case, level| case.sensor.position_resolution_rad = level.to_radians(),
            label: given,
        }),
        spread: None,
    },
    Quantity {
        id: "gyro-resolution",
        title: "gyro resolution",
        meaning: "Smallest step of the arms' speed; the paper's gyro has 10 deg/s.",
        levels: Some(Levels {
            unit: "deg/s",
            values: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0],
            bounds: (0.0, 10000.0),
            set: |case, level| {
                case.sensor.gyro = Some(Gyro {
                    resolution_rad_s: level.to_radians(),
                    noise_rad_s: case.sensor.gyro.map_or(0.0, |gyro| gyro.noise_rad_s),
                });
            },
            label: given,
        }),
        spread: None,
    },
    Quantity {
        id: "dead-zone",
        title: "dead zone",
        meaning: "Share of the full torque up to which a command does nothing; the paper measured \
                  7 to 10 %.",
        levels: Some(Levels {
            unit: "%",
            values: &[0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0],
            bounds: (0.0, 99.0),
            set: |case, level| case.drives.dead_zone = level / 100.0,
            label: given,
        }),
        spread: Some(Spread {
            unit: "1",
            drawn: "change of the dead zone as a share of the full torque, which stays 0 or above",
            place: SpreadOver::Whole,
            apply: |case, _, change| {
                case.drives.dead_zone = (case.drives.dead_zone + change).max(0.0);
            },
        }),
    },
    Quantity {
        id: "delay",
        title: "delay",
        meaning: "Time from a sample to the torque it asks for; the design counts on what the \
                  study says.",
        levels: Some(Levels {
            unit: "ms",
            values: &[
                0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0,
            ],
            bounds: (0.0, 1000.0),
            set: |case, level| case.drives.delay_periods = 1e-3 * level / case.clock.period_s,
            label: given,
        }),
        spread: Some(Spread {
            unit: "periods",
            drawn: "change of the delay, which stays 0 or above",
            place: SpreadOver::Whole,
            apply: |case, _, change| {
                case.drives.delay_periods = (case.drives.delay_periods + change).max(0.0);
            },
        }),
    },
    Quantity {
        id: "jitter",
        title: "jitter",
        meaning: "Largest share of the period by which a sample comes early or late.",
        levels: Some(Levels {
            unit: "%",
            values: &[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0],
            bounds: (0.0, 45.0),
            set: |case, level| case.clock.jitter = level / 100.0,
            label: given,
        }),
        spread: None,
    },
    Quantity {
        id: "supply",
        title: "supply",
        meaning: "Supply of drives whose torque was measured at 9.8 V and follows the volts.",
        levels: Some(Levels {
            unit: "V",
            values: &[5.0, 6.0, 7.0, 8.0, 9.0, 9.8, 11.0, 12.0, 14.0],
            bounds: (0.1, 100.0),
            set: |case, level| case.drives.supply = level / 9.8,
            label: given,
        }),
        spread: Some(Spread {
            unit: "1",
            drawn: "relative error of the supply, which every torque follows",
            place: SpreadOver::Whole,
            apply: |case, _, error| case.drives.supply *= factor(error),
        }),
    },
    Quantity {
        id: "saturation",
        title: "largest torque",
        meaning: "Largest torque of a drive; the paper's saturate at 2 N m.",
        levels: Some(Levels {
            unit: "N m",
            values: &[f64::INFINITY, 10.0, 5.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.5, 0.3],
            bounds: (0.01, f64::INFINITY),
            set: |case, level| {
                case.drives.saturates = level.is_finite();
                if case.drives.saturates {
                    case.drives.full_torque_nm = level;
                }
            },
            label: |level| {
                if level.is_finite() {
                    given(level)
                } else {
                    "no limit".to_string()
                }
            },
        }),
        spread: None,
    },
    Quantity {
        id: "sampling-time",
        title: "sampling time",
        meaning: "Period of the controller, which is designed for each level.",
        levels: Some(Levels {
            unit: "ms",
            values: &[
                1.0, 2.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0,
            ],
            bounds: (0.1, 1000.0),
            set: |case, level| case.clock.period_s = 1e-3 * level,
            label: given,
        }),
        spread: None,
    },
    drawn(
        "mass",
        "1",
        "relative error of a link's mass",
        SpreadOver::Link,
        |case, link, error| case.robot.links[link].mass_kg *= factor(error),
    ),
    drawn(
        "inertia",
        "1",
        "relative error of a link's inertia about its centre of mass",
        SpreadOver::Link,
        |case, link, error| case.robot.links[link].inertia_kg_m2 *= factor(error),
    ),
    drawn(
        "density",
        "1",
        "relative error of a link's mass and inertia together",
        SpreadOver::Link,
        |case, link, error| {
            case.robot.links[link].mass_kg *= factor(error);
            case.robot.links[link].inertia_kg_m2 *= factor(error);
        },
    ),
    drawn(
        "com",
        "m",
        "error of a centre of mass along its link",
        SpreadOver::Link,
        |case, link, error| case.robot.links[link].com_m += error,
    ),
    drawn(
        "com-aside",
        "m",
        "distance of a centre of mass from its link's line",
        SpreadOver::Link,
        |case, link, aside| {
            let angle = (aside / case.robot.links[link].com_m).atan();
            effect(case, "com_angle", Some(link), angle);
        },
    ),
    drawn(
        "com_angle",
        "rad",
        "angle of a centre of mass off its link's line",
        SpreadOver::Link,
        |case, link, angle| effect(case, "com_angle", Some(link), angle),
    ),
    drawn(
        "length",
        "1",
        "relative error of a link's length",
        SpreadOver::Link,
        |case, link, error| case.robot.links[link].length_m *= factor(error),
    ),
    drawn(
        "base_tilt",
        "rad",
        "angle by which gravity is turned in the robot's plane",
        SpreadOver::Whole,
        |case, _, angle| effect(case, "base_tilt", None, angle),
    ),
    drawn(
        "disturbance",
        "N m",
        "constant torque from outside on a joint",
        SpreadOver::Link,
        |case, joint, torque| case.disturbance_nm[joint] += torque,
    ),
];

/// A quantity that no sweep varies.
const fn drawn(
    id: &'static str,
    unit: &'static str,
    meaning: &'static str,
    place: SpreadOver,
    apply: fn(&mut Case, usize, f64),
) -> Quantity {
    Quantity {
        id,
        title: id,
        meaning,
        levels: None,
        spread: Some(Spread {
            unit,
            drawn: meaning,
            place,
            apply,
        }),
    }
}

/// 1 + a relative error; nothing shrinks below a hundredth.
fn factor(error: f64) -> f64 {
    (1.0 + error).max(0.01)
}

fn effect(case: &mut Case, id: &str, joint: Option<usize>, value: f64) {
    let named = effects::named(id);
    if let Some(effect) = named.and_then(|effect| effect_on(effect, joint, &case.robot.joints)) {
        case.robot.effects.push(EffectInstance {
            effect,
            joint,
            values: vec![value],
        });
    }
}
