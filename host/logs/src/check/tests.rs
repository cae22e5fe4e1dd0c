//! The check finds each fault, and warns of nothing in a good log.

mod motions;
mod short;
mod wrong_cells;

use super::*;
use crate::model::{Drive, LogColumns, Unit};
use crate::motion::Motion;
use crate::to_csv;
use handstand_model::fixture::{columns, first, model, motion, position_drive};

fn found(text: &(impl AsRef<[u8]> + ?Sized), model: &Model) -> Vec<LogFinding> {
    let log = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    std::fs::write(log.path(), text).unwrap();
    check(&[LogRequest::whole(log.path())], model).unwrap()
}

fn servo() -> Model {
    model(position_drive(), columns())
}

fn good() -> Motion {
    motion("good", 600)
}

fn text(motion: &Motion) -> String {
    to_csv(motion, &columns(), &[])
}

#[track_caller]
fn finds(findings: &[LogFinding], severity: Severity, what: &str) {
    let all: Vec<String> = findings.iter().map(ToString::to_string).collect();
    let hit = findings
        .iter()
        .any(|f| f.severity == severity && f.what.contains(what));
    assert!(hit, "{what} is not among {all:#?}");
}

#[test]
fn a_good_log_has_no_warning() {
    for finding in found(&text(&good()), &servo()) {
        assert_eq!(finding.severity, Severity::Note, "{finding}");
    }
}

#[test]
fn broken_rows_are_all_told_with_their_places() {
    let mut lines: Vec<String> = text(&good()).lines().map(str::to_string).collect();
    lines[100] = "0.99,inf,0".into();
    lines[200] = "1.99,0".into();
    lines[300] = lines[299].clone();
    lines[400] = "0.5,0,0".into();
    let findings = found(&lines.join("\n"), &servo());
    let at = |line: usize, column: usize, what: &str| {
        let hit = findings.iter().any(|f| {
            f.severity == Severity::Refuse
                && f.place.as_ref().map(|p| (p.line, p.column)) == Some((Some(line), Some(column)))
                && f.what.contains(what)
        });
        assert!(hit, "{line}:{column} {what}: {findings:#?}");
    };
    at(101, 2, "not finite");
    at(201, 3, "2 fields");
    at(301, 1, "does not increase: 2.98 s after 2.98 s");
    at(401, 1, "does not increase: 0.5 s after 3.98 s");
}

#[test]
fn many_alike_are_counted() {
    let broken = text(&good()).replace(",0.", ",x");
    let findings = found(&broken, &servo());
    let refused: Vec<_> = findings
        .iter()
        .filter(|f| f.what.contains("not a number"))
        .collect();
    // One for each column.
    assert_eq!(refused.len(), 2, "{refused:#?}");
    let counted = |f: &&LogFinding| f.what.contains(" more like it, in lines ");
    assert!(refused.iter().all(counted), "{refused:#?}");
}

#[test]
fn restarts_and_doubled_times_are_one_finding_each() {
    let text = |time: fn(usize) -> f64| {
        let row = |k: usize| format!("{},{},0\n", time(k), 0.5 * (0.1 * k as f64).sin());
        format!("t_s,q,u\n{}", (0..400).map(row).collect::<String>())
    };
    let refused = |text: &str| {
        let all = found(text, &servo()).into_iter();
        let refused: Vec<_> = all.filter(|f| f.severity == Severity::Refuse).collect();
        assert_eq!(refused.len(), 1, "{refused:#?}");
        (refused[0].what.clone(), refused[0].remedy.clone())
    };
    let (what, remedy) = refused(&text(|k| 0.01 * (k % 40) as f64));
    assert!(what.ends_with("; and 8 more like it"), "{what}");
    assert!(remedy.contains("segment column"), "{remedy}");
    // Differences across a restart say nothing of signs.
    let swing = |k: usize| (0.05 * k as f64).cos();
    let row = |k: usize| {
        format!(
            "{},{:.5},{:.5}\n",
            0.01 * (k % 63) as f64,
            swing(k),
            swing(k + 4)
        )
    };
    let restarts: String = (0..630).map(row).collect();
    let findings = found(&format!("t_s,q,u\n{restarts}"), &servo());
    assert!(
        !findings.iter().any(|f| f.kind == "relation"),
        "{findings:#?}"
    );
    // A clock coarser than the rows: each stamp stands there twice.
    let (what, remedy) = refused(&text(|k| 0.02 * (k / 2) as f64));
    assert!(what.ends_with("; and 199 more like it"), "{what}");
    assert!(
        remedy.contains("coarser") && !remedy.contains("segment"),
        "{remedy}"
    );
}

#[test]
fn a_missing_column_or_range_is_a_finding() {
    finds(
        &found("t_s,q\n0,1\n", &servo()),
        Severity::Refuse,
        "no column 'u'",
    );
    finds(
        &found("t_s,q,u\n0,1,1\n", &servo()),
        Severity::Refuse,
        "a motion of 1 rows",
    );
    finds(&found("t_s,q,u\n", &servo()), Severity::Refuse, "no sample");
    assert!(check(&[LogRequest::whole("no/such.csv")], &servo()).is_err());
}

