//! Figures 9 and 10: data made with eq. (2), and validation on other data.

use super::computed::servo_estimate;
use super::figure::{Holds, PaperFigure};
use super::servo::fitted;
use crate::plot::{Chart, Curve, Tone};
use crate::sysid::generate::PAPER_TS_S;
use crate::sysid::score;

/// Figures 9 and 10: data made with eq. (2), and validation on other data.
pub(super) fn identification() -> Vec<PaperFigure> {
    let validation = |drawn| PaperFigure {
        title: "Servo validation data",
        claim: "the Box-Jenkins model captures the servo's dynamics on validation data",
        ..fitted("10", drawn)
    };
    let (Some((training, found)), Some((fresh, _))) = (servo_estimate(1), servo_estimate(2)) else {
        return vec![validation(Err("no model was found".to_string()))];
    };
    let seconds = |values: &[f64]| -> Vec<(f64, f64)> {
        let shown = values.iter().take(600).enumerate();
        shown.map(|(k, v)| (k as f64 * PAPER_TS_S, *v)).collect()
    };
    let scored = score(&found.model, std::slice::from_ref(&fresh));
    let own = score(&found.model, std::slice::from_ref(&training));
    let simulated = found.model.simulated(&fresh.input);
    let passed = scored.tests.iter().all(|test| test.passed);
    let chart = |curves| Chart::new("first 6 s", "time, s", "speed, rad/s", curves);
    let data = PaperFigure {
        number: "9",
        title: "Servo identification data",
        claim: "the commanded and the estimated speed, for identification",
        charts: vec![chart(vec![
            Curve::line("commanded", Tone::Grey, seconds(&training.input)),
            Curve::line("estimated speed", Tone::Ink, seconds(&training.output)),
        ])],
        holds: Holds::Yes,
        sentence: format!(
            "{} samples at 100 Hz made with eq. (2), random steps of +-5 rad/s; the noise model is \
             our own choice, since the paper prints none.",
            training.count()
        ),
    };
    let curves = vec![
        Curve::line("estimated speed", Tone::Ink, seconds(&fresh.output)),
        Curve::line("simulated by the model", Tone::Orange, seconds(&simulated)),
    ];
    let sentence = format!(
        "Simulated from the input alone, the model fits the validation data to {:.1} % (training \
         {:.1} %), one step ahead to {:.1} %; its residual {} white and independent of the input.",
        scored.simulated_fit_percent,
        own.simulated_fit_percent,
        scored.predicted_fit_percent,
        if passed { "is" } else { "is not" }
    );
    let drawn = (chart(curves), Holds::at_least_in_part(passed), sentence);
    vec![data, validation(Ok(drawn))]
}
