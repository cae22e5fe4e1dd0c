//! `handstand diagnose MODEL --each FOLDER -o RESULT [--shard I/N]`: every log by itself.
//!
//! Each outcome is a line of `RESULT/shard-I-of-N.jsonl`; a killed run, or another one with more
//! logs, goes on where that one was. Without `--shard` the outcomes of all shards are put together:
//! `logs.csv` and `logs.html`. An outcome counts as long as log, model, options and program are the
//! same.
//!
//! `--json` prints `complete` and `outcomes`; for a shard `complete`, `file` and `logs`. Exit code
//! 1 when no log could be learned from.

use super::{DiagnoseArgs, options};
use crate::cli::{Console, ExitStatus, input};
use handstand::diagnose::conventions::ModelFile;
use handstand::diagnose::{DiagnoseOptions, LogOutcome, OutcomeFile, OutcomeKey, outcomes_in};
use handstand::log::{LogRequest, unfolded};
use handstand::output::write_new;
use handstand::report::{outcomes_csv, outcomes_html, outcomes_text};
use handstand::study::Shard;
use handstand::{Error, Model, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Logs of a folder.
#[derive(Debug, clap::Args)]
pub struct EachArgs {
    /// Diagnose every log of this folder by itself
    #[arg(long = "each", id = "each", value_name = "FOLDER", requires = "output")]
    #[arg(conflicts_with_all = ["logs", "holdout", "plan", "file"])]
    pub folder: Option<PathBuf>,
    /// Folder of the outcomes of --each, its table and its page
    #[arg(long, short, value_name = "RESULT", requires = "each")]
    output: Option<PathBuf>,
    /// Only this share of the folder's logs: `2/8` is the second of eight
    #[arg(long, value_name = "I/N", requires = "each")]
    shard: Option<Shard>,
}

/// Diagnoses what is not done yet.
pub fn run(folder: &Path, args: &DiagnoseArgs, console: &Console) -> Result<ExitStatus> {
    let model = input::model(&args.model)?;
    let text = input::text(&args.model)?;
    let file = ModelFile {
        path: &args.model,
        text: &text,
    };
    let options = options(&model, args)?;
    // Each by itself: a copy counts for nothing else.
    let logs = unfolded(&[LogRequest::whole(folder)])?;
    let keys: Vec<OutcomeKey> = logs
        .iter()
        .map(|log| OutcomeKey::of(log, &file, &options))
        .collect::<Result<_>>()?;
    let into = args.each.output.as_deref().unwrap_or(Path::new("."));
    std::fs::create_dir_all(into).map_err(|error| Error::file(into, "write", error))?;
    let shard = args.each.shard.unwrap_or(Shard::WHOLE);
    let path = into.join(format!("shard-{}-of-{}.jsonl", shard.index, shard.of));
    let there = outcomes_in(into)?;
    let is_done = |key: &OutcomeKey| there.iter().any(|outcome| outcome.key == *key);
    let own = (0..logs.len()).filter(|index| shard.holds(*index));
    let left: Vec<usize> = own
        .clone()
        .filter(|index| !is_done(&keys[*index]))
        .collect();
    let count = own.count();
    if left.len() < count {
        let done = count - left.len();
        console.say(&format!("{done} of {count} logs are done already"));
    }
    let work = Work {
        model: &model,
        file,
        options: &options,
        logs: &logs,
        keys: &keys,
    };
    work.append(&left, &path, count, console)?;
    if shard != Shard::WHOLE {
        let shown = path.display().to_string();
        let data = json!({ "complete": true, "file": shown, "logs": count });
        console.result(&data, || {
            format!("{shown}: {count} logs, all of shard {shard}")
        })?;
        return Ok(ExitStatus::Done);
    }
    let all = outcomes_in(into)?;
    let found = keys
        .iter()
        .filter_map(|key| all.iter().find(|o| o.key == *key));
    finished(
        &model,
        &found.cloned().collect::<Vec<_>>(),
        into,
        args,
        console,
    )
}

/// What is the same for every log, and the logs.
struct Work<'a> {
    model: &'a Model,
    file: ModelFile<'a>,
    options: &'a DiagnoseOptions,
    logs: &'a [LogRequest],
    keys: &'a [OutcomeKey],
}

impl Work<'_> {
    /// Diagnoses the logs `left`, of `count` in all, and appends what they say.
    fn append(&self, left: &[usize], path: &Path, count: usize, console: &Console) -> Result<()> {
        if left.is_empty() {
            return Ok(());
        }
        let mut outcomes = OutcomeFile::open(path)?;
        let bar = console.bar(count as u64);
        for (done, &index) in left.iter().enumerate() {
            bar.set_position((count - left.len() + done) as u64);
            bar.set_message(self.logs[index].name());
            let log = (&self.logs[index], self.keys[index].clone());
            let outcome = LogOutcome::of(self.model, self.file, log, self.options, &|_| {});
            outcomes.append(&outcome)?;
        }
        Ok(())
    }
}

/// Writes table and page, prints the table. What is there already with the same content stays.
fn finished(
    model: &Model,
    outcomes: &[LogOutcome],
    into: &Path,
    args: &DiagnoseArgs,
    console: &Console,
) -> Result<ExitStatus> {
    for (name, text) in [
        ("logs.csv", outcomes_csv(outcomes)),
        ("logs.html", outcomes_html(&model.name, outcomes)),
    ] {
        let file = into.join(name);
        if std::fs::read(&file).is_ok_and(|there| there == text.as_bytes()) {
            continue;
        }
        write_new(&file, &text, args.page.is_forced())?;
    }
    let data = json!({ "complete": true, "outcomes": outcomes });
    console.result(&data, || outcomes_text(outcomes))?;
    if !console.json {
        console.say(&format!("{}: logs.csv, logs.html", into.display()));
    }
    Ok(ExitStatus::answer(
        outcomes.iter().any(LogOutcome::is_usable),
    ))
}
