//! Detection limits: how weak a hidden effect may be and still be noticed, and named.

use super::case::{Case, Truth};
use super::family::Family;
use super::outcome::Answer;
use super::text::table;
use super::trial::try_weakened;
use comfy_table::Table;
use handstand::effects;
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
}

/// Where an effect at one bench arm ceases to be found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectionLimit {
    /// The effect.
    pub kind: &'static str,
    /// Seed of the arm.
    pub seed: u64,
    /// The value that is given: the effect's first in the library.
    pub key: &'static str,
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
        skipped: Vec::new(),
    };
    let Some(known) = effects::named(kind) else {
        return Err(format!("the library has no `{kind}`"));
    };
    // The library names first what an effect ceases with.
    let key = known.info().parameters[0].key;
    let mut tried: BTreeMap<u32, (Answer, f64)> = BTreeMap::new();
    let mut answer = |steps: u32| -> Result<Answer, String> {
        if let Some((answer, _)) = tried.get(&steps) {
            return Ok(*answer);
        }
        let (answer, hidden) = try_weakened(&case, share(steps))?;
        let value = hidden
            .first()
            .and_then(|it| it.parameters.get(key)?.as_f64());
        let value = value.ok_or_else(|| format!("`{kind}` has no `{key}`"))?;
        tried.insert(steps, (answer, value));
        Ok(answer)
    };
    let is_named = |answer| matches!(answer, Answer::Right | Answer::Equivalent);
    let is_noticed = |answer| !matches!(answer, Answer::Nominal | Answer::Unfit);
    let named = last(0, &mut |steps| answer(steps).map(is_named))?;
    let noticed = last(named.unwrap_or(0), &mut |steps| {
        answer(steps).map(is_noticed)
    })?;
    let faintest = |steps: u32| {
        let share = share(steps);
        tried
            .get(&steps)
            .map(|&(_, value)| Faintest { share, value })
    };
    Ok(DetectionLimit {
        kind,
        seed,
        key,
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
        if good == STEPS {
            return Ok(Some(good));
        }
        let next = (good + STRIDE).min(STEPS);
        if holds(next)? {
            good = next
        } else {
            break next;
        }
    };
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if holds(middle)? {
            good = middle
        } else {
            bad = middle
        }
    }
    Ok(Some(good))
}

/// A row for each effect: medians over its arms.
pub fn limits_table(limits: &[DetectionLimit]) -> Table {
    let mut rows = table(["effect", "value", "named from", "each arm", "noticed from"]);
    let mut kinds: Vec<&str> = limits.iter().map(|limit| limit.kind).collect();
    kinds.dedup();
    for kind in kinds {
        let own: Vec<&DetectionLimit> = limits.iter().filter(|limit| limit.kind == kind).collect();
        rows.add_row(cells(kind, &own));
    }
    rows
}

fn cells(kind: &str, limits: &[&DetectionLimit]) -> Vec<String> {
    let key = limits.first().map_or("", |limit| limit.key);
    let named: Vec<Option<Faintest>> = limits.iter().map(|limit| limit.named).collect();
    let noticed: Vec<Option<Faintest>> = limits.iter().map(|limit| limit.noticed).collect();
    let each: Vec<String> = named.iter().map(|found| said(*found)).collect();
    vec![
        kind.to_string(),
        key.to_string(),
        said(middle(&named)),
        each.join(", "),
        said(middle(&noticed)),
    ]
}

/// The median by share; an effect that is not found is stronger than any that is.
fn middle(found: &[Option<Faintest>]) -> Option<Faintest> {
    let mut found = found.to_vec();
    let share = |found: &Option<Faintest>| found.map_or(f64::INFINITY, |it| it.share);
    found.sort_by(|a, b| share(a).total_cmp(&share(b)));
    found.get(found.len() / 2).copied().flatten()
}

/// Three digits that count; a dash where there is nothing to say.
fn said(found: Option<Faintest>) -> String {
    let Some(Faintest { value, .. }) = found else {
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
            assert_eq!(last(0, &mut holds), Ok(Some(limit)));
            assert!(tried.len() <= 10, "{tried:?}");
            assert_eq!(
                last(limit, &mut |steps| Ok(steps <= STEPS)),
                Ok(Some(STEPS))
            );
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
            })
        };
        assert_eq!(middle(&[found(0.5), None, found(0.1)]), found(0.5));
        assert_eq!(middle(&[None, found(0.5), None]), None);
        assert_eq!(said(found(0.0123)), "0.0246");
        assert_eq!(said(None), "-");
    }
}
