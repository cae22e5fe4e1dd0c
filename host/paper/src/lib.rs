//! The paper's numbers, figures and findings, compared with recomputed values.
//!
//! `printed` holds what it prints, `computed` what follows from its Table 1, `checked` sets them
//! side by side; `case` is a run of the robot, `robot` and `servo` draw what its figures show;
//! `findings` says of each result whether it holds; `humanoid` is the whole robot that Table 1's
//! three links are when it is held still.

mod case;
mod checked;
mod computed;
mod figure;
mod findings;
mod humanoid;
mod identification;
mod page;
mod printed;
mod pushed_servo;
mod robot;
mod servo;

#[cfg(test)]
mod tests;

pub use checked::{Agreement, CheckedNumber, check};
pub use computed::{Computed, ServoFacts, Zeros};
pub use figure::{Holds, PaperFigure};
pub use findings::{Finding, findings};
pub use humanoid::{BlockValue, LumpedBlock, LumpedValues, humanoid_urdf, lumped_blocks};
pub use page::{block_columns, follows, html, number_columns, rest_of_blocks};
pub use printed::{Printed, PrintedQuantity, printed};

use handstand_control::{synth, sysid};
use handstand_model::{error, model, motion, output};
use handstand_report as report;
use handstand_report::plot;
use handstand_sim::sim;
use handstand_study as study;

use crate::error::Result;

/// Everything the page shows.
#[derive(Debug, Clone)]
pub struct Reproduction {
    /// Printed against computed.
    pub rows: Vec<CheckedNumber>,
    /// What follows from them without being printed.
    pub computed: Computed,
    /// The figures, redrawn.
    pub figures: Vec<PaperFigure>,
    /// What the paper found.
    pub findings: Vec<Finding>,
}

/// Checks the numbers, draws the figures, judges the findings. `done` is called after each of
/// [`STEPS`] steps.
///
/// # Errors
/// None is known: the models are the project's own.
pub fn reproduce(done: &dyn Fn(&str)) -> Result<Reproduction> {
    let computed = Computed::new()?;
    done("numbers");
    let mut figures = servo::figures()?;
    done("servo");
    figures.extend(robot::figures()?);
    done("handstand");
    let rows = check(&computed);
    let findings = findings(&computed, &figures)?;
    done("findings");
    Ok(Reproduction {
        rows,
        computed,
        figures,
        findings,
    })
}

/// Steps of [`reproduce`].
pub const STEPS: u64 = 4;
