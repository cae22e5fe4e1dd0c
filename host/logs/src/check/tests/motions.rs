//! What a motion shows: directions, scales, rest, wraps, held and single readings.

use super::*;

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
    let step = found(&text(&coarse), &servo());
    let step = step.iter().find(|finding| finding.kind == "step").unwrap();
    let line = "write resolution_rad = 1.000e-2 beside \"q\"";
    assert!(step.remedy.starts_with(line), "{step:?}");
    let mut declared = servo();
    first(&mut declared.log.joints[0].position).resolution = Some(0.0015);
    finds(
        &found(&text(&coarse), &declared),
        Severity::Warn,
        "1.500e-3 is declared",
    );
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
        log.position_rad[0][k] = if lost(k) && k > 0 {
            log.position_rad[0][k - 1]
        } else {
            step * (angle / step).round()
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
