//! A verdict with all that belongs to it: values, errors, rivals, and what was ruled out.

use super::block_errors::{BlockErrors, gain, paired, reduction};
use super::error_budget::error_budget;
use super::evaluator::Evaluator;
use super::explanation::{Explanation, VerdictEvidence};
use super::findings::{
    Alternative, Diagnosis, FittedEffect, MotionError, RuledOut, SearchEnded, Verdict, WrongValue,
};
use super::hypothesis::Hypothesis;
use super::judging::Judging;
use super::longer_runs::longer_runs;
use super::relative_scale;
use super::stability;
use super::values::{compared, contradicted};
use super::words;
use crate::fitting::{
    ErrorReduction, FitProblem, FittedValue, MotionWindow, fitted_values, locally_fitted_values,
};
use crate::model::{MeasuredSignal, ParameterPath};
use crate::output::number::{percent, short};

/// Correlation from which two values are hardly told apart.
const COLLINEAR: f64 = 0.95;
/// What is left out where intervals are taken from the derivatives alone.
const INTERVALS: &str = "intervals beyond the derivatives";

/// Draws the conclusion.
pub(super) fn conclude(evidence: &VerdictEvidence, judging: &mut Judging) -> Diagnosis {
    let rivals = evidence.rivals();
    let (chosen, evaluator) = (evidence.chosen(), evidence.evaluator);
    let (values, correlation) = judging
        .part(INTERVALS, 0.5, || {
            fitted_values(chosen.fit(), &evaluator.training)
        })
        .unwrap_or_else(|| locally_fitted_values(chosen.fit(), &evaluator.training));
    let alternatives = rivals.iter().map(|h| alternative(h, evidence, judging));
    let alternatives: Vec<Alternative> = alternatives.collect();
    let budget = judging.part("the error budget", 0.7, || error_budget(evidence));
    let step_s = chosen.fit().model.step_s;
    let (base, added) = values.split_at(values.len() - chosen.added_values());
    let mut collinear = Vec::new();
    // Of two that are known beforehand none has to be told by these motions.
    let free = &chosen.fit().free;
    let is_known = |place: usize| chosen.fit().model.uncertain(free[place]).is_some();
    for (a, value) in values.iter().enumerate().filter(|_| correlation.is_some()) {
        for (b, other) in values[..a].iter().enumerate() {
            let r = correlation.as_ref().map_or(0.0, |r| r[(a, b)]);
            if r.abs() > COLLINEAR && !(is_known(a) && is_known(b)) {
                collinear.push((other.path.clone(), value.path.clone(), r));
            }
        }
    }
    let mut diagnosis = Diagnosis {
        verdict: evidence.verdict(&rivals),
        effects: effects(chosen, added),
        wrong_values: wrong_values(evidence, base),
        error: error(evidence),
        budget: budget.unwrap_or_default(),
        alternatives,
        base: base.to_vec(),
        ruled_out: ruled_out(evidence, &rivals),
        residual_structure: evidence.residual_structure.clone(),
        motions: motions(evidence),
        folds: evidence.folds.clone(),
        collinear,
        summary: Vec::new(),
        next: Vec::new(),
        warnings: warnings(evidence, correlation.is_some(), judging),
        search_horizon_s: evaluator.search_horizon.seconds(),
        horizon_s: evaluator.horizon.seconds(),
        shorter_step_s: (step_s < evaluator.file_step_s).then_some(step_s),
        windows: windows(evaluator),
        search_ended: evidence.ended,
        left_out: evidence.left_out.clone(),
        shows_alone: evidence.shows_alone.clone(),
    };
    let scale = relative_scale::warning(&diagnosis, &evaluator.start, &evaluator.known);
    diagnosis.warnings.extend(scale);
    diagnosis.left_out.extend(judging.take_left_out());
    words::complete(&mut diagnosis);
    diagnosis
        .next
        .extend(state_uncertainty(&diagnosis, evaluator));
    // What decides is said at once.
    let at = diagnosis.summary.len().min(1);
    let decides = values_vary(evidence).into_iter().chain(ended(&diagnosis));
    diagnosis
        .summary
        .splice(at..at, decides.collect::<Vec<_>>());
    diagnosis
}

