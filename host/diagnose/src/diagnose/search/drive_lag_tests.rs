//! A lag of the drive among the effects that look like it.

use super::tests::{all_but, arm};
use crate::challenge::{Motions, bench};
use crate::diagnose::{DiagnoseOptions, Verdict, diagnose};

/// A filter between command and motor is no delay, no ramp and no filter of the reading.
#[test]
fn a_lag_of_the_drive_is_named() {
    let (model, training, held_out) = arm(2, &["drive_lag"]);
    let options = DiagnoseOptions {
        without: all_but(&[
            "drive_lag",
            "delay",
            "slew_limit",
            "sensor_lag",
            "time_offset",
        ]),
        ..DiagnoseOptions::default()
    };
    let diagnosis = diagnose(&model, training, held_out, &options, &|_| ());
    assert_eq!(diagnosis.verdict, Verdict::Named, "{:?}", diagnosis.summary);
    let [found] = &diagnosis.effects[..] else {
        panic!("{:?}", diagnosis.summary);
    };
    assert_eq!(found.kind, "drive_lag");
    let bench = bench(Motions::Arm, 2, &["drive_lag"]).unwrap();
    let (_, hidden_s) = bench.effects[0].parameters[0];
    let value = &found.parameters[0];
    assert!(
        (value.low..=value.high).contains(&hidden_s),
        "{value:?} {hidden_s}"
    );
}
