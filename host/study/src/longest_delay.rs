//! The longest delay a controller tolerates: in the linear loop, and in the simulated one.

use super::case::Case;
use super::judge::{Judging, STABILISED_SHARE, judge};
use super::quantity::Uncertain;
use crate::error::{Error, Result};
use crate::synth::controllers::{ControllerDesign, DesignModel, LinearLaw};
use serde::Serialize;

/// The delays around one that a controller tolerates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Longest {
    /// The shortest one up to which nothing fails on the way down, s; none if it fails where the
    /// search begins.
    pub shortest_s: Option<f64>,
    /// The longest one up to which nothing fails on the way up, s.
    pub delay_s: Option<f64>,
    /// Whether it may tolerate longer ones: the search ended there.
    pub open: bool,
}

impl Longest {
    /// Steps out from `from_s`, down to 0 and up to `until_s`.
    fn search(
        from_s: f64,
        step_s: f64,
        until_s: f64,
        mut tolerates: impl FnMut(f64) -> Result<bool>,
    ) -> Result<Longest> {
        let steps = |span_s: f64| (span_s / step_s + 1e-9).floor() as usize;
        let mut longest = Longest {
            shortest_s: None,
            delay_s: None,
            open: true,
        };
        for step in 0..=steps(until_s - from_s) {
            let delay_s = from_s + step as f64 * step_s;
            if !tolerates(delay_s)? {
                longest.open = false;
                break;
            }
            longest.delay_s = Some(delay_s);
        }
        if longest.delay_s.is_none() {
            return Ok(longest);
        }
        longest.shortest_s = Some(from_s);
        for step in 1..=steps(from_s) {
            let delay_s = from_s - step as f64 * step_s;
            if !tolerates(delay_s.max(0.0))? {
                break;
            }
            longest.shortest_s = Some(delay_s.max(0.0));
        }
        Ok(longest)
    }

    /// Whether a delay lies within.
    pub fn tolerates(&self, delay_s: f64) -> bool {
        let within = |(least, most)| (least..=most).contains(&delay_s);
        self.shortest_s.zip(self.delay_s).is_some_and(within)
    }
}

/// The delays, up to `until_s` in steps of `step_s`, under which the linear loop with the nominal
/// plant is stable: of a controller designed for the delay `known_s` (the search begins there), or
/// for each delay.
///
/// # Errors
/// A controller that cannot be made.
pub fn longest_linear(
    design: &dyn ControllerDesign,
    model: &DesignModel,
    known_s: Option<f64>,
    step_s: f64,
    until_s: f64,
) -> Result<Longest> {
    let build = |delay_s: f64| -> Result<LinearLaw> {
        let model = DesignModel {
            delay_s,
            ..model.clone()
        };
        Ok(LinearLaw::of(design.build(&model)?.as_ref(), &model))
    };
    let fixed = known_s.map(build).transpose()?;
    Longest::search(known_s.unwrap_or(0.0), step_s, until_s, |delay_s| {
        let radius = match &fixed {
            Some(law) => law.spectral_radius(model, delay_s)?,
            // For a delay at which nothing stabilises the plant a design may fail: then it does not
            // tolerate it.
            None => match build(delay_s) {
                Ok(law) => law.spectral_radius(model, delay_s)?,
                Err(_) => f64::INFINITY,
            },
        };
        Ok(radius < 1.0)
    })
}

/// The longest delay, as above, under which a controller designed for each delay stabilises 95 % of
/// the robots.
///
/// # Errors
/// Robots that cannot be simulated.
pub fn longest_stabilised(
    case: &Case,
    uncertain: &[Uncertain],
    judging: &Judging,
    step_s: f64,
    until_s: f64,
) -> Result<Longest> {
    Longest::search(0.0, step_s, until_s, |delay_s| {
        let mut case = case.clone();
        case.drives.delay_periods = delay_s / case.clock.period_s;
        case.control.drives.delay_periods = case.drives.delay_periods;
        match judge(&case, uncertain, judging, &|| ()) {
            Ok(figures) => Ok(figures.stabilised_share >= STABILISED_SHARE),
            Err(Error::Design { .. }) => Ok(false),
            Err(error) => Err(error),
        }
    })
}
