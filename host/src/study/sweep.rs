//! One thing varied, level by level. A new sweep is a file under `sweeps/` and a line in [`SWEEPS`].

use super::case::Case;
use super::judge::{Figures, Judging, judge};
use super::sweeps;
use crate::error::{Error, Result};
use serde::Serialize;
use std::fmt;

/// Every sweep there is.
pub const SWEEPS: &[&dyn Sweep] = &[
    &sweeps::float_fixed::FloatFixed,
    &sweeps::word_length::WordLength,
    &sweeps::position_resolution::PositionResolution,
    &sweeps::gyro_resolution::GyroResolution,
    &sweeps::dead_zone::DeadZone,
    &sweeps::delay::Delay,
    &sweeps::jitter::Jitter,
    &sweeps::supply::Supply,
    &sweeps::saturation::Saturation,
    &sweeps::sampling_time::SamplingTime,
];

/// Something of a case that can be varied.
pub trait Sweep: Sync + fmt::Debug {
    /// What it is.
    fn card(&self) -> &'static SweepCard;

    /// Sets the level, in the card's unit.
    fn set(&self, level: f64, case: &mut Case);

    /// A level as people read it.
    fn label(&self, level: f64) -> String {
        crate::number::given(level)
    }
}

/// What a sweep says of itself.
#[derive(Debug, Clone, Copy)]
pub struct SweepCard {
    /// Name on the command line.
    pub id: &'static str,
    /// Name for people, lower case.
    pub title: &'static str,
    /// Unit of its levels; empty for none.
    pub unit: &'static str,
    /// What is varied, in a sentence.
    pub meaning: &'static str,
    /// Levels that are tried if no others are asked for.
    pub levels: &'static [f64],
    /// Lowest and highest level there can be.
    pub bounds: (f64, f64),
}

/// The sweep of this id.
pub fn named(id: &str) -> Option<&'static dyn Sweep> {
    SWEEPS.iter().copied().find(|sweep| sweep.card().id == id)
}

/// A level and what came of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Level {
    /// Level, in the sweep's unit.
    pub level: f64,
    /// As people read it.
    pub label: String,
    /// Figures; none if there is no controller for this level.
    pub figures: Option<Figures>,
    /// Why there is none.
    pub refused: Option<String>,
}

/// A whole sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ran {
    /// Its id.
    pub sweep: &'static str,
    /// Unit of its levels.
    pub unit: &'static str,
    /// Level by level.
    pub levels: Vec<Level>,
}

/// Judges `case` at every level; `done` is told after each.
///
/// # Errors
/// Levels out of bounds; robots that cannot be simulated. A level without a controller is no error but a finding.
pub fn sweep(
    sweep: &dyn Sweep,
    levels: &[f64],
    case: &Case,
    judging: &Judging,
    mut done: impl FnMut(),
) -> Result<Ran> {
    let card = sweep.card();
    let (low, high) = card.bounds;
    if let Some(level) = levels.iter().find(|level| !(low..=high).contains(*level)) {
        return Err(Error::usage(
            format!("{}: there is no level {level}", card.id),
            format!("give levels from {low} to {high} {}", card.unit).trim_end(),
        ));
    }
    let judged = levels.iter().map(|&level| {
        let mut case = case.clone();
        sweep.set(level, &mut case);
        let (figures, refused) = match judge(&case, judging) {
            Ok(figures) => (Some(figures), None),
            Err(Error::Design(reason)) => (None, Some(reason.to_string())),
            Err(error) => return Err(error),
        };
        done();
        Ok(Level {
            level,
            label: sweep.label(level),
            figures,
            refused,
        })
    });
    Ok(Ran {
        sweep: card.id,
        unit: card.unit,
        levels: judged.collect::<Result<_>>()?,
    })
}
