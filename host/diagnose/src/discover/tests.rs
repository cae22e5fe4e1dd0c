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

/// The picture of an arm with a cubic spring, drawn for a law of this exponent, and the spring's
/// size, N m/rad^3.
fn pictured(exponent: f64) -> (TermPicture, f64) {
    let (arm, law) = crate::challenge::unknown_law_arm(1, "cubic_spring").unwrap();
    let size = law
        .said()
        .rsplit(' ')
        .next()
        .unwrap()
        .parse::<f64>()
        .unwrap();
    let dir = tempfile::tempdir().unwrap();
    let logs = arm.logs.iter().filter(|log| !log.held_out).map(|log| {
        let path = dir.path().join(&log.name);
        std::fs::write(&path, &log.csv).unwrap();
        crate::log::LogRequest::whole(path)
    });
    let logs: Vec<_> = logs.collect();
    let text = arm
        .true_model_toml
        .replace("q^3", &format!("q * abs(q)^{}", exponent - 1.0));
    let model = Model::parse(&text, std::path::Path::new("arm.toml")).unwrap();
    let motions = crate::log::read(&logs, &model.log).unwrap();
    let term = DiscoveredTerm {
        kind: "cubic_spring".into(),
        joint: Some(1),
        site: "torque",
        expression: "-c * q^3".into(),
        with_values: format!("-{size} * q^3"),
        parameters: Vec::new(),
        definition: None,
    };
    let found = pictures(&[term], &model, &motions, Horizon::Seconds(1.0));
    (found.into_iter().next().unwrap(), size)
}

#[test]
fn points_lie_on_the_true_law_whatever_law_is_drawn() {
    let (right, size) = pictured(3.0);
    assert!(right.points.len() > 6, "{right:#?}");
    for [x, y, low, high] in &right.points {
        let off = y + size * x.powi(3);
        assert!(
            off.abs() < 2.0 * (high - low),
            "at {x}: {off}, {low} to {high}"
        );
    }
    // Beside a law of another shape they tell which one is right.
    let (wrong, _) = pictured(2.0);
    let mean = |of: &dyn Fn(f64, f64) -> f64| {
        let squares = wrong.points.iter().map(|[x, y, ..]| of(*x, *y).powi(2));
        squares.sum::<f64>() / wrong.points.len() as f64
    };
    let to_true = mean(&|x, y| y + size * x.powi(3));
    let to_drawn = mean(&|x, y| y + size * x * x.abs());
    assert!(to_true < 0.5 * to_drawn, "{to_true} {to_drawn}: {wrong:#?}");
}
