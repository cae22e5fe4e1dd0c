//! What mends a request of which no design follows.

use super::{DesignError, MOST_GROWTH};
use crate::error::Reason;
use std::borrow::Cow;

impl Reason for DesignError {
    fn remedy(&self) -> Cow<'_, str> {
        use DesignError as E;
        Cow::Borrowed(match self {
            E::NothingDriven { .. } => "give a [[joint]] another drive than passive",
            E::NoInertia { .. } => "give every link a mass and an inertia",
            E::DelaysDiffer { .. } => {
                "give every driven joint the same delay, or choose one with --delay"
            }
            E::Pose(reason) => return reason.remedy(),
            E::NoEquilibrium { .. } => {
                "choose a pose in which every passive joint balances; --balance finds the nearest"
            }
            E::EquilibriumNotFound => "start from a pose nearer to balance",
            E::SlideFiltered { .. } => "leave --lqg out",
            E::DriveTooWeak { .. } => "choose a pose that asks less of it",
            E::HeldBeyondLimit { .. } => {
                "raise the limit (--limit), or choose a pose that asks less of the drive"
            }
            E::SamplingTime(_) => "give seconds above 0",
            E::Delay { most_samples, .. } => {
                return format!("give a delay from 0 to {most_samples} samples").into();
            }
            E::GrowsWithinSample(_) => "sample faster",
            E::DiagonalSize { .. }
            | E::ListSize { .. }
            | E::MatrixSize { .. }
            | E::Entry { .. }
            | E::Asymmetric { .. }
            | E::Indefinite { .. }
            | E::NotDefinite { .. } => return self.matrix_remedy(),
            E::IntegralContinuous => "leave out one of the two",
            E::IntegralUnused => "raise the weight of the integrals",
            E::Innovation => "raise the measurement noise V",
            E::Eigenvalues => "look for entries that are not numbers or of very different size",
            E::Uncontrollable { mode, .. }
            | E::NoSolution {
                weakest: Some(mode),
            } if mode.grows_by() > MOST_GROWTH => {
                return format!(
                    "sample faster: within one sample the mode grows by a factor of {:.3e}",
                    mode.grows_by()
                )
                .into();
            }
            E::LostBySampling { faster: true, .. } => "sample faster",
            E::LostBySampling { faster: false, .. } => "sample more slowly",
            E::Uncontrollable { role, .. } => role.uncontrollable().1,
            E::Unweighted { role, .. } => role.unweighted().1,
            E::NoSolution { .. } => {
                "scale the weights to like sizes, sample slower, or drive more joints"
            }
            E::WordLength(_) => "choose 8 to 32 bits",
            E::Count { of, .. } => return format!("give one per {of}, or one for all").into(),
            E::NotPositive { .. } => "give a number above 0",
            E::BeyondWord { .. } => "declare a smaller range, or a coarser step",
            E::Overflow { .. } => "declare smaller ranges, or take a coarser input step",
            E::UnstableWhenRounded { .. } => {
                "declare smaller ranges: steps and gains are rounded to what they need"
            }
            E::UnstableStart => "start from plants that differ less",
            E::SpreadTooWide { .. } => "ask for less spread, or for more stages on the way",
        })
    }
}

impl DesignError {
    /// Of a weight's or a noise's matrix.
    fn matrix_remedy(&self) -> Cow<'_, str> {
        use DesignError as E;
        Cow::Borrowed(match self {
            E::DiagonalSize { .. } | E::ListSize { .. } => {
                "give one number for all, or one for each"
            }
            E::MatrixSize { name, size, .. } => {
                return format!(
                    "give {name} as {size} x {size}, as its diagonal, or as one number"
                )
                .into();
            }
            E::Asymmetric { name, .. } => {
                return format!("give its symmetric part, half of {name} plus its transpose")
                    .into();
            }
            E::Indefinite { name, .. } => {
                return format!(
                    "no weight or variance is negative: raise the eigenvalues of {name} to 0 or \
                     above"
                )
                .into();
            }
            E::NotDefinite { name, of, .. } => {
                return format!(
                    "give every one of the {of} a weight or variance above 0 in {name}"
                )
                .into();
            }
            _ => "give numbers",
        })
    }
}
