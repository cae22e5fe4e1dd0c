//! Descriptions are complete and agree with one another.

use super::*;

#[test]
fn ids_are_unique_and_snake_case() {
    let mut seen = HashSet::new();
    for info in infos() {
        assert!(seen.insert(info.id), "{} twice", info.id);
        let snake = |sign: char| sign.is_ascii_lowercase() || sign == '_';
        assert!(info.id.chars().all(snake), "{}", info.id);
    }
}

#[test]
fn sites_follow_the_chain_in_the_list() {
    let order = |info: &EffectInfo| info.site as usize;
    assert!(infos().is_sorted_by_key(order));
}

#[test]
fn keys_of_an_effect_are_unique() {
    for info in infos() {
        let keys: HashSet<_> = info
            .parameters
            .iter()
            .map(|parameter| parameter.key)
            .collect();
        assert_eq!(keys.len(), info.parameters.len(), "{}", info.id);
    }
}

#[test]
fn values_lie_within_bounds() {
    for (id, parameter) in parameters() {
        let key = parameter.key;
        assert!(!parameter.starts.is_empty(), "{id} {key}");
        assert!(parameter.typical.0 < parameter.typical.1, "{id} {key}");
        let mut values = vec![parameter.typical.0, parameter.typical.1];
        values.extend(parameter.starts);
        values.extend(parameter.off.filter(|off| off.is_finite()));
        for value in values {
            assert!(within(parameter.bounds, value), "{id} {key}: {value}");
        }
    }
}

#[test]
fn every_effect_can_be_switched_off() {
    for info in infos() {
        assert!(
            info.parameters
                .iter()
                .any(|parameter| parameter.off.is_some()),
            "{}",
            info.id
        );
    }
}

#[test]
fn a_fit_does_not_start_at_off() {
    for info in infos() {
        let main = &info.parameters[0];
        assert!(
            main.starts.iter().all(|start| Some(*start) != main.off),
            "{}",
            info.id
        );
    }
}

#[test]
fn confusions_are_known_and_mutual() {
    for info in infos() {
        assert_eq!(info.confusions().count(), info.confused_with.len());
        for confusion in info.confusions() {
            assert_ne!(confusion.with, info.id);
            let other = named(confusion.with).expect(confusion.with).info();
            let mut back = other.confusions();
            let back = back.any(|confusion| confusion.with == info.id);
            assert!(back, "{} names {}, not the reverse", info.id, other.id);
        }
    }
}

#[test]
fn every_text_is_filled_in() {
    for info in infos() {
        let texts = [
            info.title,
            info.law,
            info.looks_like,
            info.experiment,
            info.reference,
        ];
        assert!(texts.iter().all(|text| text.len() > 3), "{}", info.id);
        assert!(
            !texts.iter().any(|text| text.contains("  ")),
            "{}: two blanks",
            info.id
        );
    }
}
