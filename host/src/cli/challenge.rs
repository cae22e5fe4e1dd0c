//! `handstand challenge`: a virtual bench arm with a hidden effect, to try oneself or the program
//! on.
//!
//! `new` writes a folder with `nominal.toml` (what the arm's owner believes), logs `a.csv`,
//! `b.csv`, `c.csv`, and the sealed answer. `score` opens the answer and scores a model by it.
//!
//! ```console
//! $ handstand challenge new --seed 7 -o riddle
//! $ handstand challenge score riddle riddle/model.toml
//! ```
//!
//! `score` exits with 1 when the model does not name what was hidden. `--json` prints `hidden`,
//! `added`, `solved`, `values` (`key`, `true_value`, `estimate`), `nominal_error_rad`, `error_rad`,
//! `true_error_rad`.

use super::{Console, ExitStatus, show};
use handstand::challenge::{self, ChallengeScore, Hidden, kind_named, score_rows};
use handstand::diagnose::whole_error_rad;
use handstand::fitting::effect_named;
use handstand::output::number::exact;
use handstand::{Error, Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// What can be done with challenges.
#[derive(Debug, clap::Subcommand)]
pub enum ChallengeCommand {
    /// Create a virtual bench with a hidden effect
    New(New),
    /// Score a model against the hidden effect
    Score(ScoreArgs),
}

/// Create a virtual bench with a hidden effect.
#[derive(Debug, clap::Args)]
pub struct New {
    /// Seed: the same one makes the same bench
    #[arg(long, value_name = "N")]
    seed: u64,
    /// The effect to hide, or `none`; random without it
    #[arg(long, value_name = "NAME")]
    effect: Option<String>,
    /// Folder to make
    #[arg(long, short, value_name = "DIR")]
    output: PathBuf,
}

/// Score a model against the hidden effect.
#[derive(Debug, clap::Args)]
pub struct ScoreArgs {
    /// Folder of the challenge
    folder: PathBuf,
    /// Model file
    model: PathBuf,
}

/// Makes or scores.
pub fn run(command: &ChallengeCommand, console: &Console) -> Result<ExitStatus> {
    match command {
        ChallengeCommand::New(args) => new(args, console),
        ChallengeCommand::Score(args) => {
            let score =
                challenge::score(&args.folder, &Model::load(&args.model)?, whole_error_rad)?;
            console.result(&score, || text(&score))?;
            Ok(ExitStatus::answer(score.solved))
        }
    }
}

fn new(args: &New, console: &Console) -> Result<ExitStatus> {
    let made = challenge::generate(args.seed, hidden(args.effect.as_deref())?);
    challenge::write(&made, &args.output)?;
    if console.json {
        console.data(&json!({
            "folder": args.output.to_string_lossy(),
            "model": "nominal.toml",
            "logs": made.logs.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        }))?;
    } else {
        console.say(&format!(
            "wrote {}: its README.txt says what to do",
            args.output.display()
        ));
    }
    Ok(ExitStatus::Done)
}

fn hidden(named: Option<&str>) -> Result<Hidden> {
    let Some(named) = named else {
        return Ok(Hidden::Random);
    };
    if named == "none" {
        return Ok(Hidden::Nothing);
    }
    let id = effect_named(named)?.info().id;
    kind_named(id).map(Hidden::Effect).ok_or_else(|| {
        Error::usage(
            format!("`{id}` cannot be hidden in the bench arm"),
            format!("one of these can: {}", challenge::KINDS.join(", ")),
        )
    })
}

/// A score for people.
pub fn text(score: &ChallengeScore) -> String {
    let values = score.values.iter();
    let values = values.map(|value| (value.key.as_str(), value.true_value, value.estimate));
    let errors = [score.true_error_rad, score.error_rad];
    let rows = score_rows(score.hidden.as_deref(), &score.added, values, errors);
    let mut table = show::table([""]);
    table.set_header(&rows[0]).add_rows(&rows[1..]);
    let said = if score.solved {
        "Solved: the model names what was hidden."
    } else {
        "Not solved: the model does not name what was hidden."
    };
    let nominal = exact(1e3 * score.nominal_error_rad);
    format!("{table}\n\nnominal.toml leaves {nominal} mrad on c.csv.\n{said}")
}
