//! The shortest windows that say anything of a model: shorter ones hold little more than what their
//! own start state takes up, and whatever the model says fits them.

use super::horizon::Horizon;
use crate::error::Error;
use crate::model::{MeasuredSignal, Model};
use crate::motion::Motion;
use crate::output::number::given;
use crate::sim::Plant;

/// Readings of a window for each angle and speed of its start state, of which no more than a third
/// goes into that.
const READINGS: usize = 3;
/// What of the least is enough: the samples of a log are not quite even.
const ENOUGH: f64 = 0.99;

/// A horizon that cuts a motion into windows of too few samples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "--horizon {given_s} is too short for {motion}: read every {} s, a window takes {samples} \
     samples to tell more than the state it starts from",
    given(*spacing_s)
)]
pub struct HorizonTooShort {
    /// What was asked for, s.
    pub given_s: f64,
    /// The least that all these motions allow, s.
    pub least_s: f64,
    /// The motion that asks for so much.
    pub motion: String,
    /// From one of its samples to the next, s.
    pub spacing_s: f64,
    /// Samples that a window of it takes.
    pub samples: usize,
}

impl From<HorizonTooShort> for Error {
    fn from(error: HorizonTooShort) -> Self {
        let remedy = format!(
            "give --horizon {} or more, or `whole` (Python: horizon_s)",
            error.least_s
        );
        Error::usage(error.to_string(), remedy)
    }
}

impl Horizon {
    /// Refuses windows that say nothing of the model in one of the motions.
    ///
    /// # Errors
    /// A horizon that leaves a window too few samples for its unknowns.
    pub fn check<'a>(
        self,
        model: &Model,
        motions: impl IntoIterator<Item = &'a Motion>,
    ) -> Result<(), HorizonTooShort> {
        let Horizon::Seconds(given_s) = self else {
            return Ok(());
        };
        let needs = motions.into_iter().map(|motion| {
            let (samples, spacing_s) = (least_samples(model, motion), spacing_s(motion));
            // A motion that is no longer is one window anyway.
            let least_s = (samples as f64 * spacing_s).min(motion.duration_s());
            (ENOUGH * least_s, motion, samples, spacing_s)
        });
        // The first of equals.
        let most = needs.reduce(|most, other| if other.0 > most.0 { other } else { most });
        match most {
            Some((least_s, motion, samples, spacing_s)) if given_s < least_s => {
                Err(HorizonTooShort {
                    given_s,
                    least_s: rounded_up(least_s),
                    motion: motion.name.clone(),
                    spacing_s,
                    samples,
                })
            }
            _ => Ok(()),
        }
    }
}

/// Samples of a window whose readings tell more than its start state: an angle and a speed of each
/// joint, and what is hidden, which lies between bounds and takes up less.
fn least_samples(model: &Model, motion: &Motion) -> usize {
    let joints = model.log.joints.iter();
    let measured = joints.filter(|joint| joint.signal() != MeasuredSignal::Nothing);
    let signals = measured.count() + model.log.rate_joints().len();
    let plant = Plant::new(model, motion);
    let hidden = plant.hidden().iter();
    // What was before the log is unknown once, not to every window.
    let hidden = hidden.filter(|unknown| !unknown.quantity.is_of_motion());
    (READINGS * 2 * model.link_count() + hidden.count()).div_ceil(signals.max(1))
}

