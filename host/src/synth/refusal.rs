//! Why a Riccati equation has no stabilising solution: the mode that stands in the way.

use super::eigen::{Mode, modes};
use super::riccati::{Kind, Problem};
use crate::error::Error;

/// A mode closer than this to being out of reach cannot be moved.
const OUT_OF_REACH: f64 = 1e-9;

/// How a refusal speaks of inputs and weights.
#[derive(Debug)]
pub(super) struct Words {
    unreached: &'static str,
    reach: &'static str,
    unweighed: &'static str,
    weigh: &'static str,
}

/// Of a regulator.
pub(super) const REGULATOR: Words = Words {
    unreached: "no input reaches it: the plant cannot be stabilised",
    reach: "drive a joint that moves this mode",
    unweighed: "Q does not weigh it, so the best gain leaves it alone",
    weigh: "weigh that state in Q",
};

/// Of an estimator, whose equation is that of a regulator of the transposed plant.
pub(super) const ESTIMATOR: Words = Words {
    unreached: "no output shows it: the state cannot be estimated",
    reach: "measure a state in which this mode shows",
    unweighed: "the process noise W does not excite it, so the best filter ignores it",
    weigh: "give that state process noise in W",
};

impl Problem<'_> {
    /// The reason for no stabilising solution.
    pub fn refusal(&self, words: &Words) -> Error {
        let lasting = |mode: &Mode| match self.kind {
            Kind::Continuous => mode.pole.re > -1e-9 * self.a.norm(),
            Kind::Discrete => mode.pole.norm() > 1.0 - 1e-9,
        };
        let marginal = |mode: &Mode| match self.kind {
            Kind::Continuous => mode.pole.re.abs() < 1e-7 * self.a.norm(),
            Kind::Discrete => (mode.pole.norm() - 1.0).abs() < 1e-7,
        };
        let nearest = |modes: Vec<Mode>, counts: &dyn Fn(&Mode) -> bool| {
            let counted = modes.into_iter().filter(counts);
            counted.min_by(|a, b| a.measure.total_cmp(&b.measure))
        };
        let worst = match modes(self.a, self.b) {
            Ok(modes) => nearest(modes, &lasting),
            Err(error) => return error,
        };
        if let Some(mode) = worst.as_ref().filter(|mode| mode.measure < OUT_OF_REACH) {
            return Error::design(
                format!("{}: {}", self.say(mode), words.unreached),
                words.reach,
            );
        }
        if let Ok(modes) = modes(&self.a.transpose(), self.q)
            && let Some(mode) = nearest(modes, &marginal).filter(|m| m.measure < OUT_OF_REACH)
        {
            return Error::design(
                format!("{}: {}", self.say(&mode), words.unweighed),
                words.weigh,
            );
        }
        let near = worst.map_or_else(String::new, |mode| {
            format!(
                "; {} is the hardest to reach, {:.1e} from impossible",
                self.say(&mode),
                mode.measure
            )
        });
        Error::design(
            format!("no stabilising solution was found within double precision{near}"),
            "scale the weights to like sizes, sample slower, or drive more joints",
        )
    }

    /// "the mode with pole 1.07+0.2i, strongest in state 3".
    fn say(&self, mode: &Mode) -> String {
        let unit = match self.kind {
            Kind::Continuous => " 1/s",
            Kind::Discrete => "",
        };
        let pole = match mode.pole.im {
            0.0 => format!("{:.6}", mode.pole.re),
            im => format!("{:.6}{im:+.6}i", mode.pole.re),
        };
        format!(
            "the mode with pole {pole}{unit}, strongest in state {}",
            mode.state + 1
        )
    }
}
