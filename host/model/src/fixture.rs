//! Columns, motions and models for tests, here and in other crates.

use crate::model::*;
use crate::motion::{Motion, MotionSource};
use std::path::PathBuf;

/// A column of this name in this unit, as it stands.
pub fn column(name: &str, unit: &str) -> Column {
    Column {
        name: name.into(),
        unit: Unit::named(unit, Some(4096.0)).unwrap(),
        offset: 0.0,
        reversed: false,
        resolution: None,
        shift_s: 0.0,
    }
}

/// The first column of a quantity.
pub fn first(columns: &mut Option<ColumnMean>) -> &mut Column {
    &mut columns.as_mut().unwrap().columns_mut()[0]
}

/// `t_s, q, u` of one joint.
pub fn columns() -> LogColumns {
    LogColumns {
        time: column("t_s", "s"),
        segment: None,
        supply: None,
        torque_on: None,
        payload: None,
        payload_at_m: 0.0,
        payload_on: None,
        turned: None,
        joints: vec![JointColumns {
            position: Some(column("q", "rad").into()),
            velocity: None,
            input: Some(column("u", "rad").into()),
            ..JointColumns::default()
        }],
        arm: None,
        split_at_gap_s: None,
    }
}

/// A swing of one joint, sampled every 10 ms, its goal 20 ms ahead.
pub fn motion(name: &str, samples: usize) -> Motion {
    let time_s: Vec<f64> = (0..samples).map(|i| i as f64 * 0.01).collect();
    let swing = |t: &f64| 0.7 * (3.0 * t).sin();
    Motion {
        name: name.into(),
        source: MotionSource {
            path: PathBuf::from(name),
            sha256: String::new(),
            lines: (2, samples + 1),
        },
        position_rad: vec![time_s.iter().map(swing).collect()],
        velocity_rad_s: vec![None],
        rate_rad_s: vec![None],
        input: vec![Some(time_s.iter().map(|t| swing(&(t + 0.02))).collect())],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
        time_s,
    }
}

/// A model of one link with this drive.
pub fn model(drive: Drive, log: LogColumns) -> Model {
    let link = Link {
        length_m: 0.1,
        com_m: 0.1,
        mass_kg: 0.3,
        inertia_kg_m2: 1e-4,
    };
    Model {
        name: "test".into(),
        angle_zero: AngleZero::Hanging,
        angles: Angles::Relative,
        gravity_m_s2: 9.81,
        step_s: 0.001,
        guessed: false,
        links: vec![link; log.joints.len()],
        joints: vec![Joint::from(drive); log.joints.len()],
        robot: None,
        effects: Vec::new(),
        laws: Vec::new(),
        free: Vec::new(),
        bounds: Vec::new(),
        uncertain: Vec::new(),
        log,
    }
}

/// A position servo of 5/rad and 1 N m.
pub fn position_drive() -> Drive {
    Drive::Position {
        gain_per_rad: 5.0,
        motor: Motor {
            stall_torque_nm: 1.0,
            no_load_speed_rad_s: 6.0,
            nominal_supply_v: None,
        },
    }
}
