//! Joints that stop, stick and let go.

use super::*;
use crate::effects::named;
use crate::model::{Drive, EffectInstance, Model};
use crate::sim::rows::{DynamicRows, FixedRows};
use std::path::Path;

/// Joints that stop, stick and let go, by the equations in closed form and by recursion.
fn farthest(effects: &[(&str, usize, &[f64])]) -> (f64, usize) {
    let text = include_str!("../../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    let instance = |&(id, joint, values): &(&str, usize, &[f64])| EffectInstance {
        effect: named(id).unwrap(),
        joint: Some(joint),
        values: values.to_vec(),
    };
    model.effects = effects.iter().map(instance).collect();
    let plant = Plant::without_log(&model);
    let (angle, speed) = ([0.3, 0.2, -0.4], [0.0, 0.5, -0.2]);
    let mut closed = Stepper::<FixedRows<3>>::new(&plant, &angle, &speed);
    let mut recursive = Stepper::<DynamicRows>::new(&plant, &angle, &speed);
    let (mut off, mut held) = (0.0_f64, 0);
    for step in 0..600 {
        let pull = if step / 100 % 2 == 0 { 0.06 } else { -0.03 };
        let input = |share: f64| DriveInput {
            input: share * pull,
            ..DriveInput::ZERO
        };
        let inputs = [DriveInput::ZERO, input(1.0), input(-0.5)];
        closed.advance(&plant, &inputs, 1e-3);
        recursive.advance(&plant, &inputs, 1e-3);
        let count = |contact: &[Contact]| contact.iter().filter(|c| **c == Contact::Held).count();
        assert_eq!(
            count(&closed.contact),
            count(&recursive.contact),
            "step {step}"
        );
        held += count(&closed.contact);
        for joint in 0..3 {
            off = off.max((closed.angle[joint] - recursive.angle[joint]).abs());
        }
    }
    (off, held)
}

#[test]
fn closed_form_and_recursion_are_one_motion() {
    let coulomb: [(&str, usize, &[f64]); 2] = [("coulomb", 1, &[0.05]), ("coulomb", 2, &[0.02])];
    let viscous: [(&str, usize, &[f64]); 1] = [("viscous", 2, &[0.01])];
    let play: [(&str, usize, &[f64]); 1] = [("gear_backlash", 2, &[1e-3, 0.02])];
    for also in [&[][..], &viscous, &play] {
        let effects = [&coulomb[..], also].concat();
        let (off, held) = farthest(&effects);
        assert!(off < 1e-9, "{off}");
        assert!(held > 50, "{held}");
    }
}

/// Angle of the last of three links 0.6 s after the second was let go sideways, by steps of this
/// length, s: friction holds the first until the others pull it along, and again.
fn swung_rad(step_s: f64) -> f64 {
    let text = include_str!("../../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    model.effects = vec![EffectInstance {
        effect: named("coulomb").unwrap(),
        joint: Some(0),
        values: vec![0.3],
    }];
    let plant = Plant::without_log(&model);
    let mut stepper = Stepper::<FixedRows<3>>::new(&plant, &[0.0, 0.5, 0.0], &[0.0; 3]);
    for _ in 0..(0.6 / step_s).round() as usize {
        stepper.advance(&plant, &[DriveInput::ZERO; 3], step_s);
    }
    stepper.angle[2]
}

#[test]
fn stopping_and_letting_go_are_of_third_order_in_the_step() {
    let exact = swung_rad(1e-4);
    for step_s in [8e-3, 4e-3, 2e-3] {
        let off_rad = (swung_rad(step_s) - exact).abs();
        assert!(off_rad < 10.0 * step_s.powi(3), "{step_s} s: {off_rad}");
    }
}

/// An arm of 2e-3 kg m^2 without weight, turned by a torque.
fn weightless(effects: &[(&str, &[f64])]) -> Plant {
    let text = include_str!("../../../../models/bench_arm.toml");
    let mut model = Model::parse(text, Path::new("bench_arm.toml")).unwrap();
    model.gravity_m_s2 = 0.0;
    model.joints[0].drive = Drive::Torque;
    let link = &mut model.links[0];
    (link.com_m, link.mass_kg, link.inertia_kg_m2) = (0.1, 0.1, 1e-3);
    let instance = |&(id, values): &(&str, &[f64])| EffectInstance {
        effect: named(id).unwrap(),
        joint: Some(0),
        values: values.to_vec(),
    };
    model.effects = effects.iter().map(instance).collect();
    Plant::without_log(&model)
}

