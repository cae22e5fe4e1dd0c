//! Studies as pictures.

use super::merge::Merged;
use super::sweep::{Level, Ran, Sweep};
use super::{Figures, share_interval};
use crate::error::Result;
use crate::number::given;
use crate::report::{Curve, Panel, panels};
use std::path::Path;

/// A sweep: survival, region of attraction, angles and effort over the levels.
pub fn sweep_svg(sweep: &dyn Sweep, ran: &Ran, robot: &str) -> String {
    let card = sweep.card();
    let across = match card.unit {
        "" => card.title.to_string(),
        unit => format!("{}, {unit}", card.title),
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
            [100.0 * f.survival_low, 100.0 * f.survival_high]
        })
    };
    let mut survival = curve(ran, "", |f| Some(100.0 * f.survival));
    survival.intervals = ran.levels.iter().map(percent).collect();
    panels(
        &format!("{robot}: sweep of the {}", card.title),
        &[
            panel("runs that stand, %, with 95 % interval", vec![survival]),
            panel(
                "largest tilt it recovers from, deg",
                vec![curve(ran, "", |f| Some(f.tilt_border_rad.to_degrees()))],
            ),
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

fn curve(ran: &Ran, name: &str, of: fn(&Figures) -> Option<f64>) -> Curve {
    let value = |level: &Level| level.figures.as_ref().and_then(of);
    Curve {
        name: name.to_string(),
        values: ran.levels.iter().map(value).collect(),
        intervals: Vec::new(),
    }
}

/// Parts into which an uncertain value's range is cut.
const PARTS: usize = 8;

/// A Monte Carlo study: survival over every uncertain value.
///
/// # Errors
/// As [`Merged::values`].
pub fn monte_carlo_svg(merged: &Merged, file: &Path) -> Result<String> {
    let columns = &merged.header.columns;
    let rows = merged.values(file)?;
    let Some(fell) = columns.iter().position(|column| column == "fell_s") else {
        return Ok(panels("no runs", &[]));
    };
    let uncertain = columns
        .iter()
        .enumerate()
        .filter(|(_, name)| name.contains(':'));
    let charts: Vec<Panel> = uncertain
        .map(|(place, name)| survival_over(name, &rows, place, fell))
        .collect();
    Ok(panels("Survival over every uncertain value", &charts))
}

fn survival_over(name: &str, rows: &[Vec<f64>], place: usize, fell: usize) -> Panel {
    let values = || rows.iter().map(|row| row[place]);
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
    );
    let width = (high - low) / PARTS as f64;
    let mut parts = [(0, 0); PARTS];
    for row in rows {
        let part = ((row[place] - low) / width) as usize;
        let part = &mut parts[part.min(PARTS - 1)];
        part.1 += 1;
        part.0 += usize::from(row[fell].is_nan());
    }
    let share = |(stood, all): (usize, usize)| (all > 0).then(|| 100.0 * stood as f64 / all as f64);
    Panel {
        title: "runs that stand, %, with 95 % interval".to_string(),
        steps: (0..PARTS)
            .map(|part| given(low + (part as f64 + 0.5) * width))
            .collect(),
        across: name.to_string(),
        curves: vec![Curve {
            name: String::new(),
            values: parts.iter().map(|part| share(*part)).collect(),
            intervals: parts
                .iter()
                .map(|(stood, all)| share_interval(*stood, *all).map(|end| 100.0 * end))
                .collect(),
        }],
    }
}
