//! The recipes of `docs/recipes` and the docs, run as they are: shards by Slurm and GNU parallel.
//!
//! Without these programs (Slurm needs root too) they are skipped, and stderr says so even when
//! tests pass.

use crate::common::Bench;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

const STUDY: &str = "
[runs]
count = 1000
length_s = 0.2

[[uncertain]]
what = \"mass\"
size = 0.1
";

/// Longer than any of these takes.
const PATIENCE: Duration = Duration::from_secs(120);

fn recipe(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../docs/recipes")
        .join(name)
}

fn found(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path)
        .chain(["/usr/sbin".into(), "/sbin".into()])
        .any(|folder| folder.join(name).is_file())
}

/// Past the harness, which keeps the words of tests that pass.
fn skip(what: &str, why: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED: {what}: {why}");
}

fn done(mut command: Command) -> Output {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {output:?}");
    output
}

/// A bench with a study and the table that its shards must add up to.
fn bench() -> (Bench, String) {
    let bench = Bench::new();
    bench.put("study.toml", STUDY);
    let ran = bench.run("study monte-carlo study.toml -o whole");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let table = bench.get("whole/runs.csv");
    (bench, table)
}

#[test]
fn gnu_parallel_runs_the_shards() {
    if !found("parallel") {
        return skip("the recipe for GNU parallel", "no `parallel` on the path");
    }
    let (bench, table) = bench();
    let mut command = Command::new(recipe("parallel.sh"));
    command
        .args(["study.toml", "shards", "3", "--will-cite"])
        .current_dir(bench.path(""))
        .env("HANDSTAND", env!("CARGO_BIN_EXE_handstand"));
    done(command);
    assert!(bench.path("shards/shard-3-of-3.journal").exists());
    assert_eq!(bench.get("shards/runs.csv"), table);
}

#[test]
fn gnu_parallel_diagnoses_every_log() {
    if !found("parallel") {
        return skip("the recipe for GNU parallel", "no `parallel` on the path");
    }
    let bench = Bench::new();
    std::fs::create_dir(bench.path("logs")).unwrap();
    for name in ["a.csv", "b.csv"] {
        bench.put(&format!("logs/{name}"), bench.get(name));
    }
    let mut command = Command::new(recipe("each.sh"));
    command
        .args(["model.toml", "logs", "result", "2", "--will-cite"])
        .current_dir(bench.path(""))
        .env("HANDSTAND", env!("CARGO_BIN_EXE_handstand"));
    done(command);
    assert!(bench.path("result/shard-2-of-2.jsonl").exists());
    assert!(bench.get("result/logs.csv").contains("b.csv,"));
}

/// Slurm's daemons, stopped at the end whatever happens.
struct Slurm(PathBuf);

impl Slurm {
    fn start(folder: PathBuf) -> Slurm {
        let slurm = Slurm(folder);
        let port = 20_000 + std::process::id() % 20_000;
        let mut command = slurm.command(recipe("slurm-one-box.sh").to_str().unwrap());
        command.arg("start").arg(&slurm.0);
        command.env("SLURM_ONE_BOX_PORT", port.to_string());
        done(command);
        slurm
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        let path = std::env::var("PATH").unwrap_or_default();
        command
            .env("PATH", format!("{path}:/usr/sbin:/sbin"))
            .env("SLURM_CONF", self.0.join("slurm.conf"));
        command
    }

    /// Submits a job by a command that prints its number, and waits until it has ended.
    fn finish(&self, submit: Command) {
        let said = done(submit).stdout;
        let job = String::from_utf8(said).unwrap().trim().to_string();
        let begun = Instant::now();
        loop {
            let mut squeue = self.command("squeue");
            squeue.args(["--noheader", "--jobs", &job]);
            if done(squeue).stdout.trim_ascii().is_empty() {
                break;
            }
            assert!(begun.elapsed() < PATIENCE, "job {job} does not end");
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        let mut command = self.command(recipe("slurm-one-box.sh").to_str().unwrap());
        let _ = command.arg("stop").arg(&self.0).output();
    }
}

#[test]
fn a_slurm_job_array_runs_the_shards() {
    let id = done({
        let mut id = Command::new("id");
        id.arg("-u");
        id
    });
    if !found("slurmctld") || !found("slurmd") {
        return skip("the recipe for Slurm", "no `slurmctld` and `slurmd` here");
    }
    if id.stdout.trim_ascii() != b"0" {
        return skip(
            "the recipe for Slurm",
            "only root may start Slurm's daemons",
        );
    }
    // Both under the same daemons: two of them would want the same port.
    let folder = tempfile::tempdir().unwrap();
    let slurm = Slurm::start(folder.path().join("slurm"));
    slurm_runs_a_study(&slurm);
    slurm_diagnoses_every_log(&slurm);
}

fn slurm_runs_a_study(slurm: &Slurm) {
    let (bench, table) = bench();
    let mut sbatch = slurm.command("sbatch");
    sbatch
        .args(["--parsable", "--array=1-3"])
        .arg("--export=ALL,STUDY=study.toml,FOLDER=shards")
        .arg(recipe("study.sbatch"))
        .current_dir(bench.path(""))
        .env("HANDSTAND", env!("CARGO_BIN_EXE_handstand"));
    slurm.finish(sbatch);
    let merged = bench.run("study merge shards -o merged");
    assert_eq!(
        merged.code,
        Some(0),
        "{merged:?}\n{}",
        said_by_tasks(&bench)
    );
    assert!(bench.path("shards/shard-2-of-3.journal").exists());
    assert_eq!(bench.get("merged/runs.csv"), table);
}

/// The line of the docs, as it stands there.
fn slurm_diagnoses_every_log(slurm: &Slurm) {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("logs")).unwrap();
    bench.put("arm.toml", bench.get("model.toml"));
    for name in ["a.csv", "b.csv"] {
        bench.put(&format!("logs/{name}"), bench.get(name));
    }
    let docs = include_str!("../../../docs/diagnosis.md").lines();
    let lines: Vec<&str> = docs.filter(|line| line.starts_with("sbatch ")).collect();
    let [line] = lines[..] else {
        panic!("one line for Slurm: {lines:?}")
    };
    let program = Path::new(env!("CARGO_BIN_EXE_handstand"));
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!(
        "{}:{path}:/usr/sbin:/sbin",
        program.parent().unwrap().display()
    );
    let mut shell = slurm.command("sh");
    shell
        .args(["-c", &format!("{line} --parsable")])
        .current_dir(bench.path(""))
        .env("PATH", path);
    slurm.finish(shell);
    let merged = bench.run("diagnose arm.toml --each logs -o result");
    assert_eq!(
        merged.code,
        Some(0),
        "{merged:?}\n{}",
        said_by_tasks(&bench)
    );
    for log in ["a.csv", "b.csv"] {
        assert!(
            bench.get("result/logs.csv").contains(&format!("{log},")),
            "{log}"
        );
    }
    // Tasks 1 and 2 had a log each; whoever puts them together diagnoses none again.
    for shard in ["shard-1-of-8.jsonl", "shard-2-of-8.jsonl"] {
        assert_eq!(
            bench.get(&format!("result/{shard}")).lines().count(),
            1,
            "{shard}"
        );
    }
}

/// What the tasks wrote, for failures.
fn said_by_tasks(bench: &Bench) -> String {
    let files = std::fs::read_dir(bench.path("")).unwrap().flatten();
    let logs = files.filter(|file| file.file_name().to_string_lossy().starts_with("slurm-"));
    let texts = logs.filter_map(|file| std::fs::read_to_string(file.path()).ok());
    texts.collect()
}
