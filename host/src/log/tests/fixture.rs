//! Columns, motions and models for the log's tests.

use crate::model::*;

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

pub use crate::motion::fixture::motion;

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
        effects: Vec::new(),
        laws: Vec::new(),
        free: Vec::new(),
        bounds: Vec::new(),
        log,
    }
}

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
