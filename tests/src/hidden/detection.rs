//! Detection limits: how weak a hidden effect may be and still be noticed, and named.

use super::case::{Case, HiddenEffect, Truth};
use super::family::Family;
use super::trial::{Answer, Outcome, try_weakened};
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// Most steps down, each of which leaves the root of half the strength: to 1/4096.
const STEPS: u32 = 24;
/// Steps at a time while an effect is still found.
const STRIDE: u32 = 4;

/// The weakest form of an effect that a diagnosis still finds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Faintest {
    /// Its share of the strength that the benchmark hides it with.
    pub share: f64,
    /// Its first value, in the unit of its key.
    pub value: f64,
    /// What the model as given leaves of the held-out motion, rad; none where it diverges.
    pub as_given_rad: Option<f64>,
    /// What the true model leaves, rad: noise and resolution.
    pub true_rad: Option<f64>,
}

/// Where an effect at one bench arm ceases to be found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectionLimit {
    /// The effect.
    pub kind: &'static str,
    /// Seed of the arm.
    pub seed: u64,
    /// Its first value: `coulomb@1.torque_nm`.
    pub path: String,
    /// The weakest that is named, or in a set of explanations that cannot be told apart; none if
    /// not even the benchmark's own is.
    pub named: Option<Faintest>,
    /// The weakest of which it is said that something is missing.
    pub noticed: Option<Faintest>,
}

/// Makes what the bench arm of this seed hides weaker until it is no longer found.
///
/// # Errors
/// Logs that cannot be written or are refused.
pub fn detection_limit(kind: &'static str, seed: u64) -> Result<DetectionLimit, String> {
    let case = Case {
        truth: Truth::Own,
        family: Family::Single,
        hidden: vec![kind],
        seed,
    };
    let mut tried: BTreeMap<u32, (Outcome, Vec<HiddenEffect>)> = BTreeMap::new();
    let mut answer = |steps: u32| -> Result<Answer, String> {
        if let Some((outcome, _)) = tried.get(&steps) {
            return Ok(outcome.answer);
        }
        let found = try_weakened(&case, share(steps))?;
        let answer = found.0.answer;
        tried.insert(steps, found);
        Ok(answer)
    };
    let is_named = |answer| matches!(answer, Answer::Right | Answer::Equivalent);
    let is_noticed = |answer| !matches!(answer, Answer::Nominal | Answer::Unfit);
    let named = last(0, &mut |steps| answer(steps).map(is_named))?;
    let noticed = last(named.unwrap_or(0), &mut |steps| {
        answer(steps).map(is_noticed)
    })?;
    let first = |(_, effects): &(Outcome, Vec<HiddenEffect>)| {
        let (key, value) = effects.first()?.parameters.iter().next()?;
        Some((
            format!("{}.{key}", effects.first()?.address()),
            value.as_f64()?,
        ))
    };
    let faintest = |steps: u32| {
        let found = tried.get(&steps)?;
        Some(Faintest {
            share: share(steps),
            value: first(found)?.1,
            as_given_rad: found.0.before_rad,
            true_rad: found.0.true_rad,
        })
    };
    Ok(DetectionLimit {
        kind,
        seed,
        path: tried
            .values()
            .next()
            .and_then(first)
            .map_or_else(String::new, |(path, _)| path),
        named: named.and_then(faintest),
        noticed: noticed.and_then(faintest),
    })
}

fn share(steps: u32) -> f64 {
    FRAC_1_SQRT_2.powi(steps as i32)
}

/// The last of the steps from `from` on at which something holds that at some step ceases to; none
/// if it does not hold there.
fn last(
    from: u32,
    holds: &mut dyn FnMut(u32) -> Result<bool, String>,
) -> Result<Option<u32>, String> {
    if !holds(from)? {
        return Ok(None);
    }
    let mut good = from;
    let mut bad = loop {
        let next = good + STRIDE;
        if next > STEPS {
            return Ok(Some(good));
        }
        match holds(next)? {
            true => good = next,
            false => break next,
        }
    };
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        match holds(middle)? {
            true => good = middle,
            false => bad = middle,
        }
    }
    Ok(Some(good))
}

