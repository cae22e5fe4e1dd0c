//! Floating point against the board's 16-bit law.

use crate::study::{Case, Sweep, SweepCard};

/// Word length of the law: floating point, or the 16 bits of the board.
#[derive(Debug)]
pub struct FloatFixed;

static CARD: SweepCard = SweepCard {
    id: "float-fixed",
    title: "arithmetic",
    unit: "bits",
    meaning: "Word length of the law: floating point, or the 16 bits of the board.",
    levels: &[0.0, 16.0],
    bounds: (0.0, 32.0),
};

impl Sweep for FloatFixed {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.design.word_bits = level as u32;
    }

    fn label(&self, level: f64) -> String {
        match level {
            0.0 => "float".to_string(),
            bits => format!("fixed, {bits} bits"),
        }
    }
}
