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
//! A robot in space is drawn by the shapes and STL meshes that its file names, where they lie, and
//! by capsules else; the view is turned by mouse, touch and keys.
//!
//! Models run as in `compare`: starting afresh every `--horizon` seconds. An address ending in
//! `#t=1.5` opens the page at 1.5 s, `#play` playing, `#motion=2` at the third motion.

use super::{Console, ExitStatus, input};
use handstand::compare::compare;
use handstand::log::{LogRequest, read};
use handstand::model::Model;
use handstand::model::shapes::{NotDrawn, RobotShapes};
use handstand::report::file_names;
use handstand::report::playback::{Scene, html};
use handstand::{Error, Result, output};
use std::path::{Path, PathBuf};

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
    if !model.is_in_space() {
        model.hinges_only("a page draws links that turn")?;
    }
    if let Some(sentence) = model.log.unobserved().into_iter().next() {
        return Err(Error::usage(
            sentence,
            "a page shows measured angles: name the column of this one under [[log.joint]]",
        ));
    }
    let motions = input::motions(&args.logs, &model.log, console)?;
    let mut scene = Scene::measured(&model, &motions);
    let not_drawn = dress(&mut scene, &model, &args.model, console)?;
    for (file, name) in args.others.iter().zip(file_names(&args.others)) {
        let other = input::model(file)?;
        alike([&args.model, file], [&model, &other])?;
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
            "not_drawn": not_drawn,
        }))?;
    }
    Ok(ExitStatus::Done)
}

/// Draws a robot in space by the shapes of its file; what of them is not drawn.
fn dress(
    scene: &mut Scene,
    model: &Model,
    file: &Path,
    console: &Console,
) -> Result<Vec<NotDrawn>> {
    let Some(robot) = &model.robot else {
        return Ok(Vec::new());
    };
    let shapes = RobotShapes::read(robot, file)?;
    scene.dress(model, &shapes);
    if let Some(line) = shapes.not_drawn_text() {
        console.say(&line);
    }
    Ok(shapes.not_drawn)
}

/// Refuses models that are not of one chain or robot; `files` are theirs.
fn alike(files: [&Path; 2], models: [&Model; 2]) -> Result<()> {
    let what = models.map(|model| match &model.robot {
        None => format!("{} links", model.link_count()),
        Some(robot) => format!("the joints {}", robot.joints.join(", ")),
    });
    if what[0] == what[1] {
        return Ok(());
    }
    let [first, other] = files.map(Path::display);
    Err(Error::usage(
        format!("{other} has {} and {first} has {}", what[1], what[0]),
        "draw models of one chain over each other",
    ))
}
