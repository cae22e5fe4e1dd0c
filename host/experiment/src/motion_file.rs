//! A proposed motion as a file: which columns it has, and who plays it.

use crate::model::{LogColumns, Model};

/// The log's columns of time, inputs, supply and torque, without those of what is measured.
pub fn inputs_alone(model: &Model) -> LogColumns {
    let mut columns = model.log.clone();
    for joint in &mut columns.joints {
        (joint.position, joint.velocity) = (None, None);
    }
    columns.torque_on = Some(columns.torque_on.unwrap_or_else(|| "torque_on".to_string()));
    columns
}

/// Whether `handstand replay` plays the model's input columns: goals of servos, in rad.
pub fn is_replayable(model: &Model) -> bool {
    let names = model.driven_joints().into_iter().flat_map(|joint| {
        let input = model.log.joints[joint].input.as_ref();
        input.map_or(&[][..], |input| input.columns())
    });
    let is_goal = |name: &str| {
        let number = name
            .strip_prefix("goal")
            .and_then(|rest| rest.strip_suffix("_rad"));
        number.is_some_and(|number| number.parse::<u8>().is_ok())
    };
    let mut names = names.map(|column| column.name.as_str()).peekable();
    names.peek().is_some() && names.all(is_goal) && model.log.time.name == "time_s"
}
