//! The estimator on data whose truth is known.

use super::generate::{paper_model, paper_noise_model, pseudo_random};
use super::*;
use rayon::prelude::*;

const SAMPLES: usize = 1500;
const NOISE: f64 = 0.05;

fn paper_record(seed: u64) -> Record {
    let input = pseudo_random(SAMPLES, 12, 1000 + seed);
    let output = paper_noise_model().respond(&input, NOISE, seed);
    Record::new("generated", input, output)
}

/// Each 95 % interval must hold its truth for at least 90 of 100 seeds, gain and poles included.
#[test]
fn box_jenkins_intervals_hold_the_papers_servo() {
    let structure = Structure::bj([1, 2, 1, 2, 1]);
    let truth = paper_noise_model();
    let values = truth.values(&structure);
    let true_gain = 0.06217 / (1.0 - 1.469 + 0.5544);
    let true_pole = polynomial::roots(&paper_model().f).unwrap()[0];
    let held: Vec<Vec<bool>> = (0..100u64)
        .into_par_iter()
        .map(|seed| {
            let estimate = estimate(&structure, &[paper_record(seed)]).unwrap();
            assert!(estimate.converged, "seed {seed}");
            let found = estimate.model.values(&structure);
            let halves = estimate.half_widths();
            let dynamics = dynamics(&estimate, 0.01);
            let mut held: Vec<bool> = (0..values.len())
                .map(|k| IntervalEstimate::around(found[k], halves[k]).holds(values[k]))
                .collect();
            held.push(dynamics.gain.holds(true_gain));
            held.push(dynamics.poles[0].re.holds(true_pole.re));
            held.push(dynamics.poles[0].im.holds(true_pole.im));
            held.push(dynamics.poles[0].radius.holds(true_pole.norm()));
            held
        })
        .collect();
    let mut names = structure.names();
    names.extend(["gain", "re", "im", "radius"].map(String::from));
    for (k, name) in names.iter().enumerate() {
        let count = held.iter().filter(|seed| seed[k]).count();
        println!("{name}: {count} of 100");
        assert!(count >= 90, "{name}: {count} of 100");
    }
}

#[test]
fn every_family_finds_a_model_of_its_own() {
    let input = pseudo_random(4000, 10, 1);
    let of = |structure: &str, values: &[f64]| {
        let structure = structures(structure).unwrap()[0];
        (structure, TransferModel::of(&structure, values))
    };
    let cases = [
        of("arx:2,1,1", &[-1.2, 0.5, 0.3]),
        of("armax:2,1,1,2", &[-1.2, 0.5, 0.3, 0.6]),
        of("oe:2,2,1", &[0.3, 0.1, -1.2, 0.5]),
        of("bj:1,1,1,1,3", &[0.4, 0.5, -0.8, -0.9]),
    ];
    for (structure, truth) in cases {
        let record = Record::new("r", input.clone(), truth.respond(&input, 0.1, 2));
        let estimate = estimate(&structure, &[record]).unwrap();
        let found = estimate.model.values(&structure);
        for (k, wanted) in truth.values(&structure).iter().enumerate() {
            // Three intervals' halves: six standard errors.
            let half = 3.0 * estimate.half_widths()[k];
            assert!(half < 0.1, "{structure} {k}: {half}");
            assert!(
                (found[k] - wanted).abs() < half,
                "{structure} {k}: {}",
                found[k]
            );
        }
    }
}

/// At the estimate the gradient of the squared error vanishes, in units of what noise makes of it.
#[test]
fn the_estimate_is_a_minimum() {
    let structure = Structure::bj([1, 2, 1, 2, 1]);
    let record = paper_record(3);
    let estimate = estimate(&structure, std::slice::from_ref(&record)).unwrap();
    let cost = |values: &[f64]| {
        let errors = TransferModel::of(&structure, values).errors(&record);
        errors.iter().map(|e| e * e).sum::<f64>()
    };
    let values = estimate.model.values(&structure);
    for (k, half) in estimate.half_widths().iter().enumerate() {
        let moved = |by: f64| {
            let mut values = values.clone();
            values[k] += by;
            cost(&values)
        };
        let (up, here, down) = (moved(1e-3 * half), cost(&values), moved(-1e-3 * half));
        assert!(up > here && down > here, "coefficient {k}");
    }
}

#[test]
fn validation_finds_the_orders() {
    let training: Vec<Record> = (0..2).map(paper_record).collect();
    let validation = [paper_record(77)];
    let grid = structures("bj:1-2,1-2,1,1-3,1").unwrap();
    let trials = try_all(&grid, &training, &validation, &|| ());
    let chosen = select(&trials, &validation).unwrap();
    assert_eq!(trials[chosen].structure, Structure::bj([1, 2, 1, 2, 1]));
    let fitted = trials[chosen].outcome.as_ref().unwrap();
    assert!(fitted.validation.tests.iter().all(|test| test.passed));
    assert!(fitted.validation.predicted_fit_percent > fitted.validation.simulated_fit_percent);
}

#[test]
fn what_the_data_do_not_tell_is_not_fitted() {
    let short = Record::new("r", vec![1.0; 20], vec![1.0; 20]);
    let found = estimate(&Structure::bj([1, 2, 1, 2, 1]), &[short]);
    assert_eq!(found.unwrap_err(), Unfitted::TooFew);
    let input = vec![0.0; 500];
    let silent = Record::new(
        "r",
        input.clone(),
        paper_noise_model().respond(&input, 1.0, 1),
    );
    let found = estimate(&Structure::oe([1, 2, 1]), &[silent]);
    assert!(
        matches!(found, Err(Unfitted::Undetermined | Unfitted::NoStart)),
        "{found:?}"
    );
}

#[test]
fn records_whose_squares_exceed_all_numbers_are_not_fitted() {
    let mut record = paper_record(1);
    record.output[700] = 1e200;
    for text in ["arx:2,1,1", "armax:2,1,1,1", "oe:1,1,1", "bj:1,2,1,2,1"] {
        let structure = structures(text).unwrap()[0];
        assert!(
            estimate(&structure, std::slice::from_ref(&record)).is_err(),
            "{text}"
        );
    }
}
