//! A figure redrawn: panels of curves, and whether what the paper says of it holds.

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

/// Colour of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// What was told or measured.
    Dark,
    /// First.
    Blue,
    /// Second.
    Orange,
    /// Third.
    Green,
    /// For reference.
    Quiet,
}

/// A curve, or points.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// Places.
    pub points: Vec<(f64, f64)>,
    /// Drawn as dots rather than as a line.
    pub dots: bool,
}

impl Curve {
    /// A line.
    pub fn line(name: impl Into<String>, ink: Ink, points: Vec<(f64, f64)>) -> Self {
        Curve {
            name: name.into(),
            ink,
            points,
            dots: false,
        }
    }

    /// Dots.
    pub fn dots(name: impl Into<String>, ink: Ink, points: Vec<(f64, f64)>) -> Self {
        Curve {
            dots: true,
            ..Curve::line(name, ink, points)
        }
    }
}

/// One chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Along the bottom.
    pub x_label: &'static str,
    /// Up the side.
    pub y_label: &'static str,
    /// What is drawn.
    pub curves: Vec<Curve>,
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
    pub panels: Vec<Panel>,
    /// Whether that holds here.
    pub holds: Holds,
    /// With numbers.
    pub sentence: String,
}