/// A row for each effect: medians over its arms.
pub fn limits_table(limits: &[DetectionLimit]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY).set_header([
        "effect",
        "value",
        "named from",
        "each arm",
        "as given leaves, x noise",
        "noticed from",
        "as given leaves, x noise",
    ]);
    let mut kinds: Vec<&str> = limits.iter().map(|limit| limit.kind).collect();
    kinds.dedup();
    for kind in kinds {
        let own: Vec<&DetectionLimit> = limits.iter().filter(|limit| limit.kind == kind).collect();
        table.add_row(cells(kind, &own));
    }
    table
}

fn cells(kind: &str, limits: &[&DetectionLimit]) -> Vec<String> {
    let key = limits.first().and_then(|limit| limit.path.split_once('.'));
    let named: Vec<Option<Faintest>> = limits.iter().map(|limit| limit.named).collect();
    let noticed: Vec<Option<Faintest>> = limits.iter().map(|limit| limit.noticed).collect();
    let each = named.iter().map(|found| said(*found, |it| Some(it.value)));
    vec![
        kind.to_string(),
        key.map_or_else(String::new, |(_, key)| key.to_string()),
        said(middle(&named), |it| Some(it.value)),
        each.collect::<Vec<_>>().join(", "),
        said(middle(&named), times_noise),
        said(middle(&noticed), |it| Some(it.value)),
        said(middle(&noticed), times_noise),
    ]
}

fn times_noise(found: Faintest) -> Option<f64> {
    Some(found.as_given_rad? / found.true_rad?)
}

/// The median by share; an effect that is not found is stronger than any that is.
fn middle(found: &[Option<Faintest>]) -> Option<Faintest> {
    let mut found = found.to_vec();
    let share = |found: &Option<Faintest>| found.map_or(f64::INFINITY, |it| it.share);
    found.sort_by(|a, b| share(a).total_cmp(&share(b)));
    found.get(found.len() / 2).copied().flatten()
}

/// Three digits that count; a dash where there is nothing to say.
fn said(found: Option<Faintest>, of: impl Fn(Faintest) -> Option<f64>) -> String {
    let Some(value) = found.and_then(of).filter(|value| value.is_finite()) else {
        return "-".to_string();
    };
    let places = match value.abs() {
        0.0 => 0.0,
        size => 2.0 - size.log10().floor(),
    };
    format!("{value:.*}", places.clamp(0.0, 9.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_step_is_found_wherever_it_is() {
        for limit in 0..=STEPS {
            let mut tried = Vec::new();
            let mut holds = |steps: u32| {
                tried.push(steps);
                Ok(steps <= limit)
            };
            let most = STEPS - STEPS % STRIDE;
            assert_eq!(last(0, &mut holds), Ok(Some(limit.min(most))));
            assert!(tried.len() <= 10, "{tried:?}");
        }
        assert_eq!(last(0, &mut |_| Ok(false)), Ok(None));
        assert!(last(0, &mut |_| Err("why".to_string())).is_err());
    }

    #[test]
    fn one_that_is_not_found_counts_as_the_strongest() {
        let found = |share| {
            Some(Faintest {
                share,
                value: 2.0 * share,
                as_given_rad: Some(3e-3),
                true_rad: Some(1.5e-3),
            })
        };
        assert_eq!(middle(&[found(0.5), None, found(0.1)]), found(0.5));
        assert_eq!(middle(&[None, found(0.5), None]), None);
        assert_eq!(said(found(0.0123), |it| Some(it.value)), "0.0246");
        assert_eq!(said(found(0.5), times_noise), "2.00");
        assert_eq!(said(None, times_noise), "-");
    }
}
