//! `handstand robust MODEL`: robustness of gains against wrong masses.
//!
//! Draws `--draws` robots, each mass evenly within `--masses` percent of the model's, each by
//! itself; samples each and closes the loop with a gain made for the model: the paper's (Q = 100 I
//! and Q = I, R = I), and one made for the model and the corners of its mass errors at once.
//! Unstable is a robot whose loop has a spectral radius not below 1. The design sees no draw, so
//! every seed is fresh.
//!
//! ```console
//! $ handstand robust handstand.toml
//! ```
//!
//! Exit code 1 when the multi-model gain leaves more than 2 % unstable. `--json` prints a list of
//! `gain`, `unstable`, `median_radius`, `worst_radius`, `largest_error` (at which 2 % are unstable)
//! and `k`, by rows.

use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{DEFAULT, DesignModel, MASS_ERROR, MultiModel, WEIGHT};
use handstand::output::number::exact;
use handstand::study::{Case, MassErrors, radii, unstable_share};
use handstand::synth::{dlqr, upright, zoh};
use handstand::{Error, Model, Result};
use nalgebra::DMatrix;
use serde_json::json;
use std::path::PathBuf;

/// Share of the robots that may be unstable under a robust gain.
const UNSTABLE: f64 = 0.02;

/// Verify the robustness of gains to errors of the masses.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file
    model: PathBuf,
    /// Largest error of each mass, %
    #[arg(long, value_name = "PERCENT", default_value_t = 10.0, value_parser = input::positive)]
    masses: f64,
    /// Inertias err with the masses
    #[arg(long)]
    with_inertia: bool,
    /// Error the multi-model gain is designed for, %
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * MASS_ERROR, value_parser = input::positive)]
    design: f64,
    /// Weight of every state in that design
    #[arg(long, value_name = "Q", default_value_t = WEIGHT, value_parser = input::positive)]
    q: f64,
    /// Robots drawn
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..))]
    draws: u32,
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = input::positive)]
    ts: f64,
    /// Seed of the draws
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// A gain and the loops of the drawn robots under it.
struct Row {
    gain: String,
    k: DMatrix<f64>,
    radii: Vec<f64>,
    largest_error: f64,
}

impl Row {
    fn unstable(&self) -> f64 {
        unstable_share(&self.radii)
    }
}

/// Designs, draws, prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    for (name, percent) in [("--masses", args.masses), ("--design", args.design)] {
        if percent >= 100.0 {
            return Err(Error::usage(
                format!("{name} {percent}: the lightest robot would weigh nothing"),
                "give less than 100",
            ));
        }
    }
    let rows = rows(args, &Model::load(&args.model)?, talk)?;
    if talk.json {
        let data = rows.iter().map(|row| {
            json!({
                "gain": row.gain,
                "unstable": row.unstable(),
                "median_radius": row.radii[row.radii.len() / 2],
                "worst_radius": row.radii[row.radii.len() - 1],
                "largest_error": row.largest_error,
                "k": handstand::synth::rows(&row.k),
            })
        });
        talk.data(&data.collect::<Vec<_>>())?;
    } else {
        talk.print(&text(args, &rows))?;
    }
    Ok(
        match rows.last().is_some_and(|row| row.unstable() <= UNSTABLE) {
            true => Outcome::Done,
            false => Outcome::Refused,
        },
    )
}

fn rows(args: &Args, model: &Model, talk: &Talk) -> Result<Vec<Row>> {
    let case = Case::ideal(model.clone(), DEFAULT, args.ts);
    let errors = MassErrors {
        case: &case,
        with_inertia: args.with_inertia,
        draws: args.draws as usize,
        seed: args.seed,
    };
    let bar = talk.bar();
    bar.set_length(4);
    bar.set_message("drawing robots");
    let plants = errors.plants(args.masses / 100.0)?;
    let nominal = DesignModel::new(model, &upright(model), args.ts)?;
    let sampled = zoh(&nominal.plant, args.ts, 0.0)?;
    let regulator = |q: f64| {
        let (q, r) = DesignModel {
            q,
            ..nominal.clone()
        }
        .weights();
        Ok::<_, Error>(dlqr(&sampled, &q, &r)?.k)
    };
    let multi = MultiModel {
        mass_error: args.design / 100.0,
        with_inertia: args.with_inertia,
        weight: args.q,
    };
    let gains = [
        ("DLQR, Q = 100 I, R = I".to_string(), regulator(100.0)?),
        ("DLQR, Q = I, R = I".to_string(), regulator(1.0)?),
        (
            format!("multi-model, {} % of each mass", exact(args.design)),
            multi.gain(&nominal)?,
        ),
    ];
    bar.inc(1);
    let mut rows = Vec::new();
    for (gain, k) in gains {
        bar.set_message(gain.clone());
        rows.push(Row {
            radii: radii(&plants, &k),
            largest_error: errors.largest(&k, UNSTABLE)?,
            gain,
            k,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

fn text(args: &Args, rows: &[Row]) -> String {
    let mut table = show::table([
        "Gain",
        "unstable %",
        "median radius",
        "worst radius",
        "2 % unstable at, %",
    ]);
    for row in rows {
        table.add_row([
            row.gain.clone(),
            format!("{:.1}", 100.0 * row.unstable()),
            format!("{:.4}", row.radii[row.radii.len() / 2]),
            format!("{:.4}", row.radii[row.radii.len() - 1]),
            format!("{:.1}", 100.0 * row.largest_error),
        ]);
    }
    let mut lines = vec![
        format!(
            "{} robots, each mass within {} % of the model's:",
            args.draws,
            exact(args.masses)
        ),
        table.to_string(),
        String::new(),
        "The multi-model gain, u = -K x:".to_string(),
    ];
    if let Some(row) = rows.last() {
        for k in row.k.row_iter() {
            lines.push(
                k.iter()
                    .map(|k| format!("{k:>10.4}"))
                    .collect::<Vec<_>>()
                    .join(" "),
            );
        }
    }
    lines.join("\n")
}
