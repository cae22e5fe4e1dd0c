//! Parts of the search that can be left out, to measure what each brings.

/// A part of the search. `cargo xtask ablation` measures what it brings, and costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// A second search that spares no candidate, where the first explains nothing.
    SecondSearch,
    /// Learning from motions held out that alone show something.
    Turns,
    /// Members of the best set replaced by others.
    Swaps,
    /// Plainer laws in the place of those that rest on a bound.
    PlainerPartners,
    /// The best sets less each of their effects.
    TakingApart,
    /// What each joint has taken for one effect of all.
    Merging,
    /// Partners of the best set by what they change in its own prediction.
    GrowingAfresh,
    /// The simplest part of the best set that does as well.
    SmallestPart,
    /// Plainer laws in the place of those that the motions do not determine.
    PlainestLaw,
    /// Fits from every start of laws that jump.
    Restarts,
    /// The leader's fit through windows that grow.
    RestagedLeader,
    /// A look at candidates that their derivatives led astray.
    MisledGlances,
    /// Growing from the set that leaves least where it counts, too.
    LeastBehind,
    /// A horizon chosen by what single effects gain.
    ChosenHorizon,
    /// A longer horizon once a set follows it.
    LongerHorizon,
    /// A shorter horizon where all sets are lost.
    ShorterHorizon,
    /// Values that one motion found, tried on all.
    OwnFits,
    /// Random starts where samples are few.
    RandomStarts,
}

impl Strategy {
    /// All, in the order in which a diagnosis comes to them.
    pub const ALL: [Strategy; 18] = [
        Strategy::MisledGlances,
        Strategy::RandomStarts,
        Strategy::Restarts,
        Strategy::RestagedLeader,
        Strategy::ChosenHorizon,
        Strategy::LongerHorizon,
        Strategy::ShorterHorizon,
        Strategy::LeastBehind,
        Strategy::Swaps,
        Strategy::PlainerPartners,
        Strategy::TakingApart,
        Strategy::Merging,
        Strategy::GrowingAfresh,
        Strategy::SmallestPart,
        Strategy::PlainestLaw,
        Strategy::Turns,
        Strategy::SecondSearch,
        Strategy::OwnFits,
    ];

    /// What a command calls it.
    pub fn name(self) -> &'static str {
        match self {
            Strategy::MisledGlances => "misled-glances",
            Strategy::RandomStarts => "random-starts",
            Strategy::Restarts => "restarts",
            Strategy::RestagedLeader => "restaged-leader",
            Strategy::ChosenHorizon => "chosen-horizon",
            Strategy::LongerHorizon => "longer-horizon",
            Strategy::ShorterHorizon => "shorter-horizon",
            Strategy::LeastBehind => "least-behind",
            Strategy::Swaps => "swaps",
            Strategy::PlainerPartners => "plainer-partners",
            Strategy::TakingApart => "taking-apart",
            Strategy::Merging => "merging",
            Strategy::GrowingAfresh => "growing-afresh",
            Strategy::SmallestPart => "smallest-part",
            Strategy::PlainestLaw => "plainest-law",
            Strategy::Turns => "turns",
            Strategy::SecondSearch => "second-search",
            Strategy::OwnFits => "own-fits",
        }
    }

    /// The one that is called so.
    pub fn named(name: &str) -> Option<Strategy> {
        Strategy::ALL.into_iter().find(|own| own.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::Strategy;

    #[test]
    fn every_part_has_a_name_of_its_own() {
        for part in Strategy::ALL {
            assert_eq!(Strategy::named(part.name()), Some(part));
        }
        assert_eq!(Strategy::named("luck"), None);
    }
}