/// What to do where the file takes its values for exact, and no one thing explains the motions. Of
/// a robot in space so many values more would take hours.
fn state_uncertainty(diagnosis: &Diagnosis, evaluator: &Evaluator) -> Option<String> {
    let is_open = matches!(diagnosis.verdict, Verdict::Ambiguous | Verdict::Unexplained);
    let is_exact = evaluator.start.uncertain.is_empty() && evaluator.start.robot.is_none();
    let typical = evaluator.start.typically_uncertain();
    let is_told = |path: &ParameterPath| {
        evaluator.start.free.contains(path) || evaluator.known.contains(path)
    };
    let is_assumed = typical.iter().any(|value| !is_told(&value.path));
    (is_open && is_exact && is_assumed).then(|| {
        "The file takes masses, moments of inertia and motor figures for exact. Where they are \
         not, say so and try again: `[uncertainty]` and below it `typical = true` at its end."
            .to_string()
    })
}

/// That the search ended early, and what was left out.
fn ended(diagnosis: &Diagnosis) -> Option<String> {
    let why = match diagnosis.search_ended {
        SearchEnded::Tolerance => {
            return Some(
                "The search ended there: what is left is no more than the tolerance.".to_string(),
            );
        }
        SearchEnded::Stopped => "You ended the search early",
        SearchEnded::Time => "The search ended early, at its limit of time",
        SearchEnded::Complete if diagnosis.left_out.is_empty() => return None,
        SearchEnded::Complete => "The time was over before all was judged",
    };
    let left_out = if diagnosis.left_out.is_empty() {
        String::new()
    } else {
        format!(
            ". Not examined: {}. A longer search may say otherwise",
            diagnosis.left_out.join(", ")
        )
    };
    Some(format!("{why}{left_out}."))
}

/// That the motions ask for other values each, where they do.
fn values_vary(evidence: &VerdictEvidence) -> Option<String> {
    let share = percent(evidence.per_motion_reduction.unwrap_or(0.0));
    evidence.values_vary().then(|| {
        format!(
            "Values that fit one motion do not fit another: values of its own for each would \
             remove {share} of the squared error that is left."
        )
    })
}

fn error(evidence: &VerdictEvidence) -> ErrorReduction {
    let (given, chosen) = (&evidence.evaluator.given, evidence.chosen());
    let blocks = given.deciding().zip(chosen.deciding());
    ErrorReduction {
        quantity: MeasuredSignal::pooled(&evidence.evaluator.training.signals),
        before_rad: given.deciding_rms_rad(),
        refitted_rad: Some(evidence.evaluator.base.deciding_rms_rad()),
        after_rad: chosen.deciding_rms_rad(),
        floor_rad: evidence.evaluator.training.floor(),
        floor_interval_rad: evidence.evaluator.training.floor_interval(),
        held_out: evidence.evaluator.held_out.is_some(),
        reduction: blocks.map(|(before, after)| reduction(before, after, evidence.seed)),
    }
}

/// The values that are wrong: the one that explains all, or those that the refit contradicts; all
/// of them where only together they differ.
fn wrong_values(evidence: &VerdictEvidence, base: &[FittedValue]) -> Vec<WrongValue> {
    let given = &evidence.evaluator.start;
    let contradicted = contradicted(given, base);
    match evidence.explanation {
        Explanation::Given(_) => Vec::new(),
        Explanation::Value(_) => compared(given, base),
        Explanation::Refit(_) if contradicted.is_empty() => compared(given, base),
        _ => contradicted,
    }
}

/// How long the windows of all motions are.
fn windows(evaluator: &Evaluator) -> Vec<MotionWindow> {
    let data = [Some(&evaluator.training), evaluator.held_out.as_ref()];
    let data = data.into_iter().flatten();
    data.flat_map(|data| data.motion_windows(evaluator.horizon))
        .collect()
}

