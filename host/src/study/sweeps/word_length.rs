//! How short the law's words may be.

use crate::study::{Case, Sweep, SweepCard};

/// Word length of the fixed-point law's states, gains and torques.
#[derive(Debug)]
pub struct WordLength;

static CARD: SweepCard = SweepCard {
    id: "word-length",
    title: "word length",
    unit: "bits",
    meaning: "Word length of the fixed-point law's states, gains and torques.",
    levels: &[8.0, 9.0, 10.0, 11.0, 12.0, 14.0, 16.0, 20.0, 24.0, 32.0],
    bounds: (8.0, 32.0),
};

impl Sweep for WordLength {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.design.word_bits = level.round() as u32;
    }
}
