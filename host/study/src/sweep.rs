//! One quantity varied, level by level.

use super::case::Case;
use super::judge::{Figures, Judging, judge};
use super::quantity::{Levels, Quantity};
use super::region::tilt_border_rad;
use crate::error::{Error, Result};
use serde::Serialize;

/// A level and its figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Level {
    /// Level, in the sweep's unit.
    pub level: f64,
    /// As people read it.
    pub label: String,
    /// Figures; none if there is no controller for this level.
    pub figures: Option<Figures>,
    /// Border of the region of attraction along a tilt of the whole robot, rad: see
    /// [`tilt_border_rad`].
    pub tilt_border_rad: Option<f64>,
    /// Why there is no controller.
    pub refused: Option<String>,
}

/// A whole sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sweep {
    /// The quantity's id.
    pub sweep: &'static str,
    /// Unit of its levels.
    pub unit: &'static str,
    /// Level by level.
    pub levels: Vec<Level>,
}

impl Sweep {
    /// Why no level has a controller, if none has: the first one's reason.
    pub fn refused(&self) -> Option<&str> {
        let first = self.levels.first()?.refused.as_deref()?;
        let all = self.levels.iter().all(|level| level.refused.is_some());
        all.then_some(first)
    }
}

/// Judges `case` at every level; `done` is called after each.
///
/// # Errors
/// Levels out of bounds; robots that cannot be simulated. A level without a controller is no error
/// but a finding.
pub fn sweep(
    (quantity, levels): (&'static Quantity, &'static Levels),
    values: &[f64],
    case: &Case,
    judging: &Judging,
    mut done: impl FnMut(),
) -> Result<Sweep> {
    let (low, high) = levels.bounds;
    if let Some(level) = values.iter().find(|level| !(low..=high).contains(*level)) {
        return Err(Error::usage(
            format!("{}: there is no level {level}", quantity.id),
            format!("give levels from {low} to {high} {}", levels.unit).trim_end(),
        ));
    }
    let judged = values.iter().map(|&level| {
        let mut case = case.clone();
        (levels.set)(&mut case, level);
        let (figures, refused) = match at_level(&case, judging) {
            Ok(figures) => (Some(figures), None),
            Err(Error::Design { problem, .. }) => (None, Some(problem.what)),
            Err(error) => return Err(error),
        };
        done();
        Ok(Level {
            level,
            label: (levels.label)(level),
            figures: figures.map(|(figures, _)| figures),
            tilt_border_rad: figures.map(|(_, border)| border),
            refused,
        })
    });
    Ok(Sweep {
        sweep: quantity.id,
        unit: levels.unit,
        levels: judged.collect::<Result<_>>()?,
    })
}

fn at_level(case: &Case, judging: &Judging) -> Result<(Figures, f64)> {
    let figures = judge(case, &[], judging, &|| ())?;
    let (designed, closed) = (case.designed()?, case.closed_loop()?);
    let controller = case.controller(&designed, &closed);
    let border = tilt_border_rad(&closed, &*controller, judging.seconds, judging.seed);
    Ok((figures, border))
}
