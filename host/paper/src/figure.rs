//! A figure redrawn: its charts, and whether what the paper says of it holds.

use crate::plot::Chart;
use serde::Serialize;

/// Whether a conclusion holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Holds {
    /// It does.
    #[serde(rename = "holds")]
    Yes,
    /// Not everywhere: the sentence says where.
    #[serde(rename = "holds in part")]
    InPart,
    /// It does not.
    #[serde(rename = "does not hold")]
    No,
    /// Another command shows it.
    #[serde(rename = "shown by the command")]
    ShownElsewhere,
    /// Not reproducible with this project alone.
    #[serde(rename = "not reproducible here")]
    NotReproducible,
}

impl Holds {
    /// It does, or it does not.
    pub fn when(holds: bool) -> Holds {
        if holds { Holds::Yes } else { Holds::No }
    }

    /// It does, or does in part.
    pub fn at_least_in_part(wholly: bool) -> Holds {
        if wholly { Holds::Yes } else { Holds::InPart }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Holds::Yes => "holds",
            Holds::InPart => "holds in part",
            Holds::No => "does not hold",
            Holds::ShownElsewhere => "shown by the command",
            Holds::NotReproducible => "not reproducible here",
        }
    }
}

/// One of the paper's figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PaperFigure {
    /// Its number there: "4", "13".
    pub number: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What the paper concludes.
    pub claim: &'static str,
    /// Charts, two in a row.
    #[serde(skip)]
    pub charts: Vec<Chart>,
    /// Whether that holds here.
    #[serde(rename = "verdict")]
    pub holds: Holds,
    /// With numbers.
    pub sentence: String,
}
