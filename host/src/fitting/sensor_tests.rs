//! Sensors of several effects, run in windows.

use super::Horizon;
use super::log_tests::{ANGLE, even, pendulum, swing};
use crate::compare::compare;
use crate::effects::named;
use crate::log::Motion;
use crate::model::{EffectInstance, Model};

fn sensing(effects: [(&str, f64); 2]) -> Model {
    let mut model = pendulum(ANGLE, 0.006);
    model
        .effects
        .extend(effects.map(|(id, value)| EffectInstance {
            effect: named(id).unwrap(),
            joint: Some(0),
            values: vec![value],
        }));
    model
}

fn rms_rad(model: &Model, motion: &Motion, horizon: Horizon) -> f64 {
    let motions = std::slice::from_ref(motion);
    compare(model, "p.toml", motions, Some(horizon)).signals[0].rms
}

#[test]
fn a_filter_behind_a_slipping_shaft_begins_every_window_where_the_shaft_is() {
    let lag = ("sensor_lag", 0.05);
    // In its play a reading does not tell the speed.
    for (slips, most_rad) in [(("grip_slip", 6.0), 0.001), (("backlash", 0.1), 0.02)] {
        let model = sensing([slips, lag]);
        let motion = swing(&model, &[1.5], even(600, 100.0));
        let whole_rad = rms_rad(&model, &motion, Horizon::Whole);
        assert!(whole_rad < 0.002, "{slips:?}: {whole_rad} rad");
        // A model may name them in any order: the shaft comes first.
        let reversed = sensing([lag, slips]);
        assert_eq!(whole_rad, rms_rad(&reversed, &motion, Horizon::Whole));
        let windows_rad = rms_rad(&model, &motion, Horizon::Seconds(0.3));
        assert!(
            windows_rad < most_rad,
            "{slips:?}: {windows_rad} rad in windows"
        );
    }
}
