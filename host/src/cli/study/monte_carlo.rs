//! `handstand study monte-carlo STUDY.toml -o FOLDER [--shard I/N]`: simulates robots drawn from
//! the uncertain quantities.
//!
//! Every finished chunk of runs is on disk before the next is counted: killed at any time, the same
//! command goes on where it was. The rows are the same for any number of threads and shards. A
//! whole study ends in `runs.csv`, `summary.json` and `stabilised.svg`; a shard leaves its journal
//! for `handstand study merge`.
//!
//! `--json` prints `complete` with the `summary`; for a shard `complete`, `journal`, `chunks`.

use crate::cli::gains_choice::GainsChoice;
use crate::cli::{Console, ExitStatus};
use handstand::Result;
use handstand::study::{CHUNK, Header, Journal, Shard, Study, fill};
use serde_json::json;
use std::path::PathBuf;

/// Simulate robots drawn from the uncertain quantities.
#[derive(Debug, clap::Args)]
pub struct MonteCarloArgs {
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
    #[command(flatten)]
    gains: GainsChoice,
    /// Replace table, summary and plot
    #[arg(long)]
    force: bool,
}

/// Runs what is not done yet.
pub fn run(args: &MonteCarloArgs, console: &Console) -> Result<ExitStatus> {
    let mut study = Study::load(&args.study)?;
    if let Some(runs) = args.runs {
        study.judging.runs = usize::try_from(runs).unwrap_or(usize::MAX);
    }
    study.judging.seed = args.seed.unwrap_or(study.judging.seed);
    args.gains.put_into(&mut study.case)?;
    let designed = study.case.designed()?;
    // What would stop every run stops before the first.
    study.case.closed_loop()?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let header = Header::of(&study);
    super::write::folder(&args.output)?;
    let name = format!("shard-{}-of-{}.journal", shard.index, shard.of);
    let path = args.output.join(name);
    let shown = path.display();
    let mut journal = Journal::open(&path, &header)?;
    if journal.torn_bytes > 0 {
        let torn = journal.torn_bytes;
        console.say(&format!("{shown}: cut off {torn} bytes of a torn chunk"));
    }
    let own = (0..header.chunks()).filter(|&chunk| shard.holds(chunk));
    let (done, left): (Vec<usize>, Vec<usize>) = own.partition(|own| journal.done.contains(own));
    let chunks = done.len() + left.len();
    if !done.is_empty() {
        console.say(&format!(
            "{} of {chunks} chunks are done already",
            done.len()
        ));
    }
    let bar = console.bar(chunks as u64);
    bar.set_position(done.len() as u64);
    bar.set_message(format!("chunks of {CHUNK} runs"));
    fill(&mut journal, &study, &designed, &left, || bar.inc(1))?;
    drop(bar);
    if shard == Shard::WHOLE {
        // Its lock goes with it; the merge reads the file.
        drop(journal);
        return super::merge::merged(&[path], &args.output, args.force, console);
    }
    let journal = path.display().to_string();
    let data = json!({ "complete": true, "journal": journal, "chunks": chunks });
    console.result(&data, || {
        format!("{journal}: {chunks} chunks, all of shard {shard}")
    })?;
    Ok(ExitStatus::Done)
}
