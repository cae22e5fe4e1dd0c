//! `handstand robust MODEL`: robustness of gains against wrong masses.
//!
//! Draws `--draws` robots, each mass evenly within `--masses` percent of the model's, each by
//! itself; samples each and closes the loop with a gain made for the model: the paper's (Q = 100 I
//! and Q = I, R = I), and one made for the model and the corners of its mass errors at once.
//! Unstable is a robot whose loop has a spectral radius not below 1. The design sees no draw, so
//! every seed is fresh. Drives are as late as the model has them, and the gains made for it know.
//!
//! `--plan FILE` judges gains of your own, what `handstand gains --json` printed; `--q` and `--r`
//! those of your weights.
//!
//! ```console
//! $ handstand robust handstand.toml
//! ```
//!
//! Exit code 1 when the multi-model gain, or yours if there is one, leaves more than 2 % unstable.
//! `--json` prints a list of `gain`, `unstable`, `median_radius`, `worst_radius`, `largest_error`
//! (at which 2 % are unstable) and `k`, by rows.

mod plan;

use super::gains::of_options;
use super::weight_arg::{WeightArg, weight};
use super::{Console, ExitStatus, input, show};
use handstand::output::number::exact;
use handstand::report::table::columns_of;
use handstand::study::{Case, MassErrors, radii, unstable_share};
use handstand::synth::controllers::{DEFAULT, DesignModel, MASS_ERROR, MultiModel, WEIGHT};
use handstand::synth::{Weight, dlqr, upright, zoh};
use handstand::{Error, Model, Result};
use nalgebra::DMatrix;
use serde::Serialize;
use std::path::PathBuf;

/// Share of the robots that may be unstable under a robust gain.
const UNSTABLE: f64 = 0.02;

/// Verify the robustness of gains to errors of the masses.
#[derive(Debug, clap::Args)]
pub struct RobustArgs {
    /// Model file
    model: PathBuf,
    /// Judge these gains too: what `handstand gains MODEL --json` printed
    #[arg(long, value_name = "FILE.json")]
    plan: Option<PathBuf>,
    /// Largest error of each mass, %
    #[arg(long, value_name = "PERCENT", default_value_t = 10.0, value_parser = input::positive)]
    masses: f64,
    /// Inertias err with the masses
    #[arg(long)]
    with_inertia: bool,
    /// Error the multi-model gain is designed for, %
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * MASS_ERROR)]
    #[arg(value_parser = input::positive)]
    design: f64,
    /// Weight of every state in that design
    #[arg(long, value_name = "Q", default_value_t = WEIGHT, value_parser = input::positive)]
    design_q: f64,
    /// Judge the regulator of these weights, too: of the states, a number, a diagonal, or a CSV
    /// file of a matrix
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    #[arg(conflicts_with = "plan")]
    q: Option<WeightArg>,
    /// Weight of the torques in it, likewise [default: 1]
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    #[arg(requires = "q")]
    r: Option<WeightArg>,
    /// Robots drawn
    #[arg(long, value_name = "N", default_value_t = 2000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    draws: u32,
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = input::positive)]
    ts: f64,
    /// Seed of the draws
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// A gain, and the loops of the drawn robots under it.
#[derive(Serialize)]
struct GainRobustness {
    gain: String,
    unstable: f64,
    median_radius: f64,
    worst_radius: f64,
    largest_error: f64,
    k: Vec<Vec<f64>>,
}

/// Designs, draws, prints.
pub fn run(args: &RobustArgs, console: &Console) -> Result<ExitStatus> {
    for (name, percent) in [("--masses", args.masses), ("--design", args.design)] {
        if percent >= 100.0 {
            return Err(Error::usage(
                format!("{name} {percent}: the lightest robot would weigh nothing"),
                "give less than 100",
            ));
        }
    }
    let gains = judged(args, &Model::load(&args.model)?, console)?;
    console.result(&gains, || text(args, &gains))?;
    let judged = if args.own() {
        gains.first()
    } else {
        gains.last()
    };
    Ok(ExitStatus::answer(
        judged.is_some_and(|gain| gain.unstable <= UNSTABLE),
    ))
}

