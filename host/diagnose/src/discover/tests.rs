//! Terms are laws that a model file can hold.

use super::scales::Scales;
use super::vocabulary::vocabulary;
use super::*;

fn scales() -> Scales {
    Scales {
        low_rad: -1.0,
        high_rad: 2.0,
        angle_rad: 2.0,
        speed_rad_s: 5.0,
        drive_nm: 1.5,
        term_nm: 0.02,
        input: 1.0,
        time_s: 20.0,
        slides: false,
        supply_moves: true,
    }
}

#[test]
fn every_term_is_a_law_with_a_name_and_values_of_its_own() {
    let slides = Scales {
        slides: true,
        ..scales()
    };
    [scales(), slides].iter().for_each(are_laws);
}

fn are_laws(scales: &Scales) {
    let terms = vocabulary(scales);
    let effects = defined(&terms).unwrap();
    for (term, effect) in terms.iter().zip(&effects) {
        assert_eq!(effect.info().id, term.name);
        let sizes = effect
            .info()
            .parameters
            .iter()
            .filter(|p| p.off == Some(0.0));
        assert!(sizes.count() > 0, "{} never vanishes", term.name);
        let named = terms.iter().filter(|other| other.name == term.name);
        assert_eq!(named.count(), 1, "{}", term.name);
    }
}
