//! What the owner of a model knows of its values before any log: a scale reads to one per cent, a
//! moment of inertia from a drawing to a fifth.
//!
//! A fit takes it as a prior, a normal distribution about the given value (of the logarithm where
//! the value is positive): every value may move a little, and one that no log tells stays where
//! its owner put it.

use super::{JointField, LinkField, Model, ParameterPath};

/// A value of the model that is known, but not exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncertainValue {
    /// Its address.
    pub path: ParameterPath,
    /// What its owner believes it to be.
    pub given: f64,
    /// Standard uncertainty: a share of the given value, or in the value's unit where that is 0.
    pub uncertainty: f64,
}

/// What is known beforehand, at one value: half of the squared distance's first two derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Inverse variance, in the value's unit to the power of -2.
    pub precision: f64,
    /// Where it pulls the value: the squared distance's descent, halved.
    pub pull: f64,
    /// Distance from what is believed, in standard uncertainties.
    pub distance: f64,
}

impl UncertainValue {
    /// The prior at a value.
    pub fn at(&self, value: f64) -> Prior {
        let is_ratio = self.given > 0.0 && self.path.possible().0 >= 0.0;
        let (distance, slope) = if is_ratio {
            let value = value.max(f64::MIN_POSITIVE);
            let distance = (value / self.given).ln() / self.uncertainty;
            (distance, 1.0 / (value * self.uncertainty))
        } else {
            let size = self.uncertainty * self.size();
            ((value - self.given) / size, 1.0 / size)
        };
        Prior {
            precision: slope * slope,
            pull: -distance * slope,
            distance,
        }
    }

    /// Whether its owner would not wonder at a value: within two standard uncertainties.
    pub fn allows(&self, value: f64) -> bool {
        self.at(value).distance.abs() <= 2.0
    }

    /// What the uncertainty is a share of.
    fn size(&self) -> f64 {
        if self.given == 0.0 {
            1.0
        } else {
            self.given.abs()
        }
    }
}

impl Model {
    /// What is known beforehand of the value there; `None` where nothing is.
    pub fn uncertain(&self, path: ParameterPath) -> Option<&UncertainValue> {
        self.uncertain.iter().find(|value| value.path == path)
    }

    /// Forgets what is known beforehand of these values.
    pub fn forget(&mut self, paths: &[ParameterPath]) {
        self.uncertain.retain(|known| !paths.contains(&known.path));
    }

    /// How far another value lies from what the model says, in standard uncertainties: those that
    /// its owner states, else the [typical] ones, or half of a value that is an effect's. 0 where
    /// the model has none, or 0.
    pub fn deviation(&self, path: ParameterPath, value: f64) -> f64 {
        let given = path.get(self).filter(|given| *given != 0.0);
        let of_kind = |given| UncertainValue {
            path,
            given,
            uncertainty: typical(path).unwrap_or(OF_EFFECTS),
        };
        let known = (self.uncertain(path).copied()).or_else(|| given.map(of_kind));
        known.map_or(0.0, |known| known.at(value).distance.abs())
    }

    /// The values whose uncertainty is [typical] of their kind.
    pub fn typically_uncertain(&self) -> Vec<UncertainValue> {
        let links = (0..self.links.len()).flat_map(|index| {
            let fields = LinkField::ALL.into_iter();
            fields.map(move |field| ParameterPath::Link { index, field })
        });
        let joints = (0..self.joints.len()).flat_map(|index| {
            let fields = JointField::ALL.into_iter();
            fields.map(move |field| ParameterPath::Joint { index, field })
        });
        let value = |path: ParameterPath| {
            let given = path.get(self).filter(|value| value.is_finite())?;
            (given != 0.0).then_some(UncertainValue {
                path,
                given,
                uncertainty: typical(path)?,
            })
        };
        links.chain(joints).filter_map(value).collect()
    }
}

/// Share of an effect's value by which no one would wonder to find another: friction and rotors are
/// seldom on a data sheet.
const OF_EFFECTS: f64 = 0.5;

/// Standard uncertainty of a value of this kind, as a share of it, where its owner says no more:
/// what is weighed with the link's cables, computed from a drawing, or found in a data sheet.
/// Lengths are measured; what is an effect's is not known beforehand.
pub fn typical(path: ParameterPath) -> Option<f64> {
    match path {
        ParameterPath::Link { field, .. } => match field {
            LinkField::Length => None,
            LinkField::Mass | LinkField::Com => Some(0.05),
            LinkField::Inertia => Some(0.2),
        },
        ParameterPath::Joint { .. } => Some(0.15),
        ParameterPath::Effect { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mass(given: f64, uncertainty: f64) -> UncertainValue {
        UncertainValue {
            path: "link1.mass_kg".parse().unwrap(),
            given,
            uncertainty,
        }
    }

    /// Half the mass is as far off as twice the mass.
    #[test]
    fn what_is_positive_is_known_by_its_ratio() {
        let known = mass(0.2, 0.1);
        let [half, twice] = [0.1, 0.4].map(|value| known.at(value).distance);
        assert!((half + twice).abs() < 1e-12, "{half} {twice}");
        assert!((twice - 2.0_f64.ln() / 0.1).abs() < 1e-12);
        assert_eq!(known.at(0.2).distance, 0.0);
    }

    #[test]
    fn the_pull_leads_down_the_squared_distance() {
        let com = UncertainValue {
            path: "link1.com_m".parse().unwrap(),
            ..mass(-0.05, 0.1)
        };
        let zero = UncertainValue { given: 0.0, ..com };
        for (known, value) in [(mass(0.2, 0.1), 0.23), (com, -0.04), (zero, 0.01)] {
            let (step, prior) = (1e-7, known.at(value));
            let [below, above] = [-step, step].map(|step| known.at(value + step).distance.powi(2));
            let descent = -(above - below) / (4.0 * step);
            assert!(
                (prior.pull / descent - 1.0).abs() < 1e-5,
                "{prior:?} {descent}"
            );
            let precision = (prior.pull / prior.distance).powi(2);
            assert!((prior.precision / precision - 1.0).abs() < 1e-12);
        }
    }
}
