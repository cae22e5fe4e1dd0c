//! Effects in a simulation that has diverged, as trials of a fit do.

use super::*;

/// Values of an effect from which a fit starts.
fn starts(info: &EffectInfo) -> Vec<f64> {
    info.parameters.iter().map(|p| p.starts[0]).collect()
}

#[test]
fn no_effect_panics_and_what_is_no_number_is_read_as_none() {
    for lost in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for effect in EFFECTS.iter().chain(CONTROLS) {
            let values = starts(effect.info());
            effect.command(&values, lost);
            let drive = DriveState {
                speed_rad_s: lost,
                duty: lost,
                full_torque_nm: 1.0,
                supply_ratio: 1.0,
                memory: MemoryCell::EMPTY,
            };
            effect.drive(&values, lost, &drive);
            effect.torque(&values, &JointState::undriven(lost, lost));
            effect.friction(&values, &slide(lost, 1.0));
            let mut memory = None;
            for angle in [0.1, lost, 0.2] {
                let encoded = effect.encode(&values, angle);
                let reading = effect.sense(&values, &mut memory, Encoded::still(encoded), 0.01);
                if encoded.is_nan() {
                    assert!(reading.is_nan(), "{}: {reading}", effect.info().id);
                }
            }
        }
    }
}
