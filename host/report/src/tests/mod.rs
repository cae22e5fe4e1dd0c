//! The page as a whole.

pub(super) mod sample;

use super::*;
use crate::diagnose::Verdict;
use crate::model::JointNames;
use proptest::prelude::*;

#[test]
fn one_document_that_needs_nothing_else() {
    let page = html(&sample::report());
    assert!(page.starts_with("<!DOCTYPE html>"));
    assert_eq!(page.matches("<html").count(), 1);
    for outside in [
        "http://", "https://", "src=", "<link", "<script ", "@import", "import ", "import(",
        "fetch(",
    ] {
        assert!(!page.contains(outside), "{outside}");
    }
    // One script, within the page; what it refers to is the page's own.
    assert_eq!(page.matches("<script>").count(), 1);
    assert_eq!(page.matches("url(").count(), page.matches("url(#").count());
    assert!(page.len() < 600_000, "{} bytes", page.len());
}

#[test]
fn what_files_say_is_text_not_markup() {
    let mut report = sample::report();
    report.title = "<script>alert(1)</script>".into();
    report.comparisons[0].traces[0].motion = "\"><b onclick=x>".into();
    let page = html(&report);
    assert!(!page.contains("<script>alert"));
    assert!(!page.contains("<b onclick"));
}

/// Anchors of the sections there are.
fn sections(report: &Report) -> Vec<String> {
    let page = html(report);
    let ids = page.split("<section id=\"").skip(1);
    ids.filter_map(|rest| Some(rest.split_once('"')?.0.to_string()))
        .collect()
}

#[test]
fn sections_are_there_when_their_data_are() {
    let full = sample::report();
    let all = "traces failures fall candidates effects parameters remains provenance terms";
    assert_eq!(sections(&full).join(" "), all);

    let mut compared = full.clone();
    compared.diagnosis = None;
    assert_eq!(
        sections(&compared).join(" "),
        "traces failures fall remains provenance terms"
    );

    let mut looped = compared.clone();
    looped.comparisons[1].closed_loop = Some(sample::closed_loop(8.0));
    assert_eq!(
        sections(&looped).join(" "),
        "traces closed-loop failures fall remains provenance terms"
    );
    let page = html(&looped);
    for part in ["joint 1: limit cycle, mrad", "1 of 1, after 1.50 s"] {
        assert!(page.contains(part), "the page lacks {part}");
    }

    let mut bare = full.clone();
    bare.comparisons.clear();
    let diagnosis = bare.diagnosis.as_mut().unwrap();
    diagnosis.effects.clear();
    diagnosis.base.clear();
    diagnosis.collinear.clear();
    diagnosis.ruled_out.clear();
    diagnosis.alternatives.clear();
    diagnosis.motions.clear();
    diagnosis.residual_structure = None;
    assert_eq!(sections(&bare).join(" "), "provenance terms");
}

#[test]
fn each_verdict_has_its_words_and_colour() {
    let mut report = sample::report();
    for (verdict, word) in [
        (Verdict::Nominal, "nominal"),
        (Verdict::Adequate, "adequate"),
        (Verdict::WrongValue, "wrong_value"),
        (Verdict::Named, "named"),
        (Verdict::Ambiguous, "ambiguous"),
        (Verdict::Unexplained, "unexplained"),
        (Verdict::Unfit, "unfit"),
    ] {
        report.diagnosis.as_mut().unwrap().verdict = verdict;
        let page = html(&report);
        assert!(
            page.contains(&format!("<header class=\"verdict-{word}\">")),
            "{word}"
        );
        assert_eq!(json(&report)["diagnosis"]["verdict"], word);
    }
}

#[test]
fn rivals_are_named_in_the_headline() {
    let mut report = sample::report();
    report.diagnosis.as_mut().unwrap().verdict = Verdict::Ambiguous;
    let rivals = "Either Coulomb friction at joint 1 and Backlash at joint 1 are missing, or Dead \
                  zone at joint 1 is missing.";
    assert!(html(&report).contains(rivals));
}

