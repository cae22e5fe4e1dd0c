//! 95 % intervals hold the truth about as often as they say, and are not wide for nothing.
//!
//! Benches whose true structure is known, with the noise, rounding and jitter of every challenge;
//! only the values are fitted.

use handstand::Model;
use handstand::challenge::{Hidden, generate};
use handstand::fitting::{FitOptions, FitProblem, Horizon, fit, intervals};
use handstand::log::{LogRequest, read};
use std::path::Path;

/// Seeds of the benches: none of them were looked at when the intervals were made.
const SEEDS: std::ops::Range<u64> = 400..424;

/// Error of the fitted angle, and how far its interval reaches, rad.
fn com_angle(seed: u64) -> (f64, f64) {
    let challenge = generate(seed, Hidden::Effect("com_angle"));
    let truth = Model::parse(&challenge.answer.true_model_toml, Path::new("true.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut motions = Vec::new();
    for (name, content) in &challenge.logs[..2] {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        motions.extend(read(&[LogRequest::whole(path)], &truth.log).unwrap());
    }
    let data = FitProblem::new(&truth, motions, Horizon::Whole);
    let mut start = truth.clone();
    for path in &truth.free {
        assert!(path.set(&mut start, 1.1 * path.get(&truth).unwrap()));
    }
    let found = fit(&start, &truth.free, &data, None, FitOptions::default());
    let (intervals, _) = intervals(&found, &data).unwrap();
    let angle = found.free.len() - 1;
    let hidden = challenge.answer.parameters[0].1;
    (
        found.values()[angle] - hidden,
        0.5 * (intervals[angle].high - intervals[angle].low),
    )
}

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let found: Vec<(f64, f64)> = SEEDS.map(com_angle).collect();
    let held = found.iter().filter(|(error, reach)| error.abs() <= *reach);
    // Of 24 intervals that hold with 95 %, fewer than 20 do once in 170 times.
    let held = held.count();
    assert!(held >= 20, "{held} of {}: {found:?}", found.len());
    // Intervals of 95 % reach about twice the typical error; five times would be of no use.
    let squares: f64 = found.iter().map(|(error, _)| error * error).sum();
    let typical = (squares / found.len() as f64).sqrt();
    let mut reaches: Vec<f64> = found.iter().map(|(_, reach)| *reach).collect();
    reaches.sort_by(f64::total_cmp);
    let median = reaches[reaches.len() / 2];
    assert!(
        median < 5.0 * typical,
        "reach {median}, typical error {typical}"
    );
}
