//! The check finds each fault, and warns of nothing in a good log.

use super::*;
use crate::log::tests::fixture::{columns, first, model, motion, position_drive};
use crate::log::{Motion, to_csv};
use crate::model::{Drive, LogColumns, Unit};

fn found(text: &str, model: &Model) -> Vec<LogFinding> {
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
    assert_eq!(refused.len(), 21);
    assert!(refused[20].what.contains("more like it"));
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
fn sign_scale_and_zero_of_a_followed_goal_are_found() {
    let changed = |change: fn(f64) -> f64| {
        let mut motion = good();
        motion.position_rad[0]
            .iter_mut()
            .for_each(|q| *q = change(*q));
        found(&text(&motion), &servo())
    };
    finds(&changed(|q| -q), Severity::Warn, "q runs against u");
    finds(
        &changed(f64::to_degrees),
        Severity::Warn,
        "degrees on one side",
    );
    finds(
        &changed(f64::to_degrees),
        Severity::Warn,
        "degrees declared as rad?",
    );
    finds(
        &changed(f64::to_radians),
        Severity::Warn,
        "degrees on one side",
    );
    finds(&changed(|q| 2.0 * q), Severity::Warn, "2.0");
    finds(&changed(|q| q + 0.2), Severity::Warn, "a wrong zero?");
}

#[test]
fn standing_still_and_small_motions_are_found() {
    let mut stuck = good();
    let (begin, end) = (100, 350);
    stuck.position_rad[0][begin..end].fill(0.1);
    finds(
        &found(&text(&stuck), &servo()),
        Severity::Warn,
        "q does not change for 2.5 s",
    );
    let mut small = good();
    small.position_rad[0].iter_mut().for_each(|q| *q *= 0.1);
    small.input[0].as_mut().unwrap().fill(0.0);
    let findings = found(&text(&small), &servo());
    finds(&findings, Severity::Warn, "travels only 0.140 rad");
    finds(&findings, Severity::Warn, "u never changes");
    let findings = found(&text(&motion("short", 100)), &servo());
    finds(
        &findings,
        Severity::Warn,
        "shows 1 reversal: friction and backlash can't be told apart",
    );
}

#[test]
fn wraps_stops_and_steps_are_found() {
    let mut wrapped = good();
    wrapped.position_rad[0]
        .iter_mut()
        .skip(300)
        .for_each(|q| *q += std::f64::consts::TAU);
    finds(
        &found(&text(&wrapped), &servo()),
        Severity::Refuse,
        "a whole turn",
    );
    let mut stopped = good();
    stopped.position_rad[0]
        .iter_mut()
        .for_each(|q| *q = q.min(0.5));
    finds(
        &found(&text(&stopped), &servo()),
        Severity::Warn,
        "q sits at its extreme, 0.5000 rad",
    );
    let mut coarse = good();
    coarse.position_rad[0]
        .iter_mut()
        .for_each(|q| *q = (*q / 0.01).round() * 0.01);
    finds(
        &found(&text(&coarse), &servo()),
        Severity::Note,
        "steps of 1.000e-2 rad",
    );
    let mut declared = servo();
    first(&mut declared.log.joints[0].position).resolution = Some(0.0015);
    finds(
        &found(&text(&coarse), &declared),
        Severity::Warn,
        "1.500e-3 is declared",
    );
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

/// An arm of 1/s^2 gravity and damping under a slow and a fast torque, from hanging.
fn pushed() -> Motion {
    let mut motion = motion("pushed", 4000);
    let (mut q, mut v) = (0.3_f64, 0.0);
    let step_s = 0.001;
    let torque = |t: f64| 20.0 * (1.3 * t).sin() + 15.0 * (4.1 * t).sin();
    for i in 0..4000 {
        motion.position_rad[0][i] = (q / 0.0015).round() * 0.0015;
        let u = torque(motion.time_s[i]);
        motion.input[0].as_mut().unwrap()[i] = u;
        for _ in 0..10 {
            v += step_s * (u - 50.0 * q.sin() - 0.8 * v);
            q += step_s * v;
        }
    }
    motion
}

fn bench() -> Model {
    let log = LogColumns { ..columns() };
    model(Drive::Torque, log)
}

#[test]
fn torque_and_gravity_show_their_direction() {
    let text = text(&pushed());
    for finding in found(&text, &bench()) {
        assert_eq!(finding.severity, Severity::Note, "{finding}");
    }
    let mut reversed = bench();
    first(&mut reversed.log.joints[0].input).reversed = true;
    finds(
        &found(&text, &reversed),
        Severity::Warn,
        "pushes the joint the wrong way",
    );
    let mut zero = bench();
    zero.angle_zero = crate::model::AngleZero::Horizontal;
    finds(&found(&text, &zero), Severity::Warn, "gravity pulls");
}

/// A motion at 100 Hz that swings by 0.6 rad, read in steps of 1.5 mrad, with the reading of the
/// row before wherever `lost` says so.
fn swing(lost: impl Fn(usize) -> bool) -> Motion {
    let mut log = motion("swing", 600);
    let step = 1.5e-3;
    for k in 0..log.len() {
        let angle = 0.6 * (6.0 * log.time_s[k]).sin();
        log.position_rad[0][k] = match lost(k) && k > 0 {
            true => log.position_rad[0][k - 1],
            false => step * (angle / step).round(),
        };
    }
    log
}

#[test]
fn frames_that_were_lost_and_a_slow_sensor_are_told() {
    let held = |lost: &dyn Fn(usize) -> bool| {
        let mut findings = found(&text(&swing(lost)), &servo());
        findings.retain(|finding| finding.kind == "held");
        findings
    };
    assert_eq!(held(&|_| false), []);
    // One in fifty, two on end at times; then every second row.
    let lost = held(&|k| k % 50 == 0 || k % 150 == 1);
    finds(&lost, Severity::Warn, "frames were lost");
    let slow = held(&|k| k % 2 == 1);
    finds(&slow, Severity::Warn, "slower than the log");
    assert_eq!(held(&|k| k == 100 || k == 300), []);
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

#[test]
fn single_rows_far_off_are_warned_of_with_their_lines() {
    let mut spoiled = good();
    spoiled.position_rad[0][300] = 87.0;
    spoiled.position_rad[0][420] = -3.0;
    let findings = found(&text(&spoiled), &servo());
    let outliers: Vec<&LogFinding> = findings.iter().filter(|f| f.kind == "outlier").collect();
    let lines = outliers.iter().map(|f| f.place.as_ref().unwrap().line);
    assert_eq!(lines.collect::<Vec<_>>(), [Some(302), Some(422)]);
    let what = "q is 87.0000 rad in this row alone, ";
    assert!(outliers[0].what.starts_with(what), "{}", outliers[0].what);
    // A knock turns the joint round within a sample, but no faster than it came.
    let mut knocked = good();
    let swing = &mut knocked.position_rad[0];
    swing.iter_mut().for_each(|q| *q = q.abs());
    let findings = found(&text(&knocked), &servo());
    assert!(
        !findings.iter().any(|f| f.kind == "outlier"),
        "{findings:#?}"
    );
}

#[test]
fn both_extremes_of_a_column_are_one_finding() {
    let mut stopped = good();
    stopped.position_rad[0]
        .iter_mut()
        .for_each(|q| *q = q.clamp(-0.5, 0.5));
    let findings = found(&text(&stopped), &servo());
    let extremes: Vec<&LogFinding> = findings.iter().filter(|f| f.kind == "extreme").collect();
    assert_eq!(extremes.len(), 1, "{extremes:#?}");
    let what = "q sits at its extremes, -0.5000 rad and 0.5000 rad, for ";
    assert!(extremes[0].what.starts_with(what), "{}", extremes[0].what);
}

#[test]
fn an_angle_that_wraps_is_one_finding_with_a_count() {
    let mut turning = good();
    let angle = |k: usize| (0.1 * k as f64).rem_euclid(std::f64::consts::TAU);
    turning.position_rad[0] = (0..600).map(angle).collect();
    let findings = found(&text(&turning), &servo());
    let wraps: Vec<&LogFinding> = findings.iter().filter(|f| f.kind == "wrap").collect();
    assert_eq!(wraps.len(), 1, "{wraps:#?}");
    assert_eq!(wraps[0].what, "q jumps by a whole turn; and 8 more like it");
    assert_eq!(wraps[0].place.as_ref().unwrap().line, Some(65));
}