#[test]
fn what_does_as_well_is_not_ruled_out() {
    let page = html(&sample::report());
    let (_, tried) = page.split_once("<h3>As good, not needed</h3>").unwrap();
    let (as_good, worse) = tried.split_once("<h3>Ruled out</h3>").unwrap();
    assert!(as_good.contains("stribeck@1") && !worse.contains("stribeck@1"));
    assert!(worse.contains("viscous@1") && !as_good.contains("viscous@1"));

    let mut report = sample::report();
    let tried = &mut report.diagnosis.as_mut().unwrap().ruled_out;
    tried.retain(|tried| tried.as_good);
    assert!(!html(&report).contains("<h3>Ruled out</h3>"));
}

#[test]
fn a_long_table_shows_its_first_rows() {
    let mut report = sample::report();
    let tried = &mut report.diagnosis.as_mut().unwrap().ruled_out;
    let worse = tried.iter().find(|tried| !tried.as_good).unwrap().clone();
    tried.extend(std::iter::repeat_n(worse, 20));
    let page = html(&report);
    let (_, folded) = page.split_once("<summary>15 more</summary>").unwrap();
    let (rows, _) = folded.split_once("</details>").unwrap();
    assert_eq!(rows.matches("<tr").count(), 1 + 15);
}

#[test]
fn a_model_alone_has_a_page() {
    let mut report = sample::report();
    report.diagnosis = None;
    report.comparisons.truncate(1);
    let page = html(&report);
    assert!(page.contains("ideal.toml misses the measurement by typically 41.2 mrad."));
    assert!(!page.contains("show-after\""));
}

/// Writes the sample to look at: `REPORT_SAMPLE=report.html cargo test -p handstand --lib report`.
#[test]
fn sample_for_the_eye() {
    if let Some(path) = std::env::var_os("REPORT_SAMPLE") {
        std::fs::write(path, html(&sample::report())).unwrap();
    }
}

#[test]
fn text_of_a_named_effect() {
    insta::assert_snapshot!(diagnosis_text(&sample::diagnosis(), &JointNames::default()), @r"
    Verdict: named. The model lacks Coulomb friction at joint 1 and Backlash at joint 1.
    Joint 1 resists with about 0.082 N m at every speed, which the model leaves out.
    With it the error on held-out motions falls from 41.2 to 6.31 mrad; the floor is 5.1 mrad.

    Missing effects
    ────────────────────────────────────────────────────────────────────────────────────────
     Effect             Joint   Parameter    Value      95 % interval   Unit
    ════════════════════════════════════════════════════════════════════════════════════════
     Coulomb friction       1   torque_nm   0.0821   0.0794 to 0.0851   N m
     Backlash               1   gap_rad     0.0120   0.0090 to 0.0152   rad    on its bound
    ────────────────────────────────────────────────────────────────────────────────────────

    Wrong values
      - motor.torque_nm: 1.20 -> 1.470 N m (1.440 to 1.500)

    Error: 41.2 mrad as given, 30.7 mrad refitted -> 6.31 mrad; floor 5.10 (5.00 to 5.20) mrad.
    Searched in windows of 1 s; RMS over whole motions, on motions that took no part in the fit.
    So the error falls by 85 % (95 % interval of the reduction: 81 % to 88 %).

    As good
      - Dead zone at joint 1: 6.50 mrad; width = 0.031 (0.020 to 0.050)

    ──────────────────────────────────────────────────────────────────────────────────────────
     As good, not needed      Fitted, mrad   Held out, mrad     BIC   Why
    ══════════════════════════════════════════════════════════════════════════════════════════
     coulomb@1 + stribeck@1           5.90             6.33   -9870   gains nothing over
                                                                      Coulomb friction alone
    ──────────────────────────────────────────────────────────────────────────────────────────

    ──────────────────────────────────────────────────────────────────────────────────────────
     Ruled out        Fitted, mrad   Held out, mrad     BIC   Why
    ══════════════════════════════════════════════════════════════════════════════════════════
     viscous@1                17.2             19.8   -2140   leaves the jump at reversals
     cable_spring@1           33.0                –    -310   gains little on the motions of
                                                              the fit
     base_tilt                37.9                –    4.20   gains no more than chance would
    ──────────────────────────────────────────────────────────────────────────────────────────

    Residual structure: a free form could still gain 7.0 % (at least 0 %) of the squared error above the floor; it leans on speed of joint 1.

    Next
      - Add the effect: handstand add coulomb@1 --torque_nm 0.0821.

    Warnings
      - backlash@1.gap_rad lies on its bound.
    ");
}

#[test]
fn text_of_unfit_data() {
    let mut diagnosis = sample::diagnosis();
    diagnosis.verdict = Verdict::Unfit;
    diagnosis.error.before_rad = f64::NAN;
    diagnosis.effects.clear();
    diagnosis.wrong_values.clear();
    diagnosis.alternatives.clear();
    diagnosis.ruled_out.clear();
    diagnosis.residual_structure = None;
    diagnosis.summary = vec!["The joint never moved.".into()];
    diagnosis.warnings.clear();
    diagnosis.next = vec!["Record a motion of at least 0.5 rad.".into()];
    insta::assert_snapshot!(diagnosis_text(&diagnosis, &JointNames::default()), @r"
    Verdict: unfit. These data can't answer the question.
    The joint never moved.

    Next
      - Record a motion of at least 0.5 rad.
    ");
}

/// Every number a double can be, with the awkward ones often.
fn odd() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -1.0..1.0,
        Just(0.0),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(f64::MAX),
        Just(1e12),
        Just(f64::MIN_POSITIVE),
    ]
}

