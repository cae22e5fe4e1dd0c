//! Which values effects have where they are hidden.

use std::f64::consts::PI;

/// How a value is drawn.
pub(super) enum Draw {
    /// Always this.
    Fixed(f64),
    /// From a range.
    Within(f64, f64),
    /// From a range, with a random sign that all values of the effect share.
    Signed(f64, f64),
    /// 1 plus such a value.
    Factor(f64, f64),
    /// A whole number from a range.
    Whole(f64, f64),
}
use Draw::{Factor, Fixed, Signed, Whole, Within};

/// Keys of an effect's values, and how each is drawn.
pub(super) type Parameters = &'static [(&'static str, Draw)];

/// Every effect that can be hidden.
pub(super) const EFFECTS: [(&str, Parameters); 39] = [
    ("viscous", &[("coefficient_nm_s_rad", Within(0.01, 0.04))]),
    ("coulomb", &[("torque_nm", Within(0.02, 0.06))]),
    (
        "stribeck",
        &[
            ("excess_nm", Within(0.02, 0.06)),
            ("speed_rad_s", Within(0.1, 0.5)),
        ],
    ),
    ("load_friction", &[("factor", Within(0.06, 0.25))]),
    (
        "direction_asymmetry",
        &[("half_difference_nm", Signed(0.008, 0.02))],
    ),
    (
        "dead_zone",
        &[("width", Within(0.03, 0.08)), ("punch", Fixed(0.0))],
    ),
    ("backlash", &[("gap_rad", Within(0.03, 0.1))]),
    ("delay", &[("delay_s", Within(0.02, 0.08))]),
    ("supply_sensitivity", &[("sensitivity", Within(0.6, 1.2))]),
    ("supply_sag", &[("drop_share", Within(0.15, 0.4))]),
    ("torque_saturation", &[("limit_nm", Within(0.2, 0.4))]),
    ("speed_limit", &[("no_load_speed_rad_s", Within(6.0, 15.0))]),
    ("com_angle", &[("angle_rad", Signed(0.05, 0.15))]),
    ("mass", &[("added_kg", Signed(0.03, 0.08))]),
    ("armature", &[("inertia_kg_m2", Within(5e-4, 2e-3))]),
    (
        "cable_spring",
        &[
            ("stiffness_nm_rad", Within(0.03, 0.15)),
            ("rest_angle_rad", Within(-0.5, 0.5)),
        ],
    ),
    ("base_tilt", &[("angle_rad", Signed(0.05, 0.15))]),
    (
        "air_drag",
        &[("coefficient_nm_s2_rad2", Within(0.001, 0.004))],
    ),
    ("encoder_zero", &[("offset_rad", Signed(0.03, 0.1))]),
    ("encoder_scale", &[("factor", Factor(0.02, 0.06))]),
    ("sensor_lag", &[("time_constant_s", Within(0.02, 0.06))]),
    (
        "cogging",
        &[
            ("amplitude_nm", Within(0.01, 0.03)),
            ("periods_per_turn", Whole(6.0, 25.0)),
            ("phase_rad", Within(-PI, PI)),
        ],
    ),
    ("torque_scale", &[("factor", Factor(0.08, 0.25))]),
    (
        "drive_asymmetry",
        &[
            ("motor_factor", Within(0.1, 0.25)),
            ("outside_factor", Within(0.0, 0.05)),
        ],
    ),
    ("slew_limit", &[("rate_per_s", Within(0.6, 2.0))]),
    (
        "thermal_drift",
        &[
            ("rise", Within(10.0, 30.0)),
            ("time_constant_s", Within(4.0, 12.0)),
        ],
    ),
    (
        "fold_back",
        &[
            ("remaining_share", Within(0.3, 0.7)),
            ("level", Within(0.06, 0.12)),
            ("after_s", Within(0.15, 0.4)),
        ],
    ),
    (
        "pre_sliding",
        &[
            ("torque_nm", Within(0.02, 0.06)),
            ("stiffness_nm_rad", Within(0.3, 1.5)),
        ],
    ),
    (
        "gear_compliance",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("stiffness_nm_rad", Within(0.5, 2.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    (
        "gear_backlash",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("gap_rad", Within(0.03, 0.12)),
        ],
    ),
    ("torque_offset", &[("offset_nm", Signed(0.01, 0.04))]),
    (
        "position_friction",
        &[
            ("below_nm", Within(0.02, 0.06)),
            ("above_nm", Within(0.0, 0.02)),
            ("span_rad", Within(0.4, 1.0)),
        ],
    ),
    (
        "base_compliance",
        &[
            ("stiffness_n_m", Within(60.0, 200.0)),
            ("mass_kg", Within(0.2, 0.6)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    ("grip_slip", &[("acceleration_rad_s2", Within(40.0, 100.0))]),
    ("time_offset", &[("offset_s", Signed(0.01, 0.03))]),
    ("rate_bias", &[("bias_rad_s", Signed(0.01, 0.05))]),
    ("rate_scale", &[("factor", Factor(0.02, 0.06))]),
    ("rate_lag", &[("time_constant_s", Within(0.005, 0.03))]),
    ("drive_lag", &[("time_constant_s", Within(0.03, 0.12))]),
];

/// What challenges of a seed alone never hide: it came later, and they keep what they hide.
pub(super) const LATER: [&str; 1] = ["drive_lag"];

/// What is drawn otherwise for the robot, whose drives are stronger and whose poles are faster.
pub(super) const ROBOT_EFFECTS: [(&str, Parameters); 13] = [
    (
        "stribeck",
        &[
            ("excess_nm", Within(0.03, 0.08)),
            ("speed_rad_s", Within(0.1, 0.5)),
        ],
    ),
    (
        "dead_zone",
        &[("width", Within(0.02, 0.05)), ("punch", Fixed(0.0))],
    ),
    ("delay", &[("delay_s", Within(0.008, 0.03))]),
    (
        "gear_compliance",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("stiffness_nm_rad", Within(4.0, 12.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    (
        "gear_backlash",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("gap_rad", Within(0.02, 0.06)),
        ],
    ),
    ("supply_sag", &[("drop_share", Within(0.2, 0.5))]),
    ("torque_saturation", &[("limit_nm", Within(0.4, 0.8))]),
    ("mass", &[("added_kg", Signed(0.05, 0.15))]),
    ("armature", &[("inertia_kg_m2", Within(1e-3, 4e-3))]),
    (
        "cable_spring",
        &[
            ("stiffness_nm_rad", Within(0.1, 0.4)),
            ("rest_angle_rad", Within(-0.5, 0.5)),
        ],
    ),
    (
        "air_drag",
        &[("coefficient_nm_s2_rad2", Within(0.002, 0.008))],
    ),
    (
        "cogging",
        &[
            ("amplitude_nm", Within(0.03, 0.08)),
            ("periods_per_turn", Whole(6.0, 25.0)),
            ("phase_rad", Within(-PI, PI)),
        ],
    ),
    (
        "base_compliance",
        &[
            ("stiffness_n_m", Within(500.0, 2000.0)),
            ("mass_kg", Within(0.5, 2.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
];
