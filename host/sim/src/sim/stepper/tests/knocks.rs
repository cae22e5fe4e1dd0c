//! Motors that meet their joints in the play of a gear, and part from them.

use super::*;
use crate::model::Motor;

/// Half the gap at 50 rad/s^2.
const GAP_RAD: f64 = 0.1;

#[test]
fn a_motor_crosses_its_gap_and_then_turns_its_joint_along() {
    let (motor, both) = (1e-3, 3e-3);
    let plant = weightless(&[("gear_backlash", &[motor, GAP_RAD])]);
    let (torque_nm, crossed_s) = (0.05, (GAP_RAD / 50.0_f64).sqrt());
    assert_eq!(pulled_rad(&plant, torque_nm, 0.04, 1e-3), 0.0);
    let (span_s, met_rad_s) = (0.5 - crossed_s, 50.0 * crossed_s * motor / both);
    let exact = met_rad_s * span_s + 0.5 * torque_nm / both * span_s * span_s;
    for step_s in [1e-2, 1e-3] {
        let off_rad = (pulled_rad(&plant, torque_nm, 0.5, step_s) - exact).abs();
        assert!(off_rad < 1e-9, "{step_s} s: {off_rad}");
    }
}

/// Angle of a joint that friction holds between the knocks of a motor of this inertia, kg m^2,
/// which goes to and fro.
fn knocked_rad(motor: f64, step_s: f64) -> f64 {
    let play: (&str, &[f64]) = ("gear_backlash", &[motor, GAP_RAD]);
    let plant = weightless(&[("coulomb", &[0.03]), play]);
    let mut stepper = Stepper::<FixedRows<1>>::new(&plant, &[0.0], &[0.0]);
    let steps = (0.1 / step_s).round() as usize;
    for torque_nm in [0.05, -0.08, 0.1, -0.06, 0.02, 0.09] {
        let pull = DriveInput {
            input: torque_nm * motor / 1e-3,
            ..DriveInput::ZERO
        };
        for _ in 0..steps {
            stepper.advance(&plant, &[pull], step_s);
        }
    }
    stepper.angle[0]
}

#[test]
fn knocks_come_when_they_do_whatever_the_step() {
    // A motor half as heavy as its joint, and one twenty times as heavy.
    for motor in [1e-3, 4e-2] {
        let exact = knocked_rad(motor, 5e-5);
        assert!((0.05..10.0).contains(&exact.abs()), "{exact}");
        for step_s in [1e-2, 5e-3, 2e-3] {
            let off_rad = (knocked_rad(motor, step_s) - exact).abs();
            assert!(off_rad < 1e-6, "{motor} kg m^2, {step_s} s: {off_rad}");
        }
    }
}

/// Three links, no friction, the gear of the last one with play.
fn three_links(effects: &[(&str, &[f64])]) -> Plant {
    let text = include_str!("../../../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    let instance = |&(id, values): &(&str, &[f64])| EffectInstance {
        effect: named(id).unwrap(),
        joint: Some(2),
        values: values.to_vec(),
    };
    model.gravity_m_s2 = 0.0;
    model.effects = effects.iter().map(instance).collect();
    Plant::without_log(&model)
}

/// Momentum of each joint, kg m^2/s, that of the last one's motor beside its own.
fn momenta(plant: &Plant, stepper: &Stepper<FixedRows<3>>, motor: f64) -> [f64; 3] {
    let energy_j = |speed: [f64; 3]| plant.rig.chain.energy_j(&stepper.angle, &speed).0;
    let of_joint = |joint: usize| {
        let moved = |by: f64| {
            let mut speed = stepper.speed;
            speed[joint] += by;
            energy_j(speed)
        };
        0.5 * (moved(1.0) - moved(-1.0))
    };
    let own = motor * stepper.forces.auxiliary.speed[2];
    [of_joint(0), of_joint(1), of_joint(2) + own]
}

