//! Studies as pictures.

use super::merge::Merged;
use super::quantity::{Levels, Quantity};
use super::sweep::{Level, Sweep};
use super::{Figures, share_interval};
use crate::error::Result;
use crate::number::given;
use crate::report::{Curve, Panel, panels};
use std::path::Path;

/// A sweep: share stabilised, region of attraction, angles and effort over the levels.
pub fn sweep_svg((quantity, levels): (&Quantity, &Levels), ran: &Sweep, robot: &str) -> String {
    let across = match levels.unit {
        "" => quantity.title.to_string(),
        unit => format!("{}, {unit}", quantity.title),
    };
    let steps: Vec<String> = ran.levels.iter().map(|level| level.label.clone()).collect();
    let panel = |title: &str, curves: Vec<Curve>| Panel {
        title: title.to_string(),
        steps: steps.clone(),
        across: across.clone(),
        curves,
    };
    let percent = |level: &Level| {
        let figures = level.figures.as_ref();
        figures.map_or([0.0; 2], |f| {
            [100.0 * f.stabilised_low, 100.0 * f.stabilised_high]
        })
    };
    let mut stabilised = curve(ran, "", |f| Some(100.0 * f.stabilised_share));
    stabilised.intervals = ran.levels.iter().map(percent).collect();
    let border = Curve {
        values: ran
            .levels
            .iter()
            .map(|level| level.tilt_border_rad.map(f64::to_degrees))
            .collect(),
        ..curve(ran, "", |_| None)
    };
    panels(
        &format!("{robot}: sweep of the {}", quantity.title),
        &[
            panel("stabilised runs, %, with 95 % interval", vec![stabilised]),
            panel("largest tilt it recovers from, deg", vec![border]),
            panel(
                "angles, deg",
                vec![
                    curve(ran, "rms", |f| f.rms_angle_rad.map(f64::to_degrees)),
                    curve(ran, "limit cycle", |f| {
                        f.limit_cycle_rad.map(f64::to_degrees)
                    }),
                ],
            ),
            panel("rms torque, N m", vec![curve(ran, "", |f| f.rms_torque_nm)]),
        ],
    )
}

fn curve(ran: &Sweep, name: &str, of: fn(&Figures) -> Option<f64>) -> Curve {
    let value = |level: &Level| level.figures.as_ref().and_then(of);
    Curve {
        name: name.to_string(),
        values: ran.levels.iter().map(value).collect(),
        intervals: Vec::new(),
    }
}

/// Parts into which an uncertain value's range is cut.
const PARTS: usize = 6;

/// A Monte Carlo study: share stabilised, and share unstable in the small, over every uncertain value.
///
/// # Errors
/// As [`Merged::values`].
pub fn monte_carlo_svg(merged: &Merged, file: &Path) -> Result<String> {
    let columns = &merged.header.columns;
    let rows = merged.values(file)?;
    let place = |name: &str| columns.iter().position(|column| column == name);
    let (Some(stabilised), Some(radius)) = (place("stabilised"), place("spectral_radius")) else {
        return Ok(panels("no runs", &[]));
    };
    let is_stabilised = move |row: &[f64]| row[stabilised] == 1.0;
    let unstable = move |row: &[f64]| row[radius] >= 1.0;
    let uncertain = columns.iter().enumerate();
    let charts = uncertain
        .filter(|(_, name)| name.contains(':'))
        .map(|(value, name)| {
            let parts = Parts::of(&rows, value);
            Panel {
                title: "share of runs, %, with 95 % interval".to_string(),
                steps: parts.centres.iter().map(|centre| given(*centre)).collect(),
                across: name.clone(),
                curves: vec![
                    parts.share("stabilised", &rows, is_stabilised),
                    parts.share("unstable in the small", &rows, unstable),
                ],
            }
        });
    let charts: Vec<Panel> = charts.collect();
    Ok(panels("Stability over every uncertain value", &charts))
}

/// Runs sorted by one of their values.
struct Parts {
    centres: [f64; PARTS],
    /// Part of each run.
    of: Vec<usize>,
}

impl Parts {
    fn of(rows: &[Vec<f64>], value: usize) -> Parts {
        let values = || rows.iter().map(|row| row[value]);
        let low = values().fold(f64::INFINITY, f64::min);
        let width = (values().fold(f64::NEG_INFINITY, f64::max) - low) / PARTS as f64;
        Parts {
            centres: std::array::from_fn(|part| low + (part as f64 + 0.5) * width),
            of: values()
                .map(|value| (((value - low) / width) as usize).min(PARTS - 1))
                .collect(),
        }
    }

    /// Percentage of each part's runs that are so.
    fn share(&self, name: &str, rows: &[Vec<f64>], so: impl Fn(&[f64]) -> bool) -> Curve {
        let mut counts = [(0, 0); PARTS];
        for (part, row) in self.of.iter().zip(rows) {
            counts[*part].0 += usize::from(so(row));
            counts[*part].1 += 1;
        }
        let share =
            |(of, all): &(usize, usize)| (*all > 0).then(|| 100.0 * *of as f64 / *all as f64);
        let interval =
            |(of, all): &(usize, usize)| share_interval(*of, *all).map(|end| 100.0 * end);
        Curve {
            name: name.to_string(),
            values: counts.iter().map(share).collect(),
            intervals: counts.iter().map(interval).collect(),
        }
    }
}
