//! A search that is ended: by who waits, by the clock, by what the user tolerates.

use super::tests::{all_but, arm};
use crate::diagnose::pipeline::diagnose_on;
use crate::diagnose::progress::Course;
use crate::diagnose::{DiagnoseOptions, Diagnosis, SearchEnded, Verdict, diagnose};
use crate::fitting::{Halt, StopSwitch};
use crate::model::Model;
use crate::motion::{Motion, Split};
use std::sync::Mutex;

/// An arm that lacks friction and a delay, which is left out of the library.
fn outside() -> (DiagnoseOptions, [Vec<Motion>; 2], Model) {
    let (model, training, held_out) = arm(3, &["viscous", "delay"]);
    let options = DiagnoseOptions {
        without: all_but(&["viscous", "coulomb", "torque_offset"]),
        ..DiagnoseOptions::default()
    };
    (options, [training, held_out], model)
}

/// What is diagnosed where the best so far is accepted at one of the runs, what was told on the
/// way, and how many runs there were.
fn accepted_at(at_run: usize) -> (Diagnosis, Vec<crate::fitting::Progress>, usize) {
    let (options, motions, model) = outside();
    let switch = options.stop.clone();
    let halt = Halt::seen(&options.stop, move |run| {
        if run == at_run {
            switch.accept();
        }
    });
    let told = Mutex::new(Vec::new());
    let heard = |progress| told.lock().unwrap().push(progress);
    let course = Course::halted_by(halt, &options, &heard);
    let [training, held_out] = motions;
    let split = Split { training, held_out };
    let (diagnosis, _) = diagnose_on(&course, &model, &split, true, &options);
    let runs = course.halt.runs();
    (diagnosis, told.into_inner().unwrap(), runs)
}

/// The search is ended where it has looked at some sets of two.
#[test]
fn a_search_that_is_ended_tells_its_best_and_claims_less() {
    let (whole, told, runs) = accepted_at(usize::MAX);
    assert_eq!(whole.search_ended, SearchEnded::Complete);
    assert_eq!(whole.left_out, Vec::<String>::new());
    assert_eq!(whole.verdict, Verdict::Unexplained);
    let falls = told.windows(2).filter(|pair| pair[1].done < pair[0].done);
    assert_eq!(falls.count(), 0);
    assert_eq!(told.last().unwrap().done, told.last().unwrap().total);
    let last = told.last().unwrap().best.clone().unwrap();
    assert!(last.error_rad < last.before_rad, "{last}");

    let (cut, told, cut_runs) = accepted_at(runs / 3);
    assert!(cut_runs < runs, "{cut_runs} {runs}");
    assert_eq!(cut.search_ended, SearchEnded::Stopped);
    let is_second = |left_out: &String| left_out.ends_with("the second search");
    assert!(cut.left_out.iter().any(is_second), "{:?}", cut.left_out);
    assert!(cut.left_out[0].starts_with("part of"), "{:?}", cut.left_out);
    assert_eq!(cut.verdict, Verdict::Unexplained);
    assert!(cut.error.after_rad < cut.error.before_rad);
    assert!(
        cut.summary[1].starts_with("You ended the search early."),
        "{:?}",
        cut.summary
    );
    assert_eq!(told.last().unwrap().done, told.last().unwrap().total);
    // At the first run nothing was tried: the model as it is, and no claim that it is right.
    let (none, _, _) = accepted_at(1);
    assert_eq!(none.verdict, Verdict::Unexplained);
    assert!(none.effects.is_empty());
}

/// The limit is over before the search begins: what is said is said of the model as it is.
#[test]
fn a_limit_of_time_ends_the_search() {
    let (options, [training, held_out], model) = outside();
    let options = DiagnoseOptions {
        within_s: Some(1e-3),
        ..options
    };
    let diagnosis = diagnose(&model, training, held_out, &options, &|_| ());
    assert_eq!(diagnosis.search_ended, SearchEnded::Time);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
    assert!(diagnosis.effects.is_empty());
    assert!(diagnosis.left_out.len() > 3, "{:?}", diagnosis.left_out);
}

/// An explanation that leaves no more than the user tolerates ends the search before pairs.
#[test]
fn an_explanation_within_the_tolerance_ends_the_search() {
    let found = |tolerance_rad: Option<f64>| {
        let (options, [training, held_out], model) = outside();
        let options = DiagnoseOptions {
            tolerance_rad,
            ..options
        };
        diagnose(&model, training, held_out, &options, &|_| ())
    };
    let whole = found(None);
    assert!(whole.ruled_out.iter().any(|row| row.set.len() > 1));
    // What one effect alone brings, and a little more.
    let of_one = whole.ruled_out.iter().filter(|row| row.set.len() == 1);
    let least = of_one.filter_map(|row| row.held_out_error_rad);
    let least = least.fold(whole.error.before_rad, f64::min);
    let tolerance_rad = 1.2 * least;
    assert!(tolerance_rad < whole.error.before_rad);
    let tolerated = found(Some(tolerance_rad));
    assert_eq!(tolerated.search_ended, SearchEnded::Tolerance);
    assert!(tolerated.ruled_out.iter().all(|row| row.set.len() == 1));
    assert!(tolerated.error.after_rad <= tolerance_rad);
    // The model as given: nothing is searched for.
    let given = found(Some(2.0 * whole.error.before_rad));
    assert_eq!(given.search_ended, SearchEnded::Tolerance);
    assert!(given.ruled_out.is_empty());
}

/// Without a limit nothing depends on how many threads there are.
#[test]
fn a_search_says_the_same_on_one_thread_and_on_two() {
    let said = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let (options, [training, held_out], model) = outside();
        let diagnosed = || diagnose(&model, training, held_out, &options, &|_| ());
        format!("{:?}", pool.build().unwrap().install(diagnosed))
    };
    assert_eq!(said(1), said(2));
}

/// Nothing of an abandoned diagnosis is judged.
#[test]
fn an_abandoned_diagnosis_unwinds() {
    let (options, motions, model) = outside();
    let options = DiagnoseOptions {
        stop: StopSwitch::default(),
        ..options
    };
    options.stop.abandon();
    let course = Course::new(&options, &|_| ());
    let [training, held_out] = motions;
    let split = Split { training, held_out };
    let diagnosed = || diagnose_on(&course, &model, &split, true, &options);
    let thrown = std::panic::catch_unwind(std::panic::AssertUnwindSafe(diagnosed)).unwrap_err();
    assert!(thrown.is::<crate::fitting::Abandoned>());
}