fn warnings(evidence: &VerdictEvidence, determined: bool, judging: &mut Judging) -> Vec<String> {
    let mut warnings = Vec::new();
    if !determined {
        warnings.push(
            "some fitted values have no effect on the residual: their intervals are unknown"
                .to_string(),
        );
    }
    if evidence.placebo_ranks() {
        warnings.push(
            "a placebo regressor gains as much as the best effect: nothing may be named"
                .to_string(),
        );
    }
    warnings.extend(stability::warning(&evidence.folds));
    let longer = judging.part("long runs", 1.0, || longer_runs(evidence));
    warnings.extend(longer.flatten());
    warnings.extend(evidence.evaluator.start.log.notes());
    warnings
}

/// The effects of a hypothesis with their values, which come in the order of the set.
fn effects(hypothesis: &Hypothesis, mut values: &[FittedValue]) -> Vec<FittedEffect> {
    let effect = |candidate: &crate::fitting::Candidate| {
        let info = candidate.effect.info();
        let (own, rest) = values.split_at(info.parameters.len());
        values = rest;
        FittedEffect {
            kind: info.id.to_string(),
            title: info.title.to_string(),
            joint: candidate.joint.map(|j| j + 1),
            parameters: own.to_vec(),
        }
    };
    hypothesis.set.iter().map(effect).collect()
}

fn alternative(
    hypothesis: &Hypothesis,
    evidence: &VerdictEvidence,
    judging: &mut Judging,
) -> Alternative {
    let (evaluator, fit) = (evidence.evaluator, hypothesis.fit());
    let (values, _) = judging
        .part(INTERVALS, 0.3, || fitted_values(fit, &evaluator.training))
        .unwrap_or_else(|| locally_fitted_values(fit, &evaluator.training));
    let added = values.len() - hypothesis.added_values();
    let own: Vec<FittedValue> = values[..added]
        .iter()
        .filter(|value| {
            hypothesis
                .values
                .iter()
                .any(|own| own.to_string() == value.path)
        })
        .cloned()
        .collect();
    Alternative {
        effects: effects(hypothesis, &values[added..]),
        wrong_values: compared(&evaluator.start, &own),
        error_rad: hypothesis.deciding_rms_rad(),
        same_law: evidence.says_the_same(hypothesis),
    }
}

fn ruled_out(evidence: &VerdictEvidence, rivals: &[&Hypothesis]) -> Vec<RuledOut> {
    let (base, chosen) = (&evidence.evaluator.base, evidence.chosen());
    let kept = |h: &Hypothesis| {
        let mut kept = rivals.iter().copied().chain([chosen]);
        kept.any(|k| k.values == h.values && k.adds(&h.set))
    };
    let tried = evidence.tried;
    let values = tried.values.iter().chain(&tried.values_refitted);
    let rest = values.chain(&tried.hypotheses).filter(|h| !kept(h));
    let rows = rest.map(|h| {
        let (as_good, why) = why_not(evidence, h);
        RuledOut {
            set: h.names(),
            training_error_rad: h.training_rms_rad(&evidence.evaluator.search),
            held_out_error_rad: held_out(h).map(BlockErrors::rms_rad),
            bic_change: evidence.evaluator.bic_change(base, h),
            as_good,
            why,
        }
    });
    rows.fold(Vec::new(), each_once)
}

/// Puts a row among the others. A value is tried by itself and along with the free ones: of both
/// the one that leaves less stays.
fn each_once(mut rows: Vec<RuledOut>, row: RuledOut) -> Vec<RuledOut> {
    match rows.iter_mut().find(|known| known.set == row.set) {
        Some(known) if row.training_error_rad < known.training_error_rad => *known = row,
        Some(_) => {}
        None => rows.push(row),
    }
    rows
}

fn fitted(hypothesis: &Hypothesis) -> Option<&BlockErrors> {
    hypothesis.evaluation.as_ref().map(|e| &e.training)
}

