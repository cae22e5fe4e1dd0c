use super::*;
use crate::challenge::{Bench, Motions, bench};
use crate::diagnose::evaluator::Reach;
use crate::diagnose::pipeline::FinishedSearch;
use crate::diagnose::progress::{Course, Round};
use crate::diagnose::{DiagnoseOptions, Verdict, diagnose};
use crate::fitting::{Candidate, Fit, Horizon, fit_start_states};
use crate::log::{LogRequest, read};
use crate::model::Model;
use crate::motion::Motion;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) const REACH: Reach = Reach::Promising;

/// The model of a virtual arm that hides effects, and its motions to fit and held out.
pub(in crate::diagnose) fn arm(
    seed: u64,
    kinds: &[&'static str],
) -> (Model, Vec<Motion>, Vec<Motion>) {
    recorded(&bench(Motions::Arm, seed, kinds).unwrap())
}

/// The model of a bench, and its motions to fit and held out.
pub(in crate::diagnose) fn recorded(bench: &Bench) -> (Model, Vec<Motion>, Vec<Motion>) {
    let folder = tempfile::tempdir().unwrap();
    let model = Model::parse(&bench.model_toml, Path::new("nominal.toml")).unwrap();
    let (mut training, mut held_out) = (Vec::new(), Vec::new());
    for log in &bench.logs {
        let file = folder.path().join(&log.name);
        std::fs::write(&file, &log.csv).unwrap();
        let motions = read(&[LogRequest::whole(file)], &model.log).unwrap();
        let of = if log.held_out {
            &mut held_out
        } else {
            &mut training
        };
        of.extend(motions);
    }
    (model, training, held_out)
}

/// The same arm ready to be searched, nothing fitted but its own model.
pub(in crate::diagnose) fn evaluator(seed: u64, kinds: &[&'static str]) -> Evaluator<'static> {
    evaluator_of(&bench(Motions::Arm, seed, kinds).unwrap())
}

pub(in crate::diagnose) fn evaluator_of(bench: &Bench) -> Evaluator<'static> {
    let (model, training, held_out) = recorded(bench);
    let options = DiagnoseOptions::default();
    Evaluator::new(&model, training, held_out, &options, REACH, silent())
}

/// A course that nobody hears of.
pub(in crate::diagnose) fn silent() -> Course<'static> {
    Course::new(&DiagnoseOptions::default(), &|_| ())
}

/// Without friction this arm whirls; beside viscous friction, Stribeck's at its lowest speed, which
/// is Coulomb friction, promises most.
#[test]
fn a_plainer_effect_takes_the_place_of_one_on_its_bound() {
    let (model, training, held_out) = arm(2, &["coulomb", "viscous"]);
    let options = DiagnoseOptions::default();
    let diagnosis = diagnose(&model, training, held_out, &options, &|_| ());
    let named = diagnosis.effects.iter().map(|effect| effect.kind.as_str());
    let mut named: Vec<&str> = named.collect();
    named.sort_unstable();
    assert_eq!(diagnosis.verdict, Verdict::Named);
    assert_eq!(named, ["coulomb", "viscous"]);
}

pub(in crate::diagnose) fn candidate(evaluator: &Evaluator, id: &str) -> Candidate {
    let mut known = evaluator.candidates.iter();
    *known.find(|c| c.effect.info().id == id).unwrap()
}

/// These effects on top of the model, from these values, fitted on the windows of the search.
pub(in crate::diagnose) fn fitted<const N: usize>(
    evaluator: &Evaluator,
    kinds: &[&str; N],
    values: [&[f64]; N],
) -> Hypothesis {
    let finish = FitOptions::iterations(FINISH);
    let pairs = kinds.iter().zip(values);
    pairs.fold(evaluator.base.clone(), |set, (kind, values)| {
        set.with(
            candidate(evaluator, kind),
            values,
            &evaluator.search,
            finish,
        )
    })
}

/// All effects of the library but these.
pub(in crate::diagnose) fn all_but(kinds: &[&str]) -> Vec<String> {
    let ids = crate::effects::EFFECTS.iter().map(|e| e.info().id);
    ids.filter(|id| !kinds.contains(id))
        .map(String::from)
        .collect()
}

/// An arm that lacks viscous friction: a placebo gains next to nothing beside it, and as much as
/// an effect that it does not have.
#[test]
fn a_placebo_is_evaluated_beside_what_gains_as_little() {
    let evaluator = evaluator(1, &["viscous"]);
    let (search, finish) = (&evaluator.search, FitOptions::iterations(FINISH));
    let alone = |id, values: &[f64]| {
        let candidate = candidate(&evaluator, id);
        evaluator.base.with(candidate, values, search, finish)
    };
    assert_eq!(evaluator.try_placebos(&alone("viscous", &[0.02])).len(), 0);
    let placebos = evaluator.try_placebos(&alone("cogging", &[0.001, 10.0, 0.0]));
    assert_eq!(placebos.len(), 1);
    assert!(placebos[0].evaluation.is_some());
}

/// An arm that lacks viscous friction, and a pair that was found without ever trying it alone.
#[test]
fn an_effect_that_is_not_needed_leaves_the_set() {
    let evaluator = evaluator(1, &["viscous"]);
    let (search, finish) = (&evaluator.search, FitOptions::iterations(FINISH));
    let viscous = candidate(&evaluator, "viscous");
    let needed = evaluator.base.with(viscous, &[0.02], search, finish);
    let idle = candidate(&evaluator, "cogging");
    let mut pair = needed.with(idle, &[0.001, 10.0, 0.0], search, finish);
    evaluator.evaluate(&mut pair);

    assert_eq!(pair.names(), ["viscous@1", "cogging@1"]);
    assert!(!pair.evaluation.as_ref().unwrap().significant);
    let mut found = SearchResults {
        sizes: vec![Vec::new(), vec![pair]],
        ..SearchResults::default()
    };
    evaluator.prune(&mut found);
    assert_eq!(found.best.unwrap().names(), ["viscous@1"]);
    let alone: Vec<_> = found.sizes[0].iter().map(Hypothesis::names).collect();
    assert_eq!(alone, [["cogging@1"], ["viscous@1"]]);
}

/// Short windows may hide what longer ones that it was searched on show.
#[test]
fn a_set_that_loses_the_windows_of_the_search_is_not_the_end() {
    let evaluator = evaluator(1, &[]);
    let mut set = evaluator.base.clone();
    assert!(evaluator.is_explained_by(&set));
    set.search_mean = 2.0;
    assert!(!evaluator.is_explained_by(&set));
}

/// An arm that its owner believes ten times too light: over a second its swing is lost.
#[test]
fn the_search_takes_windows_that_the_model_follows() {
    let (model, training, _) = arm(1, &[]);
    let options = DiagnoseOptions::default();
    let horizon = |model: &Model, reach| {
        let all = training.clone();
        let evaluator = Evaluator::new(model, all, Vec::new(), &options, reach, silent());
        evaluator.search_horizon
    };
    assert_eq!(horizon(&model, Reach::Everything), Horizon::Seconds(1.0));
    let mut light = model.clone();
    light.links[0].mass_kg *= 0.1;
    light.links[0].inertia_kg_m2 *= 0.1;
    assert_eq!(horizon(&light, Reach::Promising), Horizon::Seconds(1.0));
    // Forty samples at least.
    let shorter = horizon(&light, Reach::Everything).seconds().unwrap();
    assert!((0.39..0.41).contains(&shorter), "{shorter}");
}

/// Where the model loses the windows others are searched next; where its motions show nothing,
/// others are learned from first.
#[test]
fn one_search_tries_all_where_its_windows_are_followed_and_show_something() {
    let (model, training, held_out) = arm(1, &["cogging"]);
    let round = |mass: f64, motions: &[Motion]| {
        let mut model = model.clone();
        model.links[0].mass_kg *= mass;
        model.links[0].inertia_kg_m2 *= mass;
        let (all, options) = (motions.to_vec(), DiagnoseOptions::default());
        let (others, reach) = (held_out.clone(), Reach::Promising);
        let evaluator = Evaluator::new(&model, all, others, &options, reach, silent());
        evaluator.round()
    };
    assert_eq!(round(1.0, &training), Round::Only);
    assert_eq!(round(0.1, &training), Round::First);
    let (_, nominal, _) = arm(1, &[]);
    assert_eq!(round(1.0, &nominal), Round::First);
}

/// An arm whose gap is open where most short windows begin: what its readings say there is not
/// where its joint is, which costs every set as much. Over whole motions the right set is told.
#[test]
fn a_set_that_follows_longer_runs_is_judged_over_them() {
    let kinds = ["backlash", "encoder_scale", "encoder_zero"];
    let mut evaluator = evaluator(7, &kinds);
    evaluator.recut(Horizon::Seconds(0.25));
    let mut set = fitted(&evaluator, &kinds, [&[0.08], &[0.96], &[-0.03]]);
    evaluator.evaluate(&mut set);
    assert!(!evaluator.at_noise_floor(&set));
    let mut sizes = [vec![set]];
    evaluator.settle_horizon(&mut sizes);
    assert_eq!(evaluator.horizon, Horizon::Whole);
    assert!(evaluator.at_noise_floor(&sizes[0][0]));

    evaluator.recut(Horizon::Seconds(0.25));
    evaluator.horizon_given = true;
    sizes[0][0].evaluation = None;
    evaluator.evaluate(&mut sizes[0][0]);
    evaluator.settle_horizon(&mut sizes);
    assert_eq!(evaluator.horizon, Horizon::Seconds(0.25));
}

/// An arm that sticks, with one of three effects that it lacks: long runs are lost.
#[test]
fn single_effects_are_judged_over_the_runs_that_show_most() {
    let mut sticking = evaluator(6, &["coulomb", "dead_zone", "stribeck"]);
    let alone = fitted(&sticking, &["coulomb"], [&[0.05]]);
    sticking.horizon_given = true;
    sticking.choose_horizon(std::slice::from_ref(&alone));
    assert_eq!(sticking.horizon, Horizon::Whole);
    sticking.horizon_given = false;
    sticking.choose_horizon(&[alone]);
    let chosen = sticking.horizon.seconds();
    assert!(chosen.is_some_and(|seconds| seconds <= 1.0), "{chosen:?}");
    let mut swinging = evaluator(1, &["viscous"]);
    let friction = fitted(&swinging, &["viscous"], [&[0.02]]);
    swinging.choose_horizon(&[friction]);
    assert_eq!(swinging.horizon, Horizon::Whole);
}

/// An arm on a soft, tilted base, its centre of mass beside the link: two of the three follow the
/// motion held out no better than one.
#[test]
fn a_third_effect_is_sought_where_the_second_gains_nothing() {
    let kinds = ["base_compliance", "base_tilt", "com_angle"];
    let (model, training, held_out) = arm(13, &kinds);
    let options = DiagnoseOptions {
        without: all_but(&kinds),
        ..DiagnoseOptions::default()
    };
    let diagnosis = diagnose(&model, training, held_out, &options, &|_| ());
    let named = diagnosis.effects.iter().map(|effect| effect.kind.as_str());
    let mut named: Vec<&str> = named.collect();
    named.sort_unstable();
    assert_eq!(diagnosis.verdict, Verdict::Named);
    assert_eq!(named, kinds);
}

/// An arm that saturates long before it reaches the angle from which friction grows no more: span
/// and ends of that friction are known together only, and yet it is there.
#[test]
fn an_effect_whose_shape_nothing_tells_counts() {
    let kinds = ["torque_saturation", "position_friction", "encoder_scale"];
    let evaluator = evaluator(10, &kinds);
    let mut set = fitted(&evaluator, &kinds, [&[0.36], &[0.1, 0.003, 2.0], &[1.05]]);
    evaluator.evaluate(&mut set);
    let fit = &set.evaluation.as_ref().unwrap().fit;
    let (intervals, _) = crate::fitting::intervals(fit, &evaluator.training).unwrap();
    let below = &intervals[fit.free.len() - 4];
    assert!((below.low..below.high).contains(&0.0), "{below:?}");
    assert!(evaluator.improves(&evaluator.base, &set));
}

/// An arm with a dead zone, fitted from a width at which a few commands too many are swallowed:
/// what follows the slope of the error stays there.
#[test]
fn a_fit_goes_down_the_stairs_of_a_law_that_jumps() {
    let kinds = ["coulomb", "dead_zone", "stribeck"];
    let evaluator = evaluator(6, &kinds);
    let set = fitted(
        &evaluator,
        &kinds,
        [&[0.0576], &[0.0545, 0.0], &[0.048, 0.43]],
    );
    let (stuck, data) = (&set.search, &evaluator.search);
    let finish = FitOptions::iterations(FINISH);
    let lower = crate::fitting::descend_jumping_law(stuck.clone(), data, finish);
    assert!(lower.residuals.cost() < 0.95 * stuck.residuals.cost());
}

/// What lies too far above others and comes no closer is not fitted to the end; a wrong value is.
#[test]
fn a_hopeless_value_is_given_up_and_a_wrong_one_is_not() {
    let tried = |kinds: &[&'static str]| {
        let evaluator = evaluator(1, kinds);
        let tried = |least: Option<f64>| {
            let values = evaluator.try_values_refitted(least);
            let simulations: usize = values.iter().map(|v| v.search.simulations).sum();
            (simulations, values[0].search_mean)
        };
        [tried(None), tried(Some(1.0))]
    };
    let [to_the_end, given_up] = tried(&["viscous"]);
    assert!(given_up.0 < to_the_end.0, "{given_up:?} {to_the_end:?}");
    let [to_the_end, found] = tried(&["torque_scale"]);
    assert!(found.1 < 2.0, "{found:?}");
    assert!(found.1 < 1.01 * to_the_end.1, "{found:?} {to_the_end:?}");
}

/// An arm that whirls where its drive is believed to know no limit of speed: refitted, its model
/// damps what it loses within a second.
#[test]
fn a_second_search_explains_what_the_first_does_not() {
    let kinds = ["fold_back", "rate_bias", "speed_limit"];
    let (model, training, held_out) = arm(110, &kinds);
    let options = DiagnoseOptions {
        without: all_but(&kinds),
        ..DiagnoseOptions::default()
    };
    let first = {
        let (training, held_out) = (training.clone(), held_out.clone());
        let evaluator = Evaluator::new(&model, training, held_out, &options, REACH, silent());
        FinishedSearch::by(evaluator)
    };
    assert!(!first.is_explained());
    let again = AtomicBool::new(false);
    let diagnosis = diagnose(&model, training, held_out, &options, &|progress| {
        again.fetch_or(progress.what.starts_with("second"), Ordering::Relaxed);
    });
    assert!(again.into_inner());
    assert_eq!(diagnosis.effects.len(), 3);
    let error = &diagnosis.error;
    assert!(error.after_rad < 1.1 * error.floor_rad, "{error:?}");
}

/// An arm at rest whose logs begin with the first command: the late drive was told nothing before.
#[test]
fn a_delay_is_found_where_logs_begin_with_the_first_command() {
    let evaluator = evaluator(11, &["delay"]);
    let mut set = fitted(&evaluator, &["delay"], [&[0.03]]);
    evaluator.evaluate(&mut set);
    assert!(evaluator.at_noise_floor(&set));
}

/// One motion tells the level at which a servo folds back between the two commands nearest to it;
/// others have commands in between.
#[test]
fn held_out_motions_tell_places_on_one_stair_apart() {
    let (model, others, one) = arm(17, &["fold_back"]);
    let options = DiagnoseOptions::default();
    let evaluator = Evaluator::new(&model, one, others, &options, REACH, silent());
    let mut set = fitted(&evaluator, &["fold_back"], [&[0.4833, 0.1109, 0.303]]);
    evaluator.evaluate(&mut set);
    let mut fit = set.fit().clone();
    let level = fit.free.iter().find(|path| path.key() == "level").copied();
    assert!(level.unwrap().set(&mut fit.model, 0.1124));
    let others = evaluator.held_out.as_ref().unwrap();
    let left = |fit: &Fit| fit_start_states(&fit.model, others).residuals.mean_square();
    assert!(left(&fit) > 10.0, "{}", left(&fit));
    set.judge(fit, &evaluator.training, Some(others));
    assert!(left(set.fit()) < 1.1, "{}", left(set.fit()));
}
