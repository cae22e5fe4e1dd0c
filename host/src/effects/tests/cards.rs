//! Cards are complete and agree with one another.

use super::*;

#[test]
fn ids_are_unique_and_snake_case() {
    let mut seen = HashSet::new();
    for card in cards() {
        assert!(seen.insert(card.id), "{} twice", card.id);
        let snake = |sign: char| sign.is_ascii_lowercase() || sign == '_';
        assert!(card.id.chars().all(snake), "{}", card.id);
    }
}

#[test]
fn sites_follow_the_chain_in_the_list() {
    let order = |card: &Card| card.site as usize;
    assert!(cards().is_sorted_by_key(order));
}

#[test]
fn keys_are_unique_and_say_their_unit() {
    for card in cards() {
        let keys: HashSet<_> = card
            .parameters
            .iter()
            .map(|parameter| parameter.key)
            .collect();
        assert_eq!(keys.len(), card.parameters.len(), "{}", card.id);
    }
    for (id, parameter) in parameters() {
        let ending = SUFFIXES
            .iter()
            .filter(|(_, suffix)| parameter.key.ends_with(suffix));
        let said = ending
            .max_by_key(|(_, suffix)| suffix.len())
            .map_or("1", |(unit, _)| *unit);
        assert_eq!(said, parameter.unit, "{id} {}", parameter.key);
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
    for card in cards() {
        assert!(
            card.parameters
                .iter()
                .any(|parameter| parameter.off.is_some()),
            "{}",
            card.id
        );
    }
}

#[test]
fn a_fit_does_not_start_at_off() {
    for card in cards() {
        let main = &card.parameters[0];
        assert!(
            main.starts.iter().all(|start| Some(*start) != main.off),
            "{}",
            card.id
        );
    }
}

#[test]
fn confusions_are_known_and_mutual() {
    for card in cards() {
        for confusion in card.confused_with {
            assert_ne!(confusion.with, card.id);
            let other = named(confusion.with).expect(confusion.with).card();
            let back = other
                .confused_with
                .iter()
                .any(|confusion| confusion.with == card.id);
            assert!(back, "{} names {}, not the reverse", card.id, other.id);
        }
    }
}

#[test]
fn every_text_is_filled_in() {
    for card in cards() {
        let texts = [
            card.title,
            card.law,
            card.looks_like,
            card.experiment,
            card.reference,
        ];
        assert!(texts.iter().all(|text| text.len() > 3), "{}", card.id);
        assert!(
            !texts.iter().any(|text| text.contains("  ")),
            "{}: two blanks",
            card.id
        );
    }
}
