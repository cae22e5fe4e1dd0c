//! What a search has found, whole at any time.

use super::super::evaluator::Evaluator;
use super::super::explanation::SearchOutcome;
use super::super::hypothesis::Hypothesis;
use super::super::progress::Stage;
use crate::fitting::Candidate;

/// What a search has found. It is whole at any time: where the search is ended, that is what there
/// is.
#[derive(Debug, Clone, Default)]
pub(in crate::diagnose) struct SearchResults {
    /// The sets that were tried, by their size.
    pub sizes: Vec<Vec<Hypothesis>>,
    /// The smallest set that pays.
    pub best: Option<Hypothesis>,
    /// Every single value of the given model, refitted.
    pub values: Vec<Hypothesis>,
    /// The same along with the free values.
    pub values_refitted: Vec<Hypothesis>,
    /// Effects of the best set before the largest size was begun.
    pub(super) before: Option<usize>,
    /// Sets of which each effect was taken out once.
    pub(super) taken_apart: Vec<Vec<Candidate>>,
    /// What the search was at last; `None` where it came to its end.
    pub at: Option<Stage>,
    /// Whether it ended because the user tolerates what is left.
    pub is_tolerated: bool,
}

impl SearchResults {
    /// Those of a search that begins: what is ended before has tried nothing.
    pub fn at_start() -> Self {
        SearchResults {
            at: Some(Stage::Alone),
            ..SearchResults::default()
        }
    }

    /// What an explanation is chosen of: the best set alone of all sets.
    pub(super) fn outcome(&self) -> SearchOutcome {
        SearchOutcome {
            values: self.values.clone(),
            values_refitted: self.values_refitted.clone(),
            best: self.best.clone(),
            hypotheses: Vec::new(),
        }
    }

    /// What was not tried where the search was ended, in words.
    pub fn not_tried(&self, most_effects: usize) -> Vec<String> {
        let last = Stage::of_size(most_effects).max(Stage::Values);
        let after = Stage::SEARCH
            .into_iter()
            .filter(|stage| self.at.is_some_and(|at| *stage > at) && *stage <= last);
        let at = self.at.map(|at| format!("part of {}", at.all_of_it()));
        at.into_iter()
            .chain(after.map(|stage| stage.all_of_it().to_string()))
            .collect()
    }
}

impl Evaluator<'_> {
    /// Puts into `found` what came of the evaluations so far.
    pub(super) fn keep(&self, found: &mut SearchResults, put: impl FnOnce(&mut SearchResults)) {
        put(found);
        self.take_evaluated();
    }

    /// Keeps what a search had evaluated when it was ended.
    pub fn keep_evaluated(&self, found: &mut SearchResults) {
        for hypothesis in self.take_evaluated() {
            let size = hypothesis.set.len();
            let among = match (size, hypothesis.search.free.len()) {
                (0, 1) => &mut found.values,
                (0, _) => &mut found.values_refitted,
                _ => {
                    let sizes = found.sizes.len().max(size);
                    found.sizes.resize_with(sizes, Vec::new);
                    &mut found.sizes[size - 1]
                }
            };
            match size {
                0 => among.push(hypothesis),
                _ => put_among(among, vec![hypothesis]),
            }
        }
        found.best = self.smallest_that_pays(&found.sizes);
    }
}

/// Puts sets among those of their size that were tried, and in the place of the same ones that
/// leave more.
pub(super) fn put_among(tried: &mut Vec<Hypothesis>, found: Vec<Hypothesis>) {
    for new in found {
        match tried.iter_mut().find(|known| known.adds(&new.set)) {
            Some(known) if known.deciding_mean() <= new.deciding_mean() => {}
            Some(known) => *known = new,
            None => tried.push(new),
        }
    }
}
