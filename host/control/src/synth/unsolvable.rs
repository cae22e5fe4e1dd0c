//! Why a Riccati equation has no stabilising solution: the mode that stands in the way.

use super::eigen::{Mode, modes};
use super::error::DesignError;
use super::riccati::{self, TimeDomain};
use super::signal::Signal;
use crate::error::Problem;
use std::fmt;

/// A mode with a smaller margin cannot be moved.
const UNCONTROLLABLE: f64 = 1e-9;
/// A plant that grows by more within a sample is sampled too slowly, not too fast.
const MOST_GROWTH: f64 = 10.0;

/// A mode of a plant that a Riccati equation cannot move.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantMode {
    /// The mode.
    pub mode: Mode,
    /// Whether the plant is sampled.
    pub sampled: bool,
    /// Sampling time, s, where it is known.
    pub ts_s: Option<f64>,
    /// Name of the state in which the mode shows most, where it is known.
    pub state: Option<String>,
}

/// What a Riccati equation is solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RiccatiRole {
    /// Gains.
    Regulator,
    /// A Kalman filter: the regulator of the transposed plant.
    Estimator,
}

/// A mode that stands in the way, and what is said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct StuckMode {
    /// The mode.
    pub mode: PlantMode,
    /// Whether inputs (outputs) do not reach it, though it does not outgrow the samples.
    pub is_unreached: bool,
    /// What is said before and behind its name.
    said: [String; 2],
    remedy: String,
}

impl StuckMode {
    fn new(mode: PlantMode, behind: &str, remedy: impl Into<String>) -> StuckMode {
        StuckMode {
            mode,
            is_unreached: false,
            said: [String::new(), format!(": {behind}")],
            remedy: remedy.into(),
        }
    }

    /// No input reaches it because of the sampling time; `faster` samples mend that, or slower.
    #[must_use]
    pub(super) fn lost_by_sampling(self, ts_s: f64, faster: bool) -> StuckMode {
        StuckMode::new(
            self.mode,
            &format!(
                "sampled every {ts_s} s no input reaches it, though in continuous time they reach \
                 every mode"
            ),
            if faster {
                "sample faster"
            } else {
                "sample more slowly"
            },
        )
    }

    /// The same with the mode's state by its name and its pole in 1/s.
    #[must_use]
    pub(super) fn of_states(mut self, states: &[Signal], ts_s: Option<f64>) -> StuckMode {
        self.mode.ts_s = ts_s;
        self.mode.state = states.get(self.mode.mode.state).map(|it| it.name.clone());
        self
    }

    /// What was found, and what mends it.
    pub(super) fn problem(&self) -> Problem {
        let [before, behind] = &self.said;
        Problem::new(format!("{before}{}{behind}", self.mode), &*self.remedy)
    }
}

impl From<StuckMode> for DesignError {
    fn from(stuck: StuckMode) -> DesignError {
        DesignError::Mode(Box::new(stuck))
    }
}

impl PlantMode {
    /// What mends a mode that outgrows the samples.
    fn sampled_too_slowly(&self) -> Option<String> {
        let grows_by = self.mode.pole.norm();
        (self.sampled && grows_by > MOST_GROWTH).then(|| {
            format!("sample faster: within one sample the mode grows by a factor of {grows_by:.3e}")
        })
    }
}

impl fmt::Display for PlantMode {
    /// "the mode with pole 6.77+1.2i 1/s, strongest in dq1"; per sample and by the state's number
    /// where no more is known.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let per_s = match self.ts_s {
            // A pole at 0 has left within a sample.
            Some(ts_s) if self.mode.pole.norm() > 0.0 => Some(self.mode.pole.ln() / ts_s),
            _ => None,
        };
        let pole = per_s.unwrap_or(self.mode.pole);
        write!(f, "the mode with pole {:.6}", pole.re + 0.0)?;
        if pole.im != 0.0 {
            write!(f, "{:+.6}i", pole.im)?;
        }
        let unit = if self.sampled && per_s.is_none() {
            ""
        } else {
            " 1/s"
        };
        match &self.state {
            Some(state) => write!(f, "{unit}, strongest in {state}"),
            None => write!(f, "{unit}, strongest in state {}", self.mode.state + 1),
        }
    }
}

impl riccati::Problem<'_> {
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
            return unreached(mode, role).into();
        }
        if let Ok(modes) = modes(&self.a.transpose(), self.q)
            && let Some(mode) = weakest(modes, &marginal).filter(immovable)
        {
            return unweighted(mode, role).into();
        }
        no_solution(weakest_driven)
    }
}

fn unreached(mode: PlantMode, role: RiccatiRole) -> StuckMode {
    let (found, remedy) = match role {
        RiccatiRole::Regulator => (
            "no input reaches it: the plant cannot be stabilised",
            "drive a joint that moves this mode",
        ),
        RiccatiRole::Estimator => (
            "no output shows it: the state cannot be estimated",
            "measure a state in which this mode shows",
        ),
    };
    let too_slowly = mode.sampled_too_slowly();
    StuckMode {
        is_unreached: too_slowly.is_none(),
        ..StuckMode::new(mode, found, too_slowly.unwrap_or_else(|| remedy.into()))
    }
}

/// A mode on the edge of stability without weight (noise).
fn unweighted(mode: PlantMode, role: RiccatiRole) -> StuckMode {
    match role {
        RiccatiRole::Regulator => StuckMode::new(
            mode,
            "Q does not weigh it, so the best gain leaves it alone",
            "weigh that state in Q",
        ),
        RiccatiRole::Estimator => StuckMode::new(
            mode,
            "the process noise W does not excite it, so the best filter ignores it",
            "give that state process noise in W",
        ),
    }
}

fn no_solution(weakest: Option<PlantMode>) -> DesignError {
    let found = "no stabilising solution was found within double precision";
    let remedy = "scale the weights to like sizes, sample slower, or drive more joints";
    let Some(mode) = weakest else {
        return DesignError::model(found, remedy);
    };
    let behind = format!(
        " is the hardest to control, {:.1e} from impossible",
        mode.mode.margin
    );
    let stuck = StuckMode {
        is_unreached: false,
        said: [format!("{found}; "), behind],
        remedy: mode.sampled_too_slowly().unwrap_or_else(|| remedy.into()),
        mode,
    };
    stuck.into()
}
