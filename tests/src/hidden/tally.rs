//! Many outcomes as a few figures with their targets.

use super::trial::Outcome;
use handstand::diagnose::Verdict;
use serde::Serialize;
use std::collections::BTreeMap;

/// What was said of all benches that hide the same.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Row {
    /// What is hidden; none for nothing.
    pub hidden: Option<String>,
    /// Benches.
    pub count: usize,
    /// Exactly the hidden effect was named; for benches that hide nothing, nothing was.
    pub right: usize,
    /// Other sets that were named, and how often.
    pub wrong: BTreeMap<String, usize>,
    /// Several sets do as well.
    pub ambiguous: usize,
    /// Of those, the hidden effect alone is one of the sets.
    pub ambiguous_with_truth: usize,
    /// Something is missing, none of the library's.
    pub unexplained: usize,
    /// Nothing is missing, though something is.
    pub nominal: usize,
    /// The data cannot tell.
    pub unfit: usize,
}

impl Row {
    fn count(&mut self, outcome: &Outcome) {
        self.count += 1;
        match outcome.verdict {
            Verdict::Named if outcome.is_right() => self.right += 1,
            Verdict::Named => *self.wrong.entry(outcome.effects.join("+")).or_default() += 1,
            Verdict::Ambiguous => {
                self.ambiguous += 1;
                let mut sets = outcome.alternatives.iter().chain([&outcome.effects]);
                if sets.any(|set| set.iter().eq(outcome.hidden.iter())) {
                    self.ambiguous_with_truth += 1;
                }
            }
            Verdict::Unexplained => self.unexplained += 1,
            Verdict::Nominal | Verdict::Adequate | Verdict::WrongValue => {
                match outcome.hidden {
                    // The owner's values are off, whether an effect is hidden or not.
                    None => self.right += 1,
                    Some(_) => self.nominal += 1,
                }
            }
            Verdict::Unfit => self.unfit += 1,
        }
    }
}

/// A measured figure beside its target.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    /// What it is.
    pub name: &'static str,
    /// Cases that meet it.
    pub met: usize,
    /// Cases in all.
    pub of: usize,
    /// Least share that must meet it, or most where `at_most`.
    pub target: f64,
    /// Whether the target is an upper limit.
    pub at_most: bool,
}

impl Figure {
    fn of<T>(
        name: &'static str,
        target: f64,
        cases: impl IntoIterator<Item = T>,
        meets: impl Fn(&T) -> bool,
    ) -> Figure {
        let cases: Vec<T> = cases.into_iter().collect();
        Figure {
            name,
            met: cases.iter().filter(|case| meets(case)).count(),
            of: cases.len(),
            target,
            at_most: false,
        }
    }

    /// The share, from 0 to 1; none without cases.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.met as f64 / self.of as f64)
    }

    /// Whether the target is reached; without cases nothing is missed.
    pub fn is_met(&self) -> bool {
        self.share().is_none_or(|share| match self.at_most {
            true => share <= self.target,
            false => share >= self.target,
        })
    }
}

/// Held-out error against the true model's that still counts as explained.
pub const MOST_RATIO: f64 = 1.3;

/// All figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tally {
    /// Confusion, a row per hidden effect and one for none.
    pub rows: Vec<Row>,
    /// Figures with targets.
    pub figures: Vec<Figure>,
    /// Median of held-out error against the true model's, over all benches that hide something.
    pub median_ratio: Option<f64>,
    /// Their largest.
    pub largest_ratio: Option<f64>,
    /// Median seconds of a diagnosis; not part of the JSON.
    #[serde(skip)]
    pub median_seconds: Option<f64>,
}

impl Tally {
    /// Counts outcomes.
    pub fn of(outcomes: &[Outcome]) -> Tally {
        let mut rows: Vec<Row> = Vec::new();
        for outcome in outcomes.iter().filter(|outcome| !outcome.left_out) {
            match rows.iter_mut().find(|row| row.hidden == outcome.hidden) {
                Some(row) => row.count(outcome),
                None => {
                    let mut row = Row {
                        hidden: outcome.hidden.clone(),
                        ..Row::default()
                    };
                    row.count(outcome);
                    rows.push(row);
                }
            }
        }
        let hidden = || {
            outcomes
                .iter()
                .filter(|o| o.hidden.is_some() && !o.left_out)
        };
        let nominal = outcomes.iter().filter(|o| o.hidden.is_none());
        let right = || hidden().filter(|outcome| outcome.is_right());
        let values = right().flat_map(|outcome| &outcome.values);
        let left_out = outcomes.iter().filter(|outcome| outcome.left_out);
        let undecided =
            |o: &&Outcome| matches!(o.verdict, Verdict::Unexplained | Verdict::Ambiguous);
        let mut ratios: Vec<f64> = hidden().map(Outcome::ratio).collect();
        let mut seconds: Vec<f64> = outcomes.iter().map(|outcome| outcome.seconds).collect();
        Tally {
            rows,
            figures: vec![
                Figure::of("named rightly", 0.9, hidden(), |o| o.is_right()),
                Figure {
                    at_most: true,
                    ..Figure::of("false alarms", 0.04, nominal, |o| o.names_effects())
                },
                Figure::of(
                    "held-out error within 1.3x of the true model's",
                    0.9,
                    hidden(),
                    |o| o.ratio() <= MOST_RATIO,
                ),
                Figure::of("95 % intervals that hold the truth", 0.85, values, |v| {
                    v.covered
                }),
                Figure::of(
                    "left out, ends unexplained or ambiguous",
                    0.8,
                    left_out,
                    undecided,
                ),
            ],
            median_ratio: median(&mut ratios),
            largest_ratio: ratios.last().copied(),
            median_seconds: median(&mut seconds),
        }
    }

    /// Whether every target is reached.
    pub fn is_met(&self) -> bool {
        self.figures.iter().all(Figure::is_met)
    }
}

/// Sorts, and takes the middle.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
