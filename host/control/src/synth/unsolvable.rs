//! Why a Riccati equation has no stabilising solution: the mode that stands in the way.

use super::eigen::{Mode, modes};
use super::error::{DesignError, PlantMode, RiccatiRole};
use super::riccati::{Problem, TimeDomain};

/// A mode with a smaller margin cannot be moved.
const UNCONTROLLABLE: f64 = 1e-9;

impl Problem<'_> {
    /// The reason for no stabilising solution.
    pub fn unsolvable(&self, role: RiccatiRole) -> DesignError {
        let lasting = |mode: &Mode| match self.time {
            TimeDomain::Continuous => mode.pole.re > -1e-9 * self.a.norm(),
            TimeDomain::Discrete => mode.pole.norm() > 1.0 - 1e-9,
        };
        let marginal = |mode: &Mode| match self.time {
            TimeDomain::Continuous => mode.pole.re.abs() < 1e-7 * self.a.norm(),
            TimeDomain::Discrete => (mode.pole.norm() - 1.0).abs() < 1e-7,
        };
        let weakest = |modes: Vec<Mode>, counts: &dyn Fn(&Mode) -> bool| {
            let counted = modes.into_iter().filter(counts);
            let weakest = counted.min_by(|a, b| a.margin.total_cmp(&b.margin));
            let sampled = self.time == TimeDomain::Discrete;
            weakest.map(|mode| PlantMode {
                mode,
                sampled,
                ts_s: None,
                state: None,
            })
        };
        let immovable = |mode: &PlantMode| mode.mode.margin < UNCONTROLLABLE;
        let weakest_driven = match modes(self.a, self.b) {
            Ok(modes) => weakest(modes, &lasting),
            Err(error) => return error,
        };
        if let Some(mode) = weakest_driven.clone().filter(immovable) {
            return DesignError::Uncontrollable { mode, role };
        }
        if let Ok(modes) = modes(&self.a.transpose(), self.q)
            && let Some(mode) = weakest(modes, &marginal).filter(immovable)
        {
            return DesignError::Unweighted { mode, role };
        }
        DesignError::NoSolution {
            weakest: weakest_driven,
        }
    }
}