fn held_out(hypothesis: &Hypothesis) -> Option<&BlockErrors> {
    hypothesis.evaluation.as_ref()?.held_out.as_ref()
}

/// Whether a hypothesis does as well as the chosen explanation, and why it was not chosen.
fn why_not(evidence: &VerdictEvidence, hypothesis: &Hypothesis) -> (bool, String) {
    let (evaluator, explanation) = (evidence.evaluator, evidence.explanation);
    // A value refitted alone is compared with the model as given.
    let alone = hypothesis.values.len() == 1 && hypothesis.search.free.len() == 1;
    let base = if alone {
        &evaluator.given
    } else {
        &evaluator.base
    };
    let chosen = explanation.hypothesis();
    let out = |why: &str| (false, why.to_string());
    if hypothesis.rests_on_bound() {
        return out("its best value is on a bound, where it vanishes or stops being physical");
    }
    let worse = || evaluator.clearly_worse(hypothesis, chosen, base);
    match explanation {
        _ if hypothesis.search_mean > 0.99 * base.search_mean => out("it does not lower the error"),
        _ if evaluator.held_out.is_some() && held_out(hypothesis).is_none() => {
            out("others leave far less on the training motions")
        }
        _ if held_out(hypothesis).is_some_and(|e| e.mean() > base.deciding_mean()) => {
            out("it fits the training motions and makes the held-out ones worse")
        }
        Explanation::Given(_) => {
            let why = "the model explains the motions without it, and what it gains may be chance";
            (hypothesis.deciding().is_some(), why.to_string())
        }
        _ if worse() => {
            let better = better(&explanation.name(), chosen, hypothesis);
            (false, better)
        }
        Explanation::Effects(best) if hypothesis.set.len() > best.set.len() => {
            let why = "one more effect brings no significant reduction";
            (true, why.to_string())
        }
        _ => {
            let why = "the chosen explanation does as well and is simpler";
            (true, why.to_string())
        }
    }
}

/// That `best` is significantly better than another, in figures that show it.
fn better(name: &str, best: &Hypothesis, other: &Hypothesis) -> String {
    let lower = |of: fn(&Hypothesis) -> Option<&BlockErrors>| {
        let [best, other] = [best, other].map(|h| of(h).map(|errors| short(errors.rms_rad())));
        let [best, other] = [best?, other?].map(|shown| shown.parse::<f64>().ok());
        Some(best? < other?)
    };
    if lower(held_out).or_else(|| lower(fitted)) == Some(true) {
        return format!("{name} leaves significantly less");
    }
    if lower(fitted) == Some(true) {
        return format!("{name} leaves significantly less of the fitted motions' error");
    }
    let gained = best.pooled().zip(other.pooled());
    match gained.map(|(best, other)| gain(&paired(&other, &best))) {
        Some(gained) if gained > 0.0 => {
            format!(
                "{name} is more likely, by {} in log-likelihood",
                short(gained)
            )
        }
        _ => format!("{name} explains these motions better"),
    }
}

fn motions(evidence: &VerdictEvidence) -> Vec<MotionError> {
    let evaluator = evidence.evaluator;
    let evaluations = (&evaluator.given.evaluation, &evidence.chosen().evaluation);
    let (Some(before), Some(after)) = evaluations else {
        return Vec::new();
    };
    let rms = |m: (f64, usize)| (m.0 / m.1.max(1) as f64).sqrt();
    let mut list = Vec::new();
    let mut add = |data: &FitProblem, before: &BlockErrors, after: &BlockErrors, held_out: bool| {
        list.extend(
            data.motions
                .iter()
                .enumerate()
                .map(|(k, motion)| MotionError {
                    motion: motion.name.clone(),
                    held_out,
                    before_rad: rms(before.motions[k]),
                    after_rad: rms(after.motions[k]),
                }),
        );
    };
    add(
        &evaluator.training,
        &before.training,
        &after.training,
        false,
    );
    if let (Some(data), Some(before), Some(after)) =
        (&evaluator.held_out, &before.held_out, &after.held_out)
    {
        add(data, before, after, true);
    }
    list
}
