//! Many outcomes as rates with their intervals and targets.

use super::family::{FAMILIES, Family};
use super::outcome::{Answer, Outcome};
use handstand::study::share_interval;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// So many of so many, with the ends of the 95 % interval (Wilson).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// Cases that meet it.
    pub met: usize,
    /// Cases in all.
    pub of: usize,
    /// Lower end of the share's interval, 0 to 1.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Share {
    fn of(met: usize, of: usize) -> Share {
        let [low, high] = share_interval(met, of);
        Share { met, of, low, high }
    }

    /// The share, 0 to 1; none without cases.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.met as f64 / self.of as f64)
    }
}

/// Median, 90 % and largest of some numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Half of them are at most this.
    pub median: f64,
    /// Nine tenths of them are at most this.
    pub most_90: f64,
    /// All of them are at most this.
    pub largest: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Option<Spread> {
        let mut values: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (share * values.len() as f64).ceil() as usize;
            values.get(place.max(1) - 1).copied()
        };
        Some(Spread {
            median: at(0.5)?,
            most_90: at(0.9)?,
            largest: at(1.0)?,
        })
    }
}

/// What was said of all cases of a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FamilyRow {
    /// The family.
    pub family: Family,
    /// Cases.
    pub count: usize,
    /// How many of each answer.
    pub answers: BTreeMap<Answer, usize>,
    /// Cases that count as right, those in an equivalent set too.
    pub reached: Share,
    /// Least share of them that is asked for.
    pub target: f64,
    /// Held-out error over the true model's.
    pub ratio: Option<Spread>,
    /// Intervals of 95 % that hold the truth, of effects named rightly.
    pub coverage: Share,
    /// Seconds of a diagnosis.
    pub seconds: Option<Spread>,
    /// Versions of the project that were measured.
    pub versions: BTreeSet<String>,
}

/// Largest held-out error over the true model's, for nine of ten cases.
pub const MOST_RATIO: f64 = 1.1;
/// Least and most of the intervals of 95 % that hold the truth.
pub const COVERAGE: (f64, f64) = (0.92, 0.98);

impl FamilyRow {
    fn of(family: Family, outcomes: &[&Outcome]) -> FamilyRow {
        let mut answers = BTreeMap::new();
        for outcome in outcomes {
            *answers.entry(outcome.answer).or_default() += 1;
        }
        let count = |answer| answers.get(&answer).copied().unwrap_or(0);
        let reached = count(Answer::Right) + count(Answer::Equivalent);
        let values = || outcomes.iter().flat_map(|outcome| outcome.fitted());
        let covered = values().filter(|value| value.covered).count();
        FamilyRow {
            family,
            count: outcomes.len(),
            reached: Share::of(reached, outcomes.len()),
            target: family.target().share,
            ratio: Spread::of(outcomes.iter().filter_map(|outcome| outcome.ratio())),
            coverage: Share::of(covered, values().count()),
            seconds: Spread::of(outcomes.iter().map(|outcome| outcome.seconds)),
            versions: outcomes
                .iter()
                .map(|outcome| outcome.version.clone())
                .collect(),
            answers,
        }
    }

    /// Cases of this answer.
    pub fn answered(&self, answer: Answer) -> usize {
        self.answers.get(&answer).copied().unwrap_or(0)
    }

    /// Whether enough of them are right.
    pub fn is_reached(&self) -> bool {
        self.reached
            .share()
            .is_none_or(|share| share >= self.target)
    }

    /// Whether nine of ten held-out errors are near the true model's; where something the library
    /// knows is hidden.
    pub fn is_near(&self) -> bool {
        self.family == Family::Outside || self.ratio.is_none_or(|ratio| ratio.most_90 <= MOST_RATIO)
    }

    /// Whether the intervals hold the truth about as often as they say: a share within the limits
    /// lies in its interval.
    pub fn is_covered(&self) -> bool {
        let (least, most) = COVERAGE;
        self.coverage.of == 0 || (self.coverage.low <= most && self.coverage.high >= least)
    }
}

/// What was said of all rigs that hide the same effect, singly.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectRow {
    /// The family.
    pub family: Family,
    /// Kind of the effect.
    pub kind: String,
    /// Cases.
    pub count: usize,
    /// How many of each answer.
    pub answers: BTreeMap<Answer, usize>,
    /// What was said in place of it, and how often.
    pub instead: BTreeMap<String, usize>,
}

/// How often the intervals of one value hold the truth, whatever joint it is of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValueRow {
    /// Kind and key: `fold_back.level`.
    pub value: String,
    /// Intervals of 95 % that hold the truth.
    pub coverage: Share,
}

/// All figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tally {
    /// A row per family that was tried.
    pub families: Vec<FamilyRow>,
    /// A row per family and effect, of those that hide one.
    pub effects: Vec<EffectRow>,
    /// A row per value of which an interval missed the truth, those that miss most first.
    pub values: Vec<ValueRow>,
}

impl Tally {
    /// Counts outcomes.
    pub fn of(outcomes: &[Outcome]) -> Tally {
        let of = |family: Family| -> Vec<&Outcome> {
            let all = outcomes.iter();
            all.filter(|outcome| outcome.family == family).collect()
        };
        let tried = FAMILIES
            .into_iter()
            .filter(|family| !of(*family).is_empty());
        let tried: Vec<Family> = tried.collect();
        Tally {
            families: tried
                .iter()
                .map(|&family| FamilyRow::of(family, &of(family)))
                .collect(),
            effects: tried
                .iter()
                .flat_map(|&family| effect_rows(family, &of(family)))
                .collect(),
            values: value_rows(outcomes),
        }
    }

