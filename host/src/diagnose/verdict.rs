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
    /// Whether a placebo regressor gains about as much as the effects.
    pub placebo_ranks: bool,
    /// Whether other explanations do as well.
    pub rivals: bool,
}

/// Share of what is left that a free form must significantly gain before the explanation counts as
/// incomplete.
const UNEXPLAINED_LOW: f64 = 0.2;
/// The same for the estimate itself.
const UNEXPLAINED_SHARE: f64 = 0.35;
/// An explanation that leaves more than this share of the squared error above the noise is not the
/// whole of it.
const MOST_LEFT: f64 = 0.125;
/// So does one that leaves more than so many times the noise: what is true leaves hardly more than
/// the noise, and what only resembles it leaves most.
const MOST_FLOORS: f64 = 5.0;
/// Where more than this share of what is left goes as every motion gets values of its own, they are
/// no constants.
const MOST_VARYING: f64 = 0.5;
/// A model that leaves more than so many floors is not nominal.
const MOST_NOMINAL: f64 = 1.5;
/// Mean squared weighted error from which the noise no longer excuses it.
const FAR_OFF: f64 = 2.0;

impl Signs {
    pub fn verdict(&self) -> Verdict {
        match self.kind {
            Kind::Given if !self.at_noise_floor && self.tolerated => Verdict::Adequate,
            _ if self.is_incomplete() => Verdict::Unexplained,
            Kind::Given => Verdict::Nominal,
            _ if self.placebo_ranks => Verdict::Unexplained,
            _ if self.rivals => Verdict::Ambiguous,
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
        if self.at_noise_floor {
            return false;
        }
        match (self.kind, self.held_out) {
            (Kind::Given, _) => self.left.sqrt() > MOST_NOMINAL || self.is_structured(),
            (_, true) => self.is_structured() || self.leaves_much() || self.values_vary(),
            // Motions that were fitted show too little of what is left; what they show is there.
            (_, false) => self.leaves_much(),
        }
    }

    /// Whether what is left has a structure. Far above the noise, structure needs less proof.
    fn is_structured(&self) -> bool {
        let least = match self.left.sqrt() > FAR_OFF * FAR_OFF {
            true => 0.0,
            false => UNEXPLAINED_LOW,
        };
        self.free_form_low > least && self.free_form_share > UNEXPLAINED_SHARE
    }

    /// Whether the explanation leaves a good part of the squared error above the noise, or an error
    /// far above it.
    fn leaves_much(&self) -> bool {
        let share = (self.left - 1.0) / (self.before - 1.0);
        self.left > FAR_OFF && (share > MOST_LEFT || self.left.sqrt() > MOST_FLOORS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Effects that explain all but noise.
    const FOUND: Signs = Signs {
        kind: Kind::Effects,
        before: 400.0,
        left: 1.3,
        at_noise_floor: true,
        held_out: true,
        tolerated: false,
        free_form_share: 0.0,
        free_form_low: 0.0,
        per_motion_reduction: 0.0,
        placebo_ranks: false,
        rivals: false,
    };
    /// The same with something left above the noise.
    const ABOVE: Signs = Signs {
        left: 1.8,
        at_noise_floor: false,
        ..FOUND
    };
    const GIVEN: Signs = Signs {
        kind: Kind::Given,
        before: 1.1,
        left: 1.1,
        ..FOUND
    };

    #[test]
    fn what_explains_all_is_named_by_its_kind() {
        assert_eq!(FOUND.verdict(), Verdict::Named);
        assert_eq!(ABOVE.verdict(), Verdict::Named);
        let values = Signs {
            kind: Kind::Values,
            ..FOUND
        };
        assert_eq!(values.verdict(), Verdict::WrongValue);
        assert_eq!(GIVEN.verdict(), Verdict::Nominal);
    }

    #[test]
    fn with_rivals_nothing_is_named() {
        for kind in [Kind::Values, Kind::Effects] {
            let signs = Signs {
                kind,
                rivals: true,
                ..FOUND
            };
            assert_eq!(signs.verdict(), Verdict::Ambiguous);
        }
    }

    #[test]
    fn what_a_placebo_gains_too_proves_nothing() {
        let signs = Signs {
            placebo_ranks: true,
            ..FOUND
        };
        assert_eq!(signs.verdict(), Verdict::Unexplained);
    }

    #[test]
    fn a_model_as_given_is_nominal_only_near_the_floor() {
        let left = |left: f64| Signs {
            left,
            at_noise_floor: false,
            ..GIVEN
        };
        assert_eq!(left(1.49 * 1.49).verdict(), Verdict::Nominal);
        assert_eq!(left(1.51 * 1.51).verdict(), Verdict::Unexplained);
        let fitted = Signs {
            held_out: false,
            ..left(4.0)
        };
        assert_eq!(fitted.verdict(), Verdict::Unexplained);
    }

    #[test]
    fn a_tolerance_makes_a_model_adequate_but_not_nominal() {
        let above = Signs {
            left: 9.0,
            at_noise_floor: false,
            tolerated: true,
            ..GIVEN
        };
        assert_eq!(above.verdict(), Verdict::Adequate);
        assert_eq!(
            Signs {
                tolerated: true,
                ..GIVEN
            }
            .verdict(),
            Verdict::Nominal
        );
    }

    #[test]
    fn structure_in_what_is_left_must_be_sure_and_large() {
        let structured = |share: f64, low: f64| Signs {
            free_form_share: share,
            free_form_low: low,
            ..ABOVE
        };
        assert_eq!(structured(0.4, 0.21).verdict(), Verdict::Unexplained);
        assert_eq!(structured(0.3, 0.21).verdict(), Verdict::Named);
        assert_eq!(structured(0.4, 0.19).verdict(), Verdict::Named);
        // Far above the noise less is asked for.
        let far = Signs {
            before: 1e4,
            left: 17.0,
            ..structured(0.4, 0.01)
        };
        assert_eq!(far.verdict(), Verdict::Unexplained);
        assert_eq!(
            Signs {
                free_form_low: -0.01,
                ..far
            }
            .verdict(),
            Verdict::Named
        );
    }

    #[test]
    fn an_eighth_of_the_squared_error_may_be_left() {
        let left = |left: f64| Signs {
            before: 81.0,
            left,
            ..ABOVE
        };
        assert_eq!(left(10.9).verdict(), Verdict::Named);
        assert_eq!(left(11.1).verdict(), Verdict::Unexplained);
        // Near the noise a larger share may.
        assert_eq!(
            Signs {
                before: 4.0,
                ..left(1.9)
            }
            .verdict(),
            Verdict::Named
        );
        assert_eq!(
            Signs {
                before: 4.0,
                ..left(2.1)
            }
            .verdict(),
            Verdict::Unexplained
        );
    }

    #[test]
    fn what_leaves_five_times_the_noise_is_not_the_whole_however_much_it_removes() {
        let left = |rms: f64| Signs {
            before: 1e6,
            left: rms * rms,
            ..ABOVE
        };
        assert_eq!(left(4.9).verdict(), Verdict::Named);
        assert_eq!(left(5.1).verdict(), Verdict::Unexplained);
        // What is left of the motions that were fitted is left of others too.
        let fitted = Signs {
            held_out: false,
            ..left(5.1)
        };
        assert_eq!(fitted.verdict(), Verdict::Unexplained);
    }

    #[test]
    fn a_law_has_the_same_values_in_all_motions() {
        let varying = Signs {
            per_motion_reduction: 0.51,
            ..ABOVE
        };
        assert_eq!(varying.verdict(), Verdict::Unexplained);
        assert_eq!(
            Signs {
                per_motion_reduction: 0.49,
                ..ABOVE
            }
            .verdict(),
            Verdict::Named
        );
        // Motions that were fitted show too little of it.
        assert_eq!(
            Signs {
                held_out: false,
                ..varying
            }
            .verdict(),
            Verdict::Named
        );
    }
}