#[test]
fn a_knock_leaves_every_momentum_as_it_was_and_friction_holds_nothing_through_it() {
    let motor = 2e-3;
    let plant = three_links(&[("gear_backlash", &[motor, GAP_RAD])]);
    let angle = [0.3, 0.4, -0.8];
    let mut stepper = Stepper::<FixedRows<3>>::new(&plant, &angle, &[0.0, -0.2, 0.1]);
    stepper.contact[0] = Contact::Held;
    let place = angle[2] + 0.5 * GAP_RAD;
    (
        stepper.forces.auxiliary.place[2],
        stepper.forces.auxiliary.speed[2],
    ) = (place, 7.0);
    let before = momenta(&plant, &stepper, motor);
    stepper.meet_or_part(&plant, 2);
    assert_eq!(stepper.forces.auxiliary.speed[2], stepper.speed[2]);
    assert!(stepper.speed[2] > 1.0);
    assert_eq!(
        stepper.contact[0],
        Contact::Sliding(stepper.speed[0].signum())
    );
    for (before, after) in before.into_iter().zip(momenta(&plant, &stepper, motor)) {
        assert!((before - after).abs() < 1e-15, "{before}, {after}");
    }
}

#[test]
fn rigid_flanks_are_what_ever_stiffer_ones_come_to() {
    let swung = |plant: &Plant| {
        let mut stepper = Stepper::<FixedRows<3>>::new(plant, &[0.3, 0.4, -0.8], &[0.0; 3]);
        for step in 0..400 {
            let pull = if step / 80 % 2 == 0 { 0.03 } else { -0.04 };
            let mut inputs = [DriveInput::ZERO; 3];
            inputs[2].input = pull;
            stepper.advance(plant, &inputs, 1e-3);
        }
        stepper.angle
    };
    let play: (&str, &[f64]) = ("gear_backlash", &[1e-3, 0.03]);
    let rigid = swung(&three_links(&[play]));
    let off_rad = |natural_rad_s: f64| {
        // Inertias of two effects add up; flanks that do not rebound have a damping ratio of 0.7.
        let spring = [1e-9, 1e-3 * natural_rad_s * natural_rad_s, 0.7];
        let soft = swung(&three_links(&[play, ("gear_compliance", &spring)]));
        let off = rigid
            .iter()
            .zip(soft)
            .map(|(rigid, soft)| (rigid - soft).abs());
        off.fold(0.0, f64::max)
    };
    let (soft, stiff) = (off_rad(100.0), off_rad(390.0));
    assert!(stiff < 0.02 && stiff < 0.5 * soft, "{stiff}, {soft}");
}

/// An arm in a torque-speed drive whose light motor runs up in milliseconds.
#[test]
fn a_light_motor_between_its_flanks_is_followed_in_steps_of_its_own() {
    let text = include_str!("../../../../../models/bench_arm.toml");
    let mut model = Model::parse(text, Path::new("bench_arm.toml")).unwrap();
    model.joints[0].drive = Drive::Duty(Motor {
        stall_torque_nm: 1.5,
        no_load_speed_rad_s: 6.0,
        ..model.joints[0].drive.motor().unwrap().clone()
    });
    model.effects = vec![EffectInstance {
        effect: named("gear_backlash").unwrap(),
        joint: Some(0),
        values: vec![5e-4, GAP_RAD],
    }];
    let plant = Plant::without_log(&model);
    // Braked within 2 ms: 5e-4 kg m^2 by 0.25 N m s.
    assert!((0.5e-3..2e-3).contains(&plant.joints[0].motor_step_s));
    let ends = [1e-2, 2e-4].map(|step_s| pulled_rad(&plant, 0.3, 0.3, step_s));
    assert!((ends[0] - ends[1]).abs() < 1e-3, "{ends:?}");
}

#[test]
fn a_state_that_is_lost_ends() {
    let plant = weightless(&[("gear_backlash", &[1e-3, GAP_RAD])]);
    let mut stepper = Stepper::<FixedRows<1>>::new(&plant, &[0.0], &[0.0]);
    let pull = DriveInput {
        input: 0.05,
        ..DriveInput::ZERO
    };
    stepper.advance(&plant, &[pull], 0.2);
    assert!(stepper.speed[0] > 0.0, "the motor has met its joint");
    stepper.speed[0] = f64::NAN;
    stepper.advance(&plant, &[pull], 0.2);
    assert!(stepper.angle[0].is_nan());
}
