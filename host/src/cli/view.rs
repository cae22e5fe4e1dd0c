//! `handstand view MODEL LOG... -o page.html`: a page that plays a motion.
//!
//! One file that needs nothing but itself: the chain drawn to the model's lengths, the input of
//! each drive, the trail of its tip, the angles over time; play, pause, scrub, speed, keys.
//! `--model OTHER.toml` adds what a model predicts for the log's inputs, `--overlay LOG` another
//! log, each drawn over the measurement.
//!
//! ```console
//! $ handstand view handstand.toml run.csv --model handstand.toml -o run.html
//! ```
//!
//! Models run as in `compare`: starting afresh every `--horizon` seconds. An address ending in
//! `#t=1.5` opens the page at 1.5 s, `#play` playing, `#motion=2` at the third motion.

use super::{Console, ExitStatus, input};
use handstand::compare::compare;
use handstand::log::{LogRequest, read};
use handstand::report::file_names;
use handstand::report::playback::{Scene, html};
use handstand::{Error, Result, output};
use std::path::PathBuf;

/// Animate a motion on an HTML page.
#[derive(Debug, clap::Args)]
pub struct ViewArgs {
    /// Model file: lengths to draw, columns of the log
    model: PathBuf,
    /// Logs to play
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// The page to write
    #[arg(long, short, value_name = "FILE.html")]
    output: PathBuf,
    /// Model to run along the log's inputs and draw over it
    #[arg(long = "model", value_name = "OTHER.toml")]
    others: Vec<PathBuf>,
    /// Another log to draw over it
    #[arg(long, value_name = "LOG", value_parser = input::log)]
    overlay: Vec<LogRequest>,
    #[command(flatten)]
    run: input::RunLength,
    /// Replace the page if it exists
    #[arg(long)]
    force: bool,
}

/// Reads, runs the models, writes the page.
pub fn run(args: &ViewArgs, console: &Console) -> Result<ExitStatus> {
    output::vacant(&args.output, args.force)?;
    let model = input::model(&args.model)?;
    model.hinges_only("a page draws links that turn")?;
    model.planar_only("a page draws links in their plane")?;
    if let Some(sentence) = model.log.unobserved().into_iter().next() {
        return Err(Error::usage(
            sentence,
            "a page shows measured angles: name the column of this one under [[log.joint]]",
        ));
    }
    let motions = input::motions(&args.logs, &model.log, console)?;
    let mut scene = Scene::measured(&model, &motions);
    for (file, name) in args.others.iter().zip(file_names(&args.others)) {
        let other = input::model(file)?;
        if other.link_count() != model.link_count() {
            return Err(Error::usage(
                format!(
                    "{} has {} links and {} has {}",
                    file.display(),
                    other.link_count(),
                    args.model.display(),
                    model.link_count()
                ),
                "draw models of one chain over each other",
            ));
        }
        let motions = read(&args.logs, &other.log)?;
        let horizon = args.run.of(&other, &motions)?;
        scene.add_model(&other, &compare(&other, &name, &motions, horizon));
    }
    scene.add_overlay(&model, &input::motions(&args.overlay, &model.log, console)?);
    let page = html(&scene, &console.command)
        .map_err(|error| Error::file(&args.output, "write", error.into()))?;
    console.write(&args.output, &page, args.force)?;
    if console.json {
        console.data(&serde_json::json!({
            "page": args.output.to_string_lossy(),
            "motions": scene.motions.iter().map(|m| &m.name).collect::<Vec<_>>(),
        }))?;
    }
    Ok(ExitStatus::Done)
}
