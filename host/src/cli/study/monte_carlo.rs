//! `handstand study monte-carlo STUDY.toml -o FOLDER [--shard I/N]`: simulates robots drawn from
//! the uncertain quantities.
//!
//! Every finished chunk of runs is on disk before the next is counted: killed at any time, the same
//! command goes on where it was. The rows are the same for any number of threads and shards. A
//! whole study ends in `runs.csv`, `summary.json` and `stabilised.svg`; a shard leaves its journal
//! for `handstand study merge`.
//!
//! `--json` prints `complete` with the `summary`; for a shard `complete`, `journal`, `chunks`.

use super::super::{Outcome, talk::Talk};
use handstand::study::{
    CHUNK, Designed, FORMAT, Header, Journal, Shard, Study, chunk_rows, chunks, columns, merge,
};
use handstand::{Error, Result};
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::json;
use std::path::PathBuf;
use std::sync::mpsc;

/// Simulate robots drawn from the uncertain quantities.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Study file
    study: PathBuf,
    /// Folder for the journal, and for table, summary and plot
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
    /// Only this share of the runs: `2/5` is the second of five
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Runs of the whole study, instead of the file's
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    runs: Option<u64>,
    /// Seed, instead of the file's
    #[arg(long)]
    seed: Option<u64>,
    /// Replace table, summary and plot
    #[arg(long)]
    force: bool,
}

/// Runs what is not done yet.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let mut study = Study::load(&args.study)?;
    if let Some(runs) = args.runs {
        study.judging.runs = usize::try_from(runs).unwrap_or(usize::MAX);
    }
    study.judging.seed = args.seed.unwrap_or(study.judging.seed);
    let designed = study.case.designed()?;
    // What would stop every run stops before the first.
    study.case.closed_loop()?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let header = Header {
        handstand_study: FORMAT,
        fingerprint: study.fingerprint(),
        runs: study.judging.runs,
        chunk: CHUNK,
        columns: columns(&study),
    };
    super::write::folder(&args.output)?;
    let name = format!("shard-{}-of-{}.journal", shard.index, shard.of);
    let path = args.output.join(name);
    let mut journal = Journal::open(&path, &header)?;
    if journal.torn_bytes > 0 {
        let torn = journal.torn_bytes;
        talk.say(&format!(
            "{}: cut off {torn} bytes of a torn chunk",
            path.display()
        ));
    }
    let own: Vec<usize> = (0..chunks(&study))
        .filter(|&chunk| shard.holds(chunk))
        .collect();
    let left: Vec<usize> = own
        .iter()
        .copied()
        .filter(|chunk| !journal.done.contains(chunk))
        .collect();
    if left.len() < own.len() {
        let done = own.len() - left.len();
        talk.say(&format!("{done} of {} chunks are done already", own.len()));
    }
    let bar = talk.bar();
    bar.set_length(own.len() as u64);
    bar.set_position((own.len() - left.len()) as u64);
    bar.set_message(format!("chunks of {CHUNK} runs"));
    fill(&mut journal, &study, &designed, &left, &bar)?;
    bar.finish_and_clear();
    if shard != Shard::WHOLE {
        let chunks = own.len();
        if talk.json {
            let path = path.display().to_string();
            talk.data(&json!({ "complete": true, "journal": path, "chunks": chunks }))?;
        } else {
            talk.print(&format!(
                "{}: {chunks} chunks, all of shard {shard}",
                path.display()
            ))?;
        }
        return Ok(Outcome::Done);
    }
    drop(journal);
    match merge(&[path])? {
        Ok(merged) => super::write::finished(&merged, &args.output, args.force, talk)?,
        // Somebody has cut the journal meanwhile.
        Err(missing) => {
            super::merge::lacking(&missing, talk)?;
            return Ok(Outcome::Refused);
        }
    }
    Ok(Outcome::Done)
}

/// Computes chunks on all cores; this thread alone writes them, as they come.
fn fill(
    journal: &mut Journal,
    study: &Study,
    designed: &Designed,
    left: &[usize],
    bar: &ProgressBar,
) -> Result<()> {
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        let computing = scope.spawn(move || {
            left.par_iter().try_for_each_with(send, |send, &chunk| {
                let rows = chunk_rows(study, designed, chunk)?;
                // Nobody listens any more after a write has failed.
                send.send((chunk, rows))
                    .map_err(|_| Error::usage("writing has stopped", "see the error before"))
            })
        });
        // Taken by value: once this loop ends early, the computing stops.
        let written = receive.into_iter().try_for_each(|(chunk, rows)| {
            journal.add(chunk, &rows)?;
            bar.inc(1);
            Ok(())
        });
        let computed = match computing.join() {
            Ok(computed) => computed,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        written.and(computed)
    })
}
