//! Parts of the search that can be left out, to measure what each brings.

/// A part of the search. `cargo xtask ablation` measures what it brings, and costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// Every candidate beside the leading sets, in other windows where the model loses the first.
    SecondSearch,
    /// Learning from motions held out that alone show something.
    Turns,
    /// The best sets less each of their effects.
    TakingApart,
    /// The simplest part of the best set that does as well.
    SmallestPart,
    /// Plainer laws in the place of those that the motions do not determine, or that rest on a
    /// bound.
    PlainestLaw,
    /// A look at candidates that their derivatives led astray.
    MisledGlances,
    /// Fits from the values of the file: of laws that jump, and of all where refitting bent them.
    Restarts,
    /// A horizon chosen by what single effects gain.
    ChosenHorizon,
    /// A longer horizon once a set follows it.
    LongerHorizon,
    /// Random starts where samples are few.
    RandomStarts,
}

impl Strategy {
    /// All, in the order in which a diagnosis comes to them.
    pub const ALL: [Strategy; 10] = [
        Strategy::MisledGlances,
        Strategy::RandomStarts,
        Strategy::Restarts,
        Strategy::ChosenHorizon,
        Strategy::LongerHorizon,
        Strategy::TakingApart,
        Strategy::SmallestPart,
        Strategy::PlainestLaw,
        Strategy::Turns,
        Strategy::SecondSearch,
    ];

    /// What a command calls it.
    pub fn name(self) -> &'static str {
        match self {
            Strategy::MisledGlances => "misled-glances",
            Strategy::RandomStarts => "random-starts",
            Strategy::Restarts => "restarts",
            Strategy::ChosenHorizon => "chosen-horizon",
            Strategy::LongerHorizon => "longer-horizon",
            Strategy::TakingApart => "taking-apart",
            Strategy::SmallestPart => "smallest-part",
            Strategy::PlainestLaw => "plainest-law",
            Strategy::Turns => "turns",
            Strategy::SecondSearch => "second-search",
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