/// Angle after `span_s` under a constant torque from rest.
fn pulled_rad(plant: &Plant, torque_nm: f64, span_s: f64, step_s: f64) -> f64 {
    let mut stepper = Stepper::<FixedRows<1>>::new(plant, &[0.0], &[0.0]);
    let pull = DriveInput {
        input: torque_nm,
        ..DriveInput::ZERO
    };
    for _ in 0..(span_s / step_s).round() as usize {
        stepper.advance(plant, &[pull], step_s);
    }
    stepper.angle[0]
}

/// Three links on a base that gives way, of which the first was let go at this angle; the largest
/// angle of the last one after it, rad.
fn swung_on_base_rad(let_go_rad: f64, stiffness_n_m: f64) -> f64 {
    let text = include_str!("../../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    model.effects = vec![EffectInstance {
        effect: named("base_compliance").unwrap(),
        joint: None,
        values: vec![stiffness_n_m, 1.0, 0.1],
    }];
    let plant = Plant::without_log(&model);
    let mut stepper = Stepper::<FixedRows<3>>::new(&plant, &[let_go_rad, 0.0, 0.0], &[0.0; 3]);
    let mut most_rad = 0.0_f64;
    for _ in 0..500 {
        stepper.advance(&plant, &[DriveInput::ZERO; 3], 2e-3);
        most_rad = most_rad.max(stepper.angle[2].abs());
    }
    most_rad
}

#[test]
fn a_base_begins_sagged_and_gives_way_only_to_motion() {
    assert!(swung_on_base_rad(0.0, 500.0) < 1e-12);
    let rigid_rad = swung_on_base_rad(0.5, f64::INFINITY);
    let off = |stiffness_n_m| (swung_on_base_rad(0.5, stiffness_n_m) - rigid_rad).abs();
    assert!(off(500.0) > 0.01, "{}", off(500.0));
    assert!(off(1.6e5) < 1e-3, "{}", off(1.6e5));
}

#[test]
fn a_motor_behind_a_spring_swings_against_its_joint() {
    let (motor, joint, stiffness, torque_nm) = (1e-3, 2e-3, 0.9, 0.05);
    let plant = weightless(&[("gear_compliance", &[motor, stiffness, 0.0])]);
    let swing_rad_s = f64::sqrt(stiffness * (1.0 / motor + 1.0 / joint));
    for span_s in [0.02, 0.1, 0.5] {
        let wound =
            torque_nm / (motor * swing_rad_s.powi(2)) * (1.0 - (swing_rad_s * span_s).cos());
        let of_both = 0.5 * torque_nm * span_s * span_s / (motor + joint);
        let exact = of_both - motor / (motor + joint) * wound;
        let off = (pulled_rad(&plant, torque_nm, span_s, 1e-3) - exact).abs();
        assert!(off < 1e-7, "{span_s} s: {off}");
    }
}

#[test]
fn a_motor_that_winds_up_its_gear_breaks_its_joint_away() {
    // The torque alone would not: the motor overshoots to nearly twice of it.
    let friction: (&str, &[f64]) = ("coulomb", &[0.08]);
    let held = weightless(&[friction]);
    assert_eq!(pulled_rad(&held, 0.05, 0.3, 1e-3), 0.0);
    let plant = weightless(&[friction, ("gear_compliance", &[1e-3, 0.4, 0.05])]);
    let exact = pulled_rad(&plant, 0.05, 0.32, 1e-4);
    assert!(exact > 5e-3, "{exact}");
    for step_s in [8e-3, 4e-3, 2e-3] {
        let off_rad = (pulled_rad(&plant, 0.05, 0.32, step_s) - exact).abs();
        assert!(off_rad < step_s * step_s, "{step_s} s: {off_rad}");
    }
}

mod knocks;
