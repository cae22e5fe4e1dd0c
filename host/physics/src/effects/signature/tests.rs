//! Signatures can be seen, and drawn for values that are possible.

use super::*;
use crate::effects::{EFFECTS, named};

#[test]
fn every_effect_has_one_that_can_be_seen() {
    for effect in EFFECTS {
        let signature = signature(*effect);
        let id = effect.info().id;
        assert_eq!(signature.with.len(), signature.without.len(), "{id}");
        let finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
        assert!(
            signature.with.iter().chain(&signature.without).all(finite),
            "{id}"
        );
        assert!(
            parted(&signature) >= VISIBLE_SHARE,
            "{id}: {}",
            parted(&signature)
        );
    }
}

#[test]
fn values_drawn_are_possible_ones() {
    for effect in EFFECTS {
        let values = signature(*effect).values;
        for (parameter, value) in effect.info().parameters.iter().zip(values) {
            let (low, high) = parameter.bounds;
            assert!(
                (low..=high).contains(&value),
                "{} {}",
                effect.info().id,
                parameter.key
            );
        }
    }
}

#[test]
fn axes_follow_the_law() {
    let x_label = |id| signature(named(id).unwrap()).x_label;
    assert_eq!(x_label("cogging"), "angle, rad");
    assert_eq!(x_label("viscous"), "speed, rad/s");
    assert_eq!(x_label("speed_limit"), "speed, rad/s");
    assert_eq!(x_label("supply_sag"), "duty, 1");
    assert_eq!(x_label("armature"), "acceleration, rad/s^2");
    assert_eq!(x_label("mass"), "angle from hanging, rad");
}