/// From one sample to the next, s; a pause in the log changes nothing of it.
fn spacing_s(motion: &Motion) -> f64 {
    let mut steps: Vec<f64> = motion.time_s.windows(2).map(|t| t[1] - t[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

/// Two digits that are no less.
fn rounded_up(seconds: f64) -> f64 {
    let digit = 10f64.powf(seconds.log10().floor() - 1.0);
    let up = (seconds / digit).ceil() * digit;
    format!("{up:.1e}").parse().unwrap_or(up)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::log_tests::{ANGLE, pendulum};
    use std::path::Path;

    /// `samples` at this rate, after a pause of a minute.
    fn motion(name: &str, hz: f64, samples: usize, joints: usize) -> Motion {
        let mut time_s: Vec<f64> = (0..samples).map(|k| k as f64 / hz).collect();
        time_s[1..].iter_mut().for_each(|time| *time += 60.0);
        Motion {
            name: name.into(),
            position_rad: vec![vec![0.0; samples]; joints],
            velocity_rad_s: vec![None; joints],
            input: vec![None; joints],
            time_s,
            ..Motion::default()
        }
    }

    fn least(model: &Model, motions: &[Motion]) -> HorizonTooShort {
        Horizon::Seconds(1e-4).check(model, motions).unwrap_err()
    }

    #[test]
    fn windows_below_the_least_are_refused_and_the_least_is_taken() {
        let model = pendulum(ANGLE, 0.01);
        for (rates, least_s, slowest) in [
            (&[100.0][..], 0.06, 0),
            (&[100.0, 25.0], 0.24, 1),
            (&[57.3, 1000.0], 0.11, 0),
        ] {
            let motions = (0..).zip(rates);
            let motions: Vec<Motion> = motions
                .map(|(k, hz)| motion(&format!("{k}.csv"), *hz, 500, 1))
                .collect();
            let refused = least(&model, &motions);
            assert_eq!(refused.motion, motions[slowest].name);
            assert_eq!((refused.least_s, refused.samples), (least_s, 6));
            let check = |seconds| Horizon::Seconds(seconds).check(&model, &motions);
            assert_eq!(check(least_s), Ok(()), "{rates:?}");
            assert!(check(0.9 * least_s).is_err(), "{rates:?}");
            assert_eq!(Horizon::Whole.check(&model, &motions), Ok(()));
        }
    }

    #[test]
    fn the_error_names_option_given_least_and_remedy() {
        let refused = least(&pendulum(ANGLE, 0.01), &[motion("drop.csv", 100.0, 500, 1)]);
        let error = Error::from(refused);
        assert_eq!(error.exit_code(), 2);
        let said = format!("{error}; {}", error.remedy().unwrap());
        for word in ["--horizon 0.0001", "drop.csv", "every 0.01 s", "6 samples"] {
            assert!(said.contains(word), "{said}");
        }
        assert!(said.contains("give --horizon 0.06 or more"), "{said}");
    }

    #[test]
    fn what_is_hidden_and_what_is_not_measured_takes_more() {
        let samples = |text: &str, joints| {
            let model = Model::parse(text, Path::new("p.toml")).unwrap();
            least(&model, &[motion("a.csv", 100.0, 500, joints)]).samples
        };
        let one = "[rig]\nname = \"p\"\nangle_zero = \"hanging\"\nstep_s = 0.005\n";
        let link = "[[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 0.008\n\
                    length_m = 0.2\n[[joint]]\ndrive = \"passive\"\n";
        let play = "[[effect]]\nkind = \"backlash\"\njoint = 1\ngap_rad = 0.01\n";
        let log =
            format!("[log]\ntime = {{ column = \"t\", unit = \"s\" }}\n[[log.joint]]\n{ANGLE}\n");
        assert_eq!(samples(&format!("{one}{link}{log}"), 1), 6);
        let hidden = samples(&format!("{one}{link}{play}{log}"), 1);
        assert!((7..=8).contains(&hidden), "{hidden}");
        let unseen = format!("{one}{link}{link}{log}[[log.joint]]\n");
        assert_eq!(samples(&unseen, 2), 12);
    }

    #[test]
    fn a_short_motion_is_one_window_anyway() {
        let mut short = motion("short.csv", 10.0, 4, 1);
        short.time_s = vec![0.0, 0.01, 0.02, 0.03];
        let model = pendulum(ANGLE, 0.01);
        assert_eq!(Horizon::Seconds(0.03).check(&model, [&short]), Ok(()));
    }
}
