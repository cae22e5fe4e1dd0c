//! Recorders killed at any moment: what is left of their files.

use handstand::link::record::read;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::time::Duration;

/// What became of the files.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    /// Recorders killed.
    pub kills: usize,
    /// Files that could not be read, and why.
    pub unreadable: Vec<String>,
    /// Files that ended in the middle of something, which was dropped.
    pub torn: usize,
    /// The most that was lost of a file, s.
    pub worst_lost_s: f64,
    /// Samples that were read.
    pub samples: usize,
}

/// Kills `kills` recorders, CSV and MCAP in turns, `at_once` at a time, each at a random moment of
/// its first 3 s.
///
/// # Errors
/// The program cannot be run.
pub fn kill_recorders(
    program: &Path,
    kills: usize,
    at_once: usize,
    seed: u64,
    told: impl Fn(usize) + Sync,
) -> Result<Tally, String> {
    let tally = Mutex::new(Tally::default());
    let failure = Mutex::new(None);
    std::thread::scope(|scope| {
        for worker in 0..at_once {
            let (tally, failure, told) = (&tally, &failure, &told);
            scope.spawn(move || {
                let own = (worker..kills).step_by(at_once);
                if let Err(why) = worker_kills(program, own, seed, tally, told)
                    && let Ok(mut failure) = failure.lock()
                {
                    *failure = Some(why);
                }
            });
        }
    });
    match failure.into_inner() {
        Ok(Some(why)) => Err(why),
        _ => tally.into_inner().map_err(|error| error.to_string()),
    }
}

/// A child that does not outlive its owner.
struct Owned(Child);

impl Drop for Owned {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn worker_kills(
    program: &Path,
    kills: impl Iterator<Item = usize>,
    seed: u64,
    tally: &Mutex<Tally>,
    told: &(impl Fn(usize) + Sync),
) -> Result<(), String> {
    let words = ["virtual", "--pty", "--quiet", "ids=1,delay=0"];
    let mut robot = spawn(program, &words, Stdio::piped())?;
    let mut port = String::new();
    let stdout = robot.0.stdout.take().ok_or("no stdout")?;
    let read = BufReader::new(stdout).read_line(&mut port);
    read.map_err(|error| error.to_string())?;
    for kill in kills {
        let mut dice = ChaCha8Rng::seed_from_u64(seed << 32 | kill as u64);
        let alive_s = dice.random_range(0.05..3.0);
        let ending = ["csv", "mcap"][kill % 2];
        let outcome = one(program, port.trim(), ending, alive_s)?;
        let Ok(mut tally) = tally.lock() else {
            return Ok(());
        };
        tally.kills += 1;
        match outcome {
            Ok(left) => {
                tally.torn += usize::from(left.torn);
                tally.samples += left.samples;
                tally.worst_lost_s = tally.worst_lost_s.max(left.lost_s);
            }
            Err(why) => tally.unreadable.push(why),
        }
        told(tally.kills);
    }
    Ok(())
}

/// What a killed recorder left.
struct Left {
    samples: usize,
    lost_s: f64,
    torn: bool,
}

fn one(
    program: &Path,
    port: &str,
    ending: &str,
    alive_s: f64,
) -> Result<Result<Left, String>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let file = folder.path().join("r").with_extension(ending);
    let tap = folder.path().join("tap.txt");
    let words = [
        "record",
        &file.to_string_lossy(),
        "--tap",
        &tap.to_string_lossy(),
    ]
    .map(str::to_string);
    let line = ["--port", port, "--baud", "1000000", "--ids", "1", "--quiet"].map(str::to_string);
    let words = [&words[..], &line].concat();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let recorder = started(program, &words, &file)?;
    std::thread::sleep(Duration::from_secs_f64(alive_s));
    // SIGKILL: it cannot be caught.
    drop(recorder);
    let tapped = std::fs::read_to_string(&tap).map_err(|error| error.to_string())?;
    Ok(read(&file)
        .map_err(|error| format!("{ending} killed after {alive_s:.3} s: {error}"))
        .map(|recording| Left {
            samples: recording.samples.len(),
            lost_s: lost_s(&tapped, recording.samples.len()),
            torn: recording.torn,
        }))
}

/// A recorder that has begun. On a busy machine a servo may not answer in time, and it gives up
/// before: then another one.
fn started(program: &Path, words: &[&str], file: &Path) -> Result<Owned, String> {
    const TRIES: usize = 10;
    for _ in 0..TRIES {
        let mut recorder = spawn(program, words, Stdio::null())?;
        while matches!(recorder.0.try_wait(), Ok(None)) {
            if file.exists() {
                return Ok(recorder);
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        // What it tapped so far would be in its successor's way.
        let tap = file.with_file_name("tap.txt");
        std::fs::remove_file(tap).map_err(|error| error.to_string())?;
    }
    Err(format!("{TRIES} recordings did not begin"))
}

/// Time that the samples span which were taken and are not in the file: the tap writes down each
/// exchange at once.
fn lost_s(tapped: &str, kept: usize) -> f64 {
    // READ of 8 bytes from 36, a round of one servo, which counts once it is answered.
    const ROUND: &str = "> ff ff 01 04 02 24 08";
    let lines: Vec<&str> = tapped.lines().collect();
    let answered = lines
        .windows(2)
        .filter(|pair| pair[0].contains(ROUND) && pair[1].contains(" < "));
    let time = |pair: &[&str]| pair[0].split(' ').next()?.parse::<f64>().ok();
    let rounds: Vec<f64> = answered.filter_map(time).collect();
    match (rounds.get(kept), rounds.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}

fn spawn(program: &Path, words: &[&str], stdout: Stdio) -> Result<Owned, String> {
    let mut command = Command::new(program);
    command.args(words).stdout(stdout).stderr(Stdio::null());
    let child = command.spawn();
    child
        .map(Owned)
        .map_err(|error| format!("{} cannot be run: {error}", program.display()))
}