    /// Whether every target is reached.
    pub fn is_met(&self) -> bool {
        let met = |row: &FamilyRow| row.is_reached() && row.is_near() && row.is_covered();
        self.families.iter().all(met)
    }
}

fn value_rows(outcomes: &[Outcome]) -> Vec<ValueRow> {
    let mut held: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for value in outcomes.iter().flat_map(Outcome::fitted) {
        let (owner, key) = value.path.split_once('.').unwrap_or((&value.path, ""));
        let kind = owner.split('@').next().unwrap_or(owner);
        let (met, of) = held.entry(format!("{kind}.{key}")).or_default();
        *met += usize::from(value.covered);
        *of += 1;
    }
    let missed = held.into_iter().filter(|(_, (met, of))| met < of);
    let row = |(value, (met, of))| ValueRow {
        value,
        coverage: Share::of(met, of),
    };
    let mut rows: Vec<ValueRow> = missed.map(row).collect();
    let share = |row: &ValueRow| row.coverage.share().unwrap_or(1.0);
    rows.sort_by(|a, b| share(a).total_cmp(&share(b)));
    rows
}

fn effect_rows(family: Family, outcomes: &[&Outcome]) -> Vec<EffectRow> {
    let mut rows: Vec<EffectRow> = Vec::new();
    for outcome in outcomes {
        let [kind] = outcome.kinds.as_slice() else {
            continue;
        };
        let place = rows.iter().position(|row| row.kind == *kind);
        let place = place.unwrap_or_else(|| {
            rows.push(EffectRow {
                family,
                kind: kind.clone(),
                count: 0,
                answers: BTreeMap::new(),
                instead: BTreeMap::new(),
            });
            rows.len() - 1
        });
        let row = &mut rows[place];
        row.count += 1;
        *row.answers.entry(outcome.answer).or_default() += 1;
        if outcome.answer == Answer::Wrong {
            let sets = outcome.sets.iter().map(|set| set.join(" + "));
            let said = sets.collect::<Vec<_>>().join(" | ");
            *row.instead.entry(said).or_default() += 1;
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::super::case::Truth;
    use super::super::outcome::Value;
    use super::*;

    fn outcome(kind: &str, answer: Answer, ratio: f64, covered: bool) -> Outcome {
        Outcome {
            truth: Truth::Own,
            family: Family::Single,
            kinds: vec![kind.to_string()],
            seed: 1,
            hidden: vec![format!("{kind}@1")],
            verdict: "named".to_string(),
            sets: vec![vec!["mass@1".to_string()]],
            answer,
            before_rad: Some(0.1),
            after_rad: Some(1e-3 * ratio),
            true_rad: Some(1e-3),
            values: vec![Value {
                path: "x".to_string(),
                true_value: 1.0,
                estimate: Some(1.0),
                interval: Some((0.9, 1.1)),
                covered,
            }],
            seconds: 2.0,
            version: "0.1.0 (abc)".to_string(),
        }
    }

    #[test]
    fn a_value_without_an_interval_covers_nothing_and_misses_nothing() {
        let mut outcomes = vec![outcome("delay", Answer::Right, 1.0, true); 2];
        outcomes[1].values[0].interval = None;
        outcomes[1].values[0].covered = false;
        let coverage = Tally::of(&outcomes).families[0].coverage;
        assert_eq!((coverage.met, coverage.of), (1, 1));
    }

    #[test]
    fn values_that_miss_are_counted_whatever_their_joint() {
        let value = |path: &str, covered| {
            let mut outcome = outcome("delay", Answer::Right, 1.0, covered);
            outcome.values[0].path = path.to_string();
            outcome
        };
        let tally = Tally::of(&[
            value("delay@1.delay_s", true),
            value("delay@2.delay_s", false),
            value("mass@1.added_kg", true),
            value("base_tilt.angle_rad", false),
        ]);
        let rows = tally.values.iter();
        let rows = rows.map(|row| (row.value.as_str(), row.coverage.met, row.coverage.of));
        let rows: Vec<_> = rows.collect();
        assert_eq!(
            rows,
            [("base_tilt.angle_rad", 0, 1), ("delay.delay_s", 1, 2)]
        );
    }

    #[test]
    fn equivalent_sets_count_and_wrong_names_are_told() {
        let mut outcomes = vec![outcome("delay", Answer::Right, 1.0, true); 8];
        outcomes.push(outcome("delay", Answer::Equivalent, 1.0, true));
        outcomes.push(outcome("delay", Answer::Wrong, 3.0, true));
        let tally = Tally::of(&outcomes);
        let row = &tally.families[0];
        assert_eq!((row.reached.met, row.reached.of), (9, 10));
        assert!(row.reached.low < 0.9 && row.reached.high > 0.9);
        assert!(!row.is_reached());
        let ratio = row.ratio.unwrap();
        assert_eq!(
            (ratio.median, ratio.most_90, ratio.largest),
            (1.0, 1.0, 3.0)
        );
        assert!(row.is_near());
        assert_eq!(tally.effects[0].instead["mass@1"], 1);
        assert!(!tally.is_met());
    }

    #[test]
    fn a_target_missed_is_one_of_rate_ratio_or_coverage() {
        let right = |ratio, covered| outcome("delay", Answer::Right, ratio, covered);
        let all = |ratio, covered| Tally::of(&vec![right(ratio, covered); 1000]);
        assert!(Tally::of(&[right(1.0, true)]).is_met());
        assert!(!all(1.2, true).is_met());
        assert!(!all(1.0, false).is_met());
        // Intervals that always hold the truth are too wide.
        assert!(!all(1.0, true).is_met());
        let mut some = vec![right(1.0, true); 95];
        some.extend(vec![right(1.0, false); 5]);
        assert!(Tally::of(&some).is_met());
    }
}
