//! Joints that stop, stick and let go.

use super::*;
use crate::effects::named;
use crate::model::{EffectInstance, Model};
use crate::sim::rows::{Few, Many};
use std::path::Path;

/// Joints that stop, stick and let go, by the equations in closed form and by recursion.
fn farthest(effects: &[(&str, usize, &[f64])]) -> (f64, usize) {
    let text = include_str!("../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    let instance = |&(id, joint, values): &(&str, usize, &[f64])| EffectInstance {
        effect: named(id).unwrap(),
        joint: Some(joint),
        values: values.to_vec(),
    };
    model.effects = effects.iter().map(instance).collect();
    let plant = Plant::without_log(&model);
    let (angle, speed) = ([0.3, 0.2, -0.4], [0.0, 0.5, -0.2]);
    let mut closed = Stepper::<Few<3>>::new(&plant, &angle, &speed);
    let mut recursive = Stepper::<Many>::new(&plant, &angle, &speed);
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
    for effects in [coulomb.to_vec(), [&coulomb[..], &viscous].concat()] {
        let (off, held) = farthest(&effects);
        assert!(off < 1e-9, "{off}");
        assert!(held > 50, "{held}");
    }
}

/// Angle of the last of three links 0.6 s after the second was let go sideways, by steps of this
/// length, s: friction holds the first until the others pull it along, and again.
fn swung_rad(step_s: f64) -> f64 {
    let text = include_str!("../../../models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    model.effects = vec![EffectInstance {
        effect: named("coulomb").unwrap(),
        joint: Some(0),
        values: vec![0.3],
    }];
    let plant = Plant::without_log(&model);
    let mut stepper = Stepper::<Few<3>>::new(&plant, &[0.0, 0.5, 0.0], &[0.0; 3]);
    for _ in 0..(0.6 / step_s).round() as usize {
        stepper.advance(&plant, &[DriveInput::ZERO; 3], step_s);
    }
    stepper.angle[2]
}

#[test]
fn stopping_and_letting_go_are_of_second_order_in_the_step() {
    let exact = swung_rad(1e-4);
    for step_s in [8e-3, 4e-3, 2e-3] {
        let off_rad = (swung_rad(step_s) - exact).abs();
        assert!(off_rad < step_s * step_s, "{step_s} s: {off_rad}");
    }
}
