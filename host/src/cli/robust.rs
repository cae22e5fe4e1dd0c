//! `handstand robust MODEL`: what gains make of robots whose masses are not the model's.
//!
//! Draws `--draws` robots, each mass evenly within `--masses` percent of the model's, each by itself; samples each and
//! closes the loop with a gain made for the model: the paper's (Q = 100 I and Q = I, R = I), and one made for the
//! model and the corners of its mass errors at once. Lost is a robot whose loop has a spectral radius not below 1.
//! The design sees no draw, so every seed is fresh.
//!
//! ```console
//! $ handstand robust handstand.toml
//! ```
//!
//! Exit code 1 when the multi-model gain loses more than 2 %. `--json` prints a list of `gain`, `lost`,
//! `median_radius`, `worst_radius`, `largest_error` (of which 2 % are lost) and `k`, by rows.

use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{SHARE, Uncertain, WEIGHTS, robust_gain};
use handstand::number::exact;
use handstand::synth::{Discrete, dlqr, lost_share, spectral_radius, upright};
use handstand::{Error, Model, Result};
use nalgebra::DMatrix;
use serde_json::json;
use std::path::PathBuf;

/// Share of the robots that a robust gain may lose.
const LOST: f64 = 0.02;

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
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * SHARE, value_parser = input::positive)]
    design: f64,
    /// Weight of every state in that design
    #[arg(long, value_name = "Q", default_value_t = WEIGHTS, value_parser = input::positive)]
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

/// A gain and what it makes of the robots.
struct Row {
    gain: String,
    k: DMatrix<f64>,
    radii: Vec<f64>,
    largest_error: f64,
}

impl Row {
    fn lost(&self) -> f64 {
        self.radii.iter().filter(|radius| **radius >= 1.0).count() as f64 / self.radii.len() as f64
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
                "lost": row.lost(),
                "median_radius": row.radii[row.radii.len() / 2],
                "worst_radius": row.radii[row.radii.len() - 1],
                "largest_error": row.largest_error,
                "k": row.k.row_iter().map(|k| k.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
            })
        });
        talk.data(&data.collect::<Vec<_>>())?;
    } else {
        talk.print(&text(args, &rows))?;
    }
    Ok(match rows.last().is_some_and(|row| row.lost() <= LOST) {
        true => Outcome::Done,
        false => Outcome::Refused,
    })
}

fn rows(args: &Args, model: &Model, talk: &Talk) -> Result<Vec<Row>> {
    let pose_rad = upright(model);
    let uncertain = |percent: f64| Uncertain {
        mass: percent / 100.0,
        with_inertia: args.with_inertia,
        period_s: args.ts,
        delay_s: 0.0,
    };
    let draw =
        |percent: f64| uncertain(percent).draw(model, &pose_rad, args.draws as usize, args.seed);
    let bar = talk.bar();
    bar.set_length(4);
    bar.set_message("drawing robots");
    let plants = draw(args.masses)?;
    let nominal = uncertain(0.0).plant(model, &pose_rad, &vec![0.0; model.link_count()])?;
    let (n, m) = nominal.b.shape();
    let unit = DMatrix::identity(n, n);
    let paper = |q: f64| Ok::<_, Error>(dlqr(&nominal, &(&unit * q), &DMatrix::identity(m, m))?.k);
    let multi = robust_gain(model, &pose_rad, &uncertain(args.design), &(&unit * args.q))?;
    let gains = [
        ("DLQR, Q = 100 I, R = I".to_string(), paper(100.0)?),
        ("DLQR, Q = I, R = I".to_string(), paper(1.0)?),
        (
            format!("multi-model, {} % of each mass", exact(args.design)),
            multi,
        ),
    ];
    bar.inc(1);
    let mut rows = Vec::new();
    for (gain, k) in gains {
        bar.set_message(gain.clone());
        rows.push(Row {
            radii: radii(&plants, &k),
            largest_error: largest_error(&draw, &k)?,
            gain,
            k,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// Spectral radii of the loops, in order.
fn radii(plants: &[Discrete], k: &DMatrix<f64>) -> Vec<f64> {
    let radius = |plant: &Discrete| spectral_radius(&(&plant.a - &plant.b * k));
    let mut radii: Vec<f64> = plants.iter().map(radius).collect();
    radii.sort_by(f64::total_cmp);
    radii
}

/// Largest error of the masses of which no more than 2 % of the robots are lost, a share; to a quarter of a percent.
fn largest_error(draw: &impl Fn(f64) -> Result<Vec<Discrete>>, k: &DMatrix<f64>) -> Result<f64> {
    let (mut held, mut lost) = (0.0, 64.0);
    while lost - held > 0.25 {
        let middle = (held + lost) / 2.0;
        if lost_share(&draw(middle)?, k) <= LOST {
            held = middle;
        } else {
            lost = middle;
        }
    }
    Ok(held / 100.0)
}

fn text(args: &Args, rows: &[Row]) -> String {
    let mut table = show::table([
        "Gain",
        "lost %",
        "median radius",
        "worst radius",
        "2 % lost at, %",
    ]);
    for row in rows {
        table.add_row([
            row.gain.clone(),
            format!("{:.1}", 100.0 * row.lost()),
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
