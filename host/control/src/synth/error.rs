//! Why no design follows from a model, weights and timing that are well formed.

use super::eigen::Mode;
use super::pose_text::PoseReason;
use super::signal::Signal;
use crate::error::Error;
use std::fmt;

mod remedy;

/// What stands in the way of a design; joints, states and inputs count from 0.
///
/// As [`Error::Design`], which holds it, it ends a command with exit code 3.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum DesignError {
    #[error("no joint of `{model}` is driven")]
    NothingDriven { model: String },
    #[error("the masses and inertias of `{model}` do not make a positive inertia")]
    NoInertia { model: String },
    #[error("the drives differ in delay: {first_s} s and {other_s} s")]
    DelaysDiffer { first_s: f64, other_s: f64 },
    #[error(transparent)]
    Pose(#[from] PoseReason),
    #[error(
        "joint {joint} is passive and {torque_nm:.3e} {} would have to hold it at {angle_rad} {}: \
         the pose is no equilibrium",
        units[2],
        units[0]
    )]
    NoEquilibrium {
        joint: String,
        torque_nm: f64,
        angle_rad: f64,
        units: [&'static str; 3],
    },
    #[error("no equilibrium was found near this pose")]
    EquilibriumNotFound,
    #[error(
        "joint {joint} needs {torque_nm:.3} {} to hold the pose, more than its drive can give",
        units[2]
    )]
    DriveTooWeak {
        joint: String,
        torque_nm: f64,
        units: [&'static str; 3],
    },
    #[error(
        "{} of {held:.4} {} holds the pose, and its limit is {limit} {}",
        input.name,
        input.unit,
        input.unit
    )]
    HeldBeyondLimit {
        input: Signal,
        held: f64,
        limit: f64,
    },
    #[error("joint {joint} slides, and the filter measures angles and a gyro")]
    SlideFiltered { joint: String },

    #[error("a sampling time of {0} s")]
    SamplingTime(f64),
    #[error("a delay of {delay_s} s at a sampling time of {ts_s} s")]
    Delay {
        delay_s: f64,
        ts_s: f64,
        most_samples: usize,
    },
    #[error("the plant grows beyond all numbers within one sample of {0} s")]
    GrowsWithinSample(f64),

    #[error("{name} has {found} values, but there are {size} {of}")]
    DiagonalSize {
        name: &'static str,
        found: usize,
        size: usize,
        of: &'static str,
    },
    #[error("{name} has {found} values, but {size} are needed")]
    ListSize {
        name: &'static str,
        found: usize,
        size: usize,
    },
    #[error("{name} is {} x {}, but there are {size} {of}", shape.0, shape.1)]
    MatrixSize {
        name: &'static str,
        shape: (usize, usize),
        size: usize,
        of: &'static str,
    },
    #[error("{name} has an entry of {value}")]
    Entry { name: &'static str, value: f64 },
    #[error(
        "{name} is not symmetric: entry ({}, {}) is {below}, entry ({}, {}) is {above}",
        at.0 + 1, at.1 + 1, at.1 + 1, at.0 + 1
    )]
    Asymmetric {
        name: &'static str,
        at: (usize, usize),
        below: f64,
        above: f64,
    },
    #[error("{name} is not positive semidefinite: its least eigenvalue is {least:.3e}")]
    Indefinite { name: &'static str, least: f64 },
    #[error("{name} is not positive definite: its least eigenvalue is {least:.3e}")]
    NotDefinite {
        name: &'static str,
        least: f64,
        of: &'static str,
    },
    #[error("integral action sums angles sample by sample, and continuous time has no samples")]
    IntegralContinuous,
    #[error("the gains of the integrals are singular: some sum acts on no input")]
    IntegralUnused,
    #[error("the innovation's covariance is not positive definite")]
    Innovation,

    #[error("the eigenvalues of the system matrix cannot be found")]
    Eigenvalues,
    #[error("{mode}: {}", role.uncontrollable().0)]
    Uncontrollable { mode: PlantMode, role: RiccatiRole },
    #[error(
        "{mode}: sampled every {ts_s} s no input reaches it, though in continuous time they reach \
         every mode"
    )]
    LostBySampling {
        mode: PlantMode,
        ts_s: f64,
        faster: bool,
    },
    #[error("{mode}: {}", role.unweighted().0)]
    Unweighted { mode: PlantMode, role: RiccatiRole },
    #[error(
        "no stabilising solution was found within double precision{}",
        nearest(weakest.as_ref())
    )]
    NoSolution { weakest: Option<PlantMode> },

    #[error("a word of {0} bits")]
    WordLength(u32),
    #[error("{found} values of {of} {what}, but there are {needed} {of}s")]
    Count {
        what: &'static str,
        of: &'static str,
        found: usize,
        needed: usize,
    },
    #[error("the {what} of {of} {} is {value}", index + 1)]
    NotPositive {
        what: &'static str,
        of: &'static str,
        index: usize,
        value: f64,
    },
    #[error("{of} {} reaches {steps:.0} steps of {step}, but a word holds {word}", index + 1)]
    BeyondWord {
        of: &'static str,
        index: usize,
        steps: f64,
        step: f64,
        word: f64,
    },
    #[error(
        "the gains of input {} overflow {bits} bits: the sum over the declared ranges is too \
         large for its step of {step}",
        input + 1
    )]
    Overflow { input: usize, bits: u32, step: f64 },
    #[error(
        "rounded to {bits} bits the gains no longer stabilise: the spectral radius is {radius:.6}"
    )]
    UnstableWhenRounded { bits: u32, radius: f64 },

    #[error("the gain to start from lets one of the plants fall")]
    UnstableStart,
    #[error("no gain was found that holds all plants at {share:.2} of the spread")]
    SpreadTooWide { share: f64 },
}

