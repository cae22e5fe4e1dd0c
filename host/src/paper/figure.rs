//! A figure redrawn: its charts, and whether what the paper says of it holds.

use crate::plot::Chart;

/// Whether a conclusion holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holds {
    /// It does.
    Yes,
    /// Not everywhere: the sentence says where.
    InPart,
    /// It does not.
    No,
}

impl Holds {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Holds::Yes => "holds",
            Holds::InPart => "holds in part",
            Holds::No => "does not hold",
        }
    }
}

/// One of the paper's figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its number there: "4", "13".
    pub number: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What the paper concludes.
    pub claim: &'static str,
    /// Charts, two in a row.
    pub charts: Vec<Chart>,
    /// Whether that holds here.
    pub holds: Holds,
    /// With numbers.
    pub sentence: String,
}