#[test]
fn time_faults_are_found() {
    let mut gap = good();
    gap.time_s.iter_mut().skip(300).for_each(|t| *t += 1.0);
    let findings = found(&text(&gap), &servo());
    finds(&findings, Severity::Warn, "a gap of 1010.000 ms");
    assert_eq!(
        findings
            .iter()
            .find(|f| f.what.contains("gap"))
            .unwrap()
            .place
            .as_ref()
            .unwrap()
            .line,
        Some(302)
    );
    let mut splitting = servo();
    splitting.log.split_at_gap_s = Some(0.5);
    assert!(
        !found(&text(&gap), &splitting)
            .iter()
            .any(|f| f.what.contains("gap"))
    );

    let scaled = |factor: f64| {
        let mut motion = good();
        motion.time_s.iter_mut().for_each(|t| *t *= factor);
        found(&text(&motion), &servo())
    };
    finds(
        &scaled(1000.0),
        Severity::Warn,
        "milliseconds declared as seconds?",
    );
    finds(
        &scaled(1e-3),
        Severity::Warn,
        " us apart: no unit of time explains that; declared are seconds",
    );
    for (declared, spelt) in [
        ("ms", "milliseconds"),
        ("us", "microseconds"),
        ("ns", "nanoseconds"),
    ] {
        let mut declaring = servo();
        declaring.log.time.unit = Unit::named(declared, None).unwrap();
        let what = format!(" apart: seconds declared as {spelt}?");
        finds(&found(&text(&good()), &declaring), Severity::Warn, &what);
    }
    let mut jittery = good();
    let late = |(i, t): (usize, &mut f64)| *t += if i % 2 == 0 { 0.004 } else { 0.0 };
    jittery.time_s.iter_mut().enumerate().for_each(late);
    finds(&found(&text(&jittery), &servo()), Severity::Note, "jitters");
}

#[test]
fn what_is_kept_does_not_grow_with_the_log() {
    // 200,000 rows, every hundredth late, every thousandth broken: all a check holds is of fixed
    // size.
    let mut text = String::from("t_s,q,u\n");
    for i in 0..200_000 {
        let t = f64::from(i) * 0.001 + f64::from(i / 100) * 0.02;
        let q = if i % 1000 == 999 {
            f64::INFINITY
        } else {
            (t * 3.0).sin()
        };
        text += &format!("{t:.4},{q:.5},{:.5}\n", (t * 3.0).sin());
    }
    let findings = found(&text, &servo());
    assert!(findings.len() < 60, "{}", findings.len());
    finds(&findings, Severity::Warn, "shorter ones elsewhere");
    finds(&findings, Severity::Refuse, "more like it");
}

#[test]
fn a_column_that_the_reader_misses_is_refused() {
    let without = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut motion = good();
        change(motion.input[0].as_mut().unwrap());
        found(&text(&motion).replace("NaN", "nan"), &servo())
    };
    let never = without(&|input| input.fill(f64::NAN));
    finds(&never, Severity::Refuse, "u holds no value in ");
    // The reader begins with the first input.
    let late = without(&|input| input[..100].fill(f64::NAN));
    assert!(
        late.iter().all(|f| f.severity == Severity::Note),
        "{late:#?}"
    );

    let mut released = servo();
    released.log.torque_on = Some("on".into());
    let table = |on: fn(usize) -> u8, input: fn(usize) -> &'static str| {
        let row = |k: usize| {
            let q = 0.7 * (0.03 * k as f64).sin();
            format!("{},{q:.4},{},{}\n", 0.01 * k as f64, input(k), on(k))
        };
        format!("t_s,q,u,on\n{}", (0..400).map(row).collect::<String>())
    };
    let unknown = found(
        &table(|k| u8::from(k > 9), |k| if k > 20 { "0.1" } else { "" }),
        &released,
    );
    finds(&unknown, Severity::Refuse, "u holds no value in ");
    let idle = found(&table(|_| 0, |_| ""), &released);
    assert!(!idle.iter().any(|f| f.kind == "missing"), "{idle:#?}");
}

/// What is fitted together must be of one rig, and what is read is not refused here.
#[test]
fn logs_of_bam_are_checked_as_they_are_read() {
    let log = |kp: u32, begin_s: f64| {
        let entry = |i: u32| {
            let (time_s, goal) = (begin_s + 0.01 * f64::from(i), 0.1 * f64::from(i % 7));
            format!("{{\"timestamp\": {time_s}, \"position\": 0.5, \"goal_position\": {goal}}}")
        };
        let entries: Vec<String> = (0..40).map(entry).collect();
        let entries = entries.join(",");
        let log = tempfile::Builder::new().suffix(".json").tempfile().unwrap();
        std::fs::write(
            log.path(),
            format!("{{\"kp\": {kp}, \"entries\": [{entries}]}}"),
        )
        .unwrap();
        log
    };
    let (one, same, other) = (log(32, 0.0), log(32, 5.0), log(16, 9.0));
    let checked = |logs: [&tempfile::NamedTempFile; 2], model: &Model| {
        let requests = logs.map(|log| LogRequest::whole(log.path()));
        let is_read = crate::read(&requests, &model.log).is_ok();
        (check(&requests, model).unwrap(), is_read)
    };
    let refused = |findings: &[LogFinding]| {
        findings
            .iter()
            .any(|finding| finding.severity == Severity::Refuse)
    };
    let mut model = servo();
    let (findings, is_read) = checked([&one, &same], &model);
    assert_eq!((refused(&findings), is_read), (false, true), "{findings:?}");
    let (findings, is_read) = checked([&one, &other], &model);
    assert_eq!((refused(&findings), is_read), (true, false));
    finds(&findings, Severity::Refuse, "kp is 16, and 32 in");
    // A supply that a bench does not log is the model's own.
    model.log.supply = Some(model.log.time.clone());
    let (findings, is_read) = checked([&one, &same], &model);
    assert_eq!((refused(&findings), is_read), (false, true), "{findings:?}");
}
