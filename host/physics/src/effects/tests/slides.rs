//! Effects at joints that slide: the laws are those of hinges, in metres and newtons.

use super::*;

#[test]
fn keys_on_a_slide_have_no_angular_unit() {
    for effect in EFFECTS {
        let Some(on_slide) = effect.on(Axis::Slide) else {
            continue;
        };
        if on_slide.info().scope == Scope::WholeRig {
            continue;
        }
        for (own, hinge) in on_slide
            .info()
            .parameters
            .iter()
            .zip(effect.info().parameters)
        {
            let of_link = on_slide.info().id == "com_angle";
            assert!(of_link || !own.unit.contains("rad"), "{}", own.key);
            assert_eq!(own.off, hinge.off, "{}", own.key);
            let within = |x: &f64| (own.bounds.0..=own.bounds.1).contains(x);
            assert!(own.starts.iter().all(within), "{}", own.key);
            assert_eq!(own.starts.len(), hinge.starts.len(), "{}", own.key);
        }
    }
}

#[test]
fn what_an_angle_alone_has_is_no_effect_of_a_slide() {
    let refused: Vec<&str> = EFFECTS
        .iter()
        .filter(|effect| effect.on(Axis::Slide).is_none())
        .map(|effect| effect.info().id)
        .collect();
    let known = ["bearing_friction", "cogging", "rate_scale", "rate_lag"];
    assert_eq!(refused, known);
}

#[test]
fn the_way_back_is_the_effect_itself() {
    for effect in EFFECTS {
        if let Some(on_slide) = effect.on(Axis::Slide) {
            let back = on_slide.on(Axis::Hinge).unwrap();
            assert!(std::ptr::eq(back.info(), effect.info()));
        }
    }
}
