//! Studies as SVG files.

use crate::error::Result;
use crate::output::number::given;
use crate::plot::{Chart, Curve, Tone, svg_file};
use crate::study::{Figures, Level, Levels, Merged, Quantity, Sweep, share_interval};
use std::path::Path;

/// Colours of a chart's curves.
const TONES: [Tone; 2] = [Tone::Blue, Tone::Orange];

/// A sweep: share stabilised, region of attraction, angles and effort over the levels.
pub fn sweep_svg((quantity, levels): (&Quantity, &Levels), ran: &Sweep, robot: &str) -> String {
    let across = match levels.unit {
        "" => quantity.title.to_string(),
        unit => format!("{}, {unit}", quantity.title),
    };
    let chart = |y_label: &str, curves| Chart {
        categories: ran.levels.iter().map(|level| level.label.clone()).collect(),
        ..Chart::new("", &across, y_label, curves)
    };
    let degrees = |angle_rad: Option<f64>| angle_rad.map(f64::to_degrees);
    let mut stabilised = curve(ran, "", TONES[0], |f| Some(100.0 * f.stabilised_share));
    stabilised.intervals = ran.levels.iter().map(stabilised_percent).collect();
    let borders = ran
        .levels
        .iter()
        .map(|level| degrees(level.tilt_border_rad));
    let border = Curve::by_category("", TONES[0], borders);
    let angles = vec![
        curve(ran, "rms", TONES[0], |f| degrees(f.rms_angle_rad)),
        curve(ran, "limit cycle", TONES[1], |f| degrees(f.limit_cycle_rad)),
    ];
    let torque = curve(ran, "", TONES[0], |f| f.rms_torque_nm);
    svg_file(
        &format!("{robot}: sweep of the {}", quantity.title),
        &[
            chart("stabilised runs, %, with 95 % interval", vec![stabilised]),
            chart("largest tilt it recovers from, deg", vec![border]),
            chart("angles, deg", angles),
            chart("rms torque, N m", vec![torque]),
        ],
    )
}

fn stabilised_percent(level: &Level) -> [f64; 2] {
    let figures = level.figures.as_ref();
    let ends = figures.map(|f| [f.stabilised_low, f.stabilised_high]);
    ends.map_or([0.0; 2], |ends| ends.map(|end| 100.0 * end))
}

fn curve(ran: &Sweep, name: &str, tone: Tone, of: impl Fn(&Figures) -> Option<f64>) -> Curve {
    let figures = ran.levels.iter().map(|level| level.figures.as_ref());
    Curve::by_category(name, tone, figures.map(|figures| figures.and_then(&of)))
}

/// Bins into which an uncertain value's range is cut.
const BINS: usize = 6;

/// A Monte Carlo study: share stabilised, and share unstable in the small, over every uncertain
/// value.
///
/// # Errors
/// As [`Merged::values`].
pub fn monte_carlo_svg(merged: &Merged, file: &Path) -> Result<String> {
    let columns = &merged.header.columns;
    let rows = merged.values(file)?;
    let place = |name: &str| columns.iter().position(|column| column == name);
    let (Some(stabilised), Some(radius)) = (place("stabilised"), place("spectral_radius")) else {
        return Ok(svg_file("no runs", &[]));
    };
    let is_stabilised = |row: &[f64]| row[stabilised] == 1.0;
    let unstable = |row: &[f64]| row[radius] >= 1.0;
    let chart = |(value, name): (usize, &String)| {
        let parts = Bins::of(&rows, value);
        let curves = vec![
            parts.share("stabilised", TONES[0], &rows, is_stabilised),
            parts.share("unstable in the small", TONES[1], &rows, unstable),
        ];
        Chart {
            categories: parts.centres.iter().map(|centre| given(*centre)).collect(),
            ..Chart::new("", name, "share of runs, %, with 95 % interval", curves)
        }
    };
    let uncertain = columns.iter().enumerate();
    let uncertain = uncertain.filter(|(_, name)| name.contains(':'));
    let charts: Vec<Chart> = uncertain.map(chart).collect();
    Ok(svg_file("Stability over every uncertain value", &charts))
}

/// Runs sorted by one of their values.
struct Bins {
    centres: [f64; BINS],
    /// Part of each run.
    of: Vec<usize>,
}

impl Bins {
    fn of(rows: &[Vec<f64>], value: usize) -> Bins {
        let values = || rows.iter().map(|row| row[value]);
        let low = values().fold(f64::INFINITY, f64::min);
        let width = (values().fold(f64::NEG_INFINITY, f64::max) - low) / BINS as f64;
        Bins {
            centres: std::array::from_fn(|part| low + (part as f64 + 0.5) * width),
            of: values()
                .map(|value| (((value - low) / width) as usize).min(BINS - 1))
                .collect(),
        }
    }

    /// Percentage of each part's runs that are so.
    fn share(
        &self,
        name: &str,
        tone: Tone,
        rows: &[Vec<f64>],
        so: impl Fn(&[f64]) -> bool,
    ) -> Curve {
        let mut counts = [(0, 0); BINS];
        for (part, row) in self.of.iter().zip(rows) {
            counts[*part].0 += usize::from(so(row));
            counts[*part].1 += 1;
        }
        let share = |(of, all): (usize, usize)| (all > 0).then(|| 100.0 * of as f64 / all as f64);
        let interval =
            |(of, all): &(usize, usize)| share_interval(*of, *all).map(|end| 100.0 * end);
        Curve {
            intervals: counts.iter().map(interval).collect(),
            ..Curve::by_category(name, tone, counts.map(share))
        }
    }
}