/// Writes `values` over every number of the report, in turn.
fn spoil(report: &mut Report, values: &[f64], times: Vec<f64>, angles: Vec<f64>) {
    let mut values = values.iter().copied().cycle();
    let mut next = |place: &mut f64| *place = values.next().unwrap_or_default();
    for comparison in &mut report.comparisons {
        for signal in &mut comparison.signals {
            next(&mut signal.rms);
            next(&mut signal.floor);
            next(&mut signal.fit_percent);
        }
        for failure in &mut comparison.failures {
            next(&mut failure.error_share);
            next(&mut failure.sample_share);
        }
        for trace in &mut comparison.traces {
            trace.time_s.clone_from(&times);
            trace.measured.clone_from(&angles);
            trace.predicted = angles.iter().rev().copied().collect();
        }
    }
    let diagnosis = report.diagnosis.as_mut().unwrap();
    let effects = diagnosis
        .effects
        .iter_mut()
        .flat_map(|effect| &mut effect.parameters);
    for fitted in effects.chain(&mut diagnosis.base) {
        next(&mut fitted.value);
        next(&mut fitted.low);
        next(&mut fitted.high);
    }
    for tried in &mut diagnosis.ruled_out {
        next(&mut tried.training_error_rad);
        next(&mut tried.bic_change);
        if let Some(error) = &mut tried.held_out_error_rad {
            next(error);
        }
    }
    for motion in &mut diagnosis.motions {
        next(&mut motion.before_rad);
        next(&mut motion.after_rad);
    }
    next(&mut diagnosis.error.before_rad);
    next(&mut diagnosis.error.after_rad);
    for end in diagnosis.error.reduction.iter_mut().flatten() {
        next(end);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn nothing_odd_is_drawn(
        values in proptest::collection::vec(odd(), 1..40),
        times in proptest::collection::vec(odd(), 0..6),
        angles in proptest::collection::vec(odd(), 0..6),
    ) {
        let mut report = sample::report();
        spoil(&mut report, &values, times, angles);
        let page = html(&report);
        for drawing in page.split("<svg").skip(1).filter_map(|rest| rest.split("</svg>").next()) {
            for bad in ["NaN", "inf\"", "inf ", "width=\"-", "height=\"-"] {
                prop_assert!(!drawing.contains(bad), "{}", drawing);
            }
        }
        prop_assert!(!page.contains("NaN"));
        let text = diagnosis_text(report.diagnosis.as_ref().unwrap(), &JointNames::default());
        prop_assert!(!text.contains("NaN"));
        json(&report);
    }
}