/// A plant that grows by more within a sample is sampled too slowly, not too fast.
pub(super) const MOST_GROWTH: f64 = 10.0;

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

impl RiccatiRole {
    /// A mode that inputs (outputs) do not reach, and the remedy.
    fn uncontrollable(self) -> (&'static str, &'static str) {
        match self {
            RiccatiRole::Regulator => (
                "no input reaches it: the plant cannot be stabilised",
                "drive a joint that moves this mode",
            ),
            RiccatiRole::Estimator => (
                "no output shows it: the state cannot be estimated",
                "measure a state in which this mode shows",
            ),
        }
    }

    /// A mode on the edge of stability without weight (noise), and the remedy.
    fn unweighted(self) -> (&'static str, &'static str) {
        match self {
            RiccatiRole::Regulator => (
                "Q does not weigh it, so the best gain leaves it alone",
                "weigh that state in Q",
            ),
            RiccatiRole::Estimator => (
                "the process noise W does not excite it, so the best filter ignores it",
                "give that state process noise in W",
            ),
        }
    }
}

impl PlantMode {
    /// By what factor it grows within a sample; 1 in continuous time.
    fn grows_by(&self) -> f64 {
        if self.sampled {
            self.mode.pole.norm()
        } else {
            1.0
        }
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

impl DesignError {
    /// The same with the mode's state by its name and its pole in 1/s.
    pub(super) fn of_states(mut self, states: &[Signal], ts_s: Option<f64>) -> DesignError {
        use DesignError as E;
        if let E::Uncontrollable { mode, .. }
        | E::LostBySampling { mode, .. }
        | E::Unweighted { mode, .. }
        | E::NoSolution {
            weakest: Some(mode),
        } = &mut self
        {
            mode.ts_s = ts_s;
            mode.state = states.get(mode.mode.state).map(|it| it.name.clone());
        }
        self
    }
}

fn nearest(weakest: Option<&PlantMode>) -> String {
    weakest.map_or_else(String::new, |mode| {
        format!(
            "; {mode} is the hardest to control, {:.1e} from impossible",
            mode.mode.margin
        )
    })
}

impl DesignError {
    /// Whether it lies in the request's own numbers, whatever the model is.
    pub fn in_request(&self) -> bool {
        use DesignError as E;
        matches!(
            self,
            E::Pose(_)
                | E::HeldBeyondLimit { .. }
                | E::SamplingTime(_)
                | E::Delay { .. }
                | E::DiagonalSize { .. }
                | E::ListSize { .. }
                | E::Entry { .. }
                | E::Indefinite { .. }
                | E::NotDefinite { .. }
                | E::IntegralContinuous
                | E::WordLength(_)
                | E::Count { .. }
                | E::NotPositive { .. }
        )
    }
}

impl From<DesignError> for Error {
    fn from(error: DesignError) -> Error {
        Error::Design(Box::new(error))
    }
}
