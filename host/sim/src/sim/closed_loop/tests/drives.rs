//! What drives make of commands.

use super::*;

/// A controller that asks for one torque after another: 1, 2, 3 N m ...
#[derive(Debug)]
struct Counting;

impl Controller for Counting {
    fn memory_len(&self) -> usize {
        1
    }
    fn control(&self, memory: &mut [f64], _measured: Measurement<'_>, command: &mut [f64]) {
        memory[0] += 1.0;
        command.fill(memory[0]);
    }
}

/// Torque of a drive at every sample of 60 ms under [`Counting`].
fn torques(closed: &ClosedLoop, drive: usize) -> Vec<f64> {
    let mut seen = Vec::new();
    let mut closed = closed.clone();
    closed.limits.fall_rad = f64::INFINITY;
    let start = InitialState::at([0.0; 3]);
    closed.watch(&Counting, &start, 0.06, stream(1, 0), |sample| {
        seen.push(sample.torque_nm[drive]);
    });
    seen
}

#[test]
fn a_command_takes_effect_after_its_delay() {
    let late = |shoulder_s: f64, hip_s: f64| {
        loop_of(&with(&[
            ("delay", 1, &[shoulder_s]),
            ("delay", 2, &[hip_s]),
        ]))
    };
    let at_once = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(torques(&loop_of(&model()), 0), at_once);
    let two_periods = late(0.02, 0.015);
    assert_eq!(
        torques(&two_periods, 0),
        [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0]
    );
    // Each drive has its own delay.
    assert_eq!(
        torques(&two_periods, 1),
        [0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    );
    // The effort tells when within a period the torque changes.
    let mut quarter = late(0.0025, 0.0025);
    quarter.limits.fall_rad = f64::INFINITY;
    let effort = one(&quarter, &Counting, &InitialState::at([0.0; 3]), 0.02).rms_torque_nm;
    assert!((effort - ((0.75 + 0.25 + 0.75 * 4.0) / 2.0f64).sqrt()).abs() < 1e-9);
    let mut lossy = loop_of(&model());
    lossy.clock.loss = 1.0;
    assert_eq!(torques(&lossy, 0), [0.0; 7]);
}

#[test]
fn drives_are_as_far_from_ideal_as_their_effects_say() {
    let drives = Drives {
        supply: 0.5,
        delay_periods: 1.0,
        ..Drives::PAPER
    };
    let closed = loop_of(&drives.on(&model(), 0.01));
    assert!(closed.plant.is_dense());
    // A period late; 2 N m at most; half of that for the supply.
    assert_eq!(torques(&closed, 0), [0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]);
    // Below 10 % of 2 N m nothing happens, with a limit or without.
    for saturates in [false, true] {
        let drives = Drives {
            dead_zone: 0.1,
            saturates,
            ..Drives::IDEAL
        };
        let closed = loop_of(&drives.on(&model(), 0.01));
        let torque = |command: f64| {
            let mut body = body::Body::new(&closed.plant, &[0.0; 3], &[0.0; 3]);
            let mut inputs = [crate::sim::drive::DriveInput::ZERO; 3];
            closed.plant.obey(0, command, &mut inputs, &mut body);
            body.drive_nm[0]
        };
        assert_eq!([torque(0.19), torque(-0.2)], [0.0, 0.0]);
        assert!((torque(0.21) - 0.21).abs() < 1e-12);
        let large = if saturates { 2.0 } else { 3.0 };
        assert!((torque(3.0) - large).abs() < 1e-12, "{}", torque(3.0));
    }
}