impl RobustArgs {
    /// Whether a gain of one's own is judged, which comes first.
    fn own(&self) -> bool {
        self.plan.is_some() || self.q.is_some()
    }
}

fn judged(args: &RobustArgs, model: &Model, console: &Console) -> Result<Vec<GainRobustness>> {
    let case = Case::ideal(model.clone(), DEFAULT, args.ts);
    let errors = MassErrors {
        case: &case,
        with_inertia: args.with_inertia,
        draws: args.draws as usize,
        seed: args.seed,
    };
    let bar = console.bar(4 + u64::from(args.own()));
    bar.set_message("drawing robots");
    let plants = errors.plants(args.masses / 100.0)?;
    let nominal = DesignModel::new(model, &upright(model), args.ts)?;
    let sampled = zoh(&nominal.plant, args.ts, nominal.delay_s)?;
    let regulator = |q: Weight, r: Weight| {
        let own = nominal.clone();
        let (q, r) = DesignModel { q, r, ..own }.weights()?;
        Ok::<_, Error>(dlqr(&sampled, &q, &r)?.k)
    };
    let equal = |q: f64| regulator(Weight::Scalar(q), Weight::Scalar(1.0));
    let multi = MultiModel {
        mass_error: args.design / 100.0,
        with_inertia: args.with_inertia,
        weight: args.design_q,
    };
    let title = format!("multi-model, {} % of each mass", exact(args.design));
    let mut gains = vec![
        ("DLQR, Q = 100 I, R = I".to_string(), equal(100.0)?),
        ("DLQR, Q = I, R = I".to_string(), equal(1.0)?),
        (title, multi.gain(&nominal, nominal.delay_s)?),
    ];
    if let Some(file) = &args.plan {
        let k = plan::gain(file, model, &sampled, args.ts)?;
        gains.insert(0, (file.display().to_string(), k));
    }
    if let Some(q) = &args.q {
        let q = q.read()?;
        let r = args.r.as_ref().map(WeightArg::read).transpose()?;
        let r = r.unwrap_or(Weight::Scalar(1.0));
        let title = format!("DLQR, Q = {q}, R = {r}");
        let k = regulator(q, r).map_err(of_options)?;
        gains.insert(0, (title, k));
    }
    bar.inc(1);
    let judge = |(gain, k): (String, DMatrix<f64>)| {
        bar.set_message(gain.clone());
        let radii = radii(&plants, &k);
        let largest_error = errors.largest(&k, UNSTABLE)?;
        bar.inc(1);
        Ok(GainRobustness {
            gain,
            unstable: unstable_share(&radii),
            median_radius: radii[radii.len() / 2],
            worst_radius: radii[radii.len() - 1],
            largest_error,
            k: k.row_iter()
                .map(|row| row.iter().copied().collect())
                .collect(),
        })
    };
    gains.into_iter().map(judge).collect()
}

fn text(args: &RobustArgs, gains: &[GainRobustness]) -> String {
    let columns = columns_of::<GainRobustness>()
        .text("Gain", |g| g.gain.clone())
        .text("unstable %", |g| format!("{:.1}", 100.0 * g.unstable))
        .text("median radius", |g| format!("{:.4}", g.median_radius))
        .text("worst radius", |g| format!("{:.4}", g.worst_radius))
        .text("2 % unstable at, %", |g| {
            format!("{:.1}", 100.0 * g.largest_error)
        });
    let mut text = format!(
        "{} robots, each mass within {} % of the model's:\n{}\n\nThe multi-model gain, u = -K x:",
        args.draws,
        exact(args.masses),
        show::table_of(gains, &columns)
    );
    for row in gains.last().map_or(&[][..], |gain| &gain.k) {
        let row: Vec<String> = row.iter().map(|k| format!("{k:>10.4}")).collect();
        text += &format!("\n{}", row.join(" "));
    }
    text
}
