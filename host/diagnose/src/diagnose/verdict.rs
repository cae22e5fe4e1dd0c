//! What may be claimed: the rules, apart from how their signs are found.

use super::findings::Verdict;

/// What kind of explanation was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// The model as given.
    Given,
    /// Other values in the model file.
    Values,
    /// Missing effects.
    Effects,
}

/// What a verdict hangs on. Means are of squared residuals over the noise; 1 is the noise.
#[derive(Debug, Clone, Copy)]
pub(super) struct Signs {
    pub kind: Kind,
    /// Mean of what the explanation improves on.
    pub before: f64,
    /// Mean that it leaves.
    pub left: f64,
    /// The largest that it leaves of one motion, fitted or held out.
    pub worst_motion: f64,
    /// Whether that is nothing but noise, on the motions fitted and on those held out.
    pub at_noise_floor: bool,
    /// Whether motions that took no part in the fit decide.
    pub held_out: bool,
    /// Whether the user asked for no less error.
    pub tolerated: bool,
    /// Share of what is left that a free form could still gain, and the lower end of its interval.
    pub free_form_share: f64,
    pub free_form_low: f64,
    /// Share of what is left that goes when every motion has values of its own.
    pub per_motion_reduction: f64,
    /// Largest factor by which it raises the error of motions held out in turn; 1 where it raises
    /// none.
    pub worst_fold: f64,
    /// The most that it leaves of motions held out in turn, in floors; 0 where none are.
    pub worst_fold_floors: f64,
    /// Whether an effect has a value of which the motions say nothing: its interval reaches from
    /// bound to bound.
    pub spans_bounds: bool,
    /// Whether a placebo regressor gains about as much as the effects.
    pub placebo_ranks: bool,
    /// Whether other explanations do as well.
    pub rivals: bool,
    /// Whether all was examined that could contradict it.
    pub is_examined: bool,
    /// Whether another motion than those that alone show it could have proved it.
    pub is_provable: bool,
}

/// Share of what is left that a free form must significantly gain before the explanation counts as
/// incomplete.
pub(super) const UNEXPLAINED_LOW: f64 = 0.2;
/// The same for the estimate itself.
pub(super) const UNEXPLAINED_SHARE: f64 = 0.35;
/// An explanation that leaves more than this share of the squared error above the noise is not the
/// whole of it.
const MOST_LEFT: f64 = 0.125;
/// So does one that leaves more than so many times the noise on motions held out: what is true
/// leaves hardly more than the noise, and what only resembles it leaves most.
const MOST_FLOORS: f64 = 2.0;
/// The same where nothing is held out, which proves less and claims less.
const MOST_FLOORS_FITTED: f64 = 5.0;
/// Where more than this share of what is left goes as every motion gets values of its own, they are
/// no constants.
const MOST_VARYING: f64 = 0.5;
/// What is true does not make motions that it was not fitted to so many times worse.
pub(super) const MOST_RAISED: f64 = 1.5;
/// A model that leaves more than so many floors, of any motion, is not nominal.
pub(super) const MOST_NOMINAL: f64 = 1.5;
/// Mean squared weighted error from which the noise no longer excuses it.
pub(super) const FAR_OFF: f64 = 2.0;

impl Signs {
    pub fn verdict(&self) -> Verdict {
        match self.kind {
            Kind::Given if !self.at_noise_floor && self.tolerated => Verdict::Adequate,
            _ if self.is_incomplete() => Verdict::Unexplained,
            // Something is left, and what would have explained it may not have been tried.
            Kind::Given if !self.is_examined && !self.at_noise_floor => Verdict::Unexplained,
            Kind::Given => Verdict::Nominal,
            _ if self.placebo_ranks => Verdict::Unexplained,
            _ if self.rivals || !self.is_examined || !self.is_provable => Verdict::Ambiguous,
            Kind::Values => Verdict::WrongValue,
            Kind::Effects => Verdict::Named,
        }
    }

    /// Whether the explanation needs other values in every motion.
    pub fn values_vary(&self) -> bool {
        self.kind != Kind::Given && self.per_motion_reduction > MOST_VARYING
    }

    /// Whether what remains is more than may be passed over.
    fn is_incomplete(&self) -> bool {
        if self.kind == Kind::Given && self.worst_motion.sqrt() > MOST_NOMINAL {
            return true;
        }
        if self.at_noise_floor {
            return false;
        }
        match (self.kind, self.held_out) {
            (Kind::Given, _) => self.is_structured(),
            (_, true) => {
                self.is_structured()
                    || self.leaves_much()
                    || self.values_vary()
                    || self.worst_fold > MOST_RAISED
                    || self.worst_fold_floors > MOST_FLOORS
                    || self.spans_bounds
            }
            // Motions that were fitted show too little of what is left; what they show is there.
            (_, false) => self.leaves_much(),
        }
    }

    /// Whether what is left has a structure.
    fn is_structured(&self) -> bool {
        self.free_form_low > UNEXPLAINED_LOW && self.free_form_share > UNEXPLAINED_SHARE
    }

    /// Whether the explanation leaves a good part of the squared error above the noise, or an error
    /// far above it.
    fn leaves_much(&self) -> bool {
        let share = (self.left - 1.0) / (self.before - 1.0);
        let most_floors = if self.held_out {
            MOST_FLOORS
        } else {
            MOST_FLOORS_FITTED
        };
        self.left > FAR_OFF && (share > MOST_LEFT || self.left.sqrt() > most_floors)
    }
}

#[cfg(test)]
mod tests;
