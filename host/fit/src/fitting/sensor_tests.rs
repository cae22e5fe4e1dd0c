//! Sensors of several effects, run in windows.

use super::Horizon;
use super::log_tests::{ANGLE, driven, even, pendulum, swing};
use crate::compare::compare;
use crate::effects::named;
use crate::model::{Drive, EffectInstance, Model, Motor};
use crate::motion::Motion;

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
    for (slips, most_rad) in [(("grip_slip", 6.0), 0.001), (("backlash", 0.1), 0.002)] {
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

/// The part of a swing from its first turn on.
fn from_turn(swung: &Motion) -> Motion {
    let angle = &swung.position_rad[0];
    let turn = (1..angle.len() - 1).find(|&k| angle[k] < angle[k - 1] && angle[k] <= angle[k + 1]);
    let turn = turn.unwrap();
    Motion {
        time_s: swung.time_s[turn..].to_vec(),
        position_rad: vec![angle[turn..].to_vec()],
        ..swung.clone()
    }
}

#[test]
fn a_log_that_begins_in_the_middle_of_a_motion_finds_what_is_hidden_there() {
    for (id, values) in [("backlash", vec![0.1]), ("pre_sliding", vec![0.03, 0.3])] {
        let mut model = pendulum(ANGLE, 0.0);
        model.effects.push(EffectInstance {
            effect: named(id).unwrap(),
            joint: Some(0),
            values,
        });
        let motion = from_turn(&swing(&model, &[1.2], even(600, 100.0)));
        let rms_rad = rms_rad(&model, &motion, Horizon::Whole);
        assert!(rms_rad < 0.002, "{id}: {rms_rad} rad");
    }
}

/// A servo that gets to its goals slowly, resting where its log begins with a goal elsewhere, or on
/// its way.
#[test]
fn a_log_finds_how_far_a_slow_servo_had_got_before_it_began() {
    let mut model = pendulum(ANGLE, 0.006);
    let motor = Motor {
        stall_torque_nm: 1.5,
        no_load_speed_rad_s: 6.0,
        nominal_supply_v: None,
    };
    model.joints[0].drive = Drive::Position {
        motor,
        gain_per_rad: 5.0,
    };
    model.effects.push(EffectInstance {
        effect: named("slew_limit").unwrap(),
        joint: Some(0),
        values: vec![1.2],
    });
    let time_s = even(600, 100.0);
    let goal = |t: &f64| match t {
        ..0.5 => 0.0,
        0.5..2.5 => 0.64,
        2.5..4.0 => -0.3,
        _ => 0.2,
    };
    let goals = vec![Some(time_s.iter().map(goal).collect())];
    let motion = driven(&model, &[0.0], time_s, goals);
    for first in [50, 70] {
        let part = motion.part(first..motion.len());
        let rms_rad = rms_rad(&model, &part, Horizon::Whole);
        assert!(rms_rad < 0.001, "from row {first}: {rms_rad} rad");
    }
}
