//! Gains or weights of one's own, for commands that judge controllers.

use super::weight_arg::{WeightArg, weight};
use handstand::study::Case;
use handstand::synth::StateFeedbackPlan;
use handstand::synth::controllers::{ControllerDesign, GivenGains};
use handstand::{Model, Result};
use std::path::PathBuf;

/// Gains or weights of one's own.
#[derive(Debug, Clone, clap::Args)]
pub struct GainsChoice {
    /// Judge these gains: what `handstand gains MODEL --json` printed; the controller `plan`
    #[arg(long, value_name = "FILE.json")]
    plan: Option<PathBuf>,
    /// Weight of the states, for controllers that let it be chosen: a number, a diagonal, or a CSV
    /// file of a matrix [default: 100]
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    q: Option<WeightArg>,
    /// Weight of the torques, likewise [default: 1]
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    r: Option<WeightArg>,
}

impl GainsChoice {
    /// The controller of `--plan`, for `model` sampled every `period_s`; none without it. It lives
    /// as long as the program, as all controllers do.
    ///
    /// # Errors
    /// A file that cannot be read, or gains for another robot.
    pub fn design(
        &self,
        model: &Model,
        period_s: f64,
    ) -> Result<Option<&'static dyn ControllerDesign>> {
        let Some(file) = &self.plan else {
            return Ok(None);
        };
        let plan = StateFeedbackPlan::load(file, model)?;
        let given: &'static GivenGains =
            Box::leak(Box::new(GivenGains::new(&plan, model, period_s)?));
        Ok(Some(given))
    }

    /// Puts the weights into a case.
    ///
    /// # Errors
    /// Files that cannot be read.
    pub fn weigh(&self, case: &mut Case) -> Result<()> {
        if let Some(q) = &self.q {
            case.control.q = q.read()?;
        }
        if let Some(r) = &self.r {
            case.control.r = r.read()?;
        }
        Ok(())
    }

    /// Puts gains and weights into a case.
    ///
    /// # Errors
    /// Those of both.
    pub fn put_into(&self, case: &mut Case) -> Result<()> {
        self.weigh(case)?;
        if let Some(given) = self.design(&case.nominal, case.clock.period_s)? {
            case.control.design = given;
        }
        Ok(())
    }

    /// These controllers and that of `--plan`: it alone where none is named.
    ///
    /// # Errors
    /// As [`GainsChoice::design`].
    pub fn designs(
        &self,
        named: &[String],
        designs: Vec<&'static dyn ControllerDesign>,
        (model, period_s): (&Model, f64),
    ) -> Result<Vec<&'static dyn ControllerDesign>> {
        Ok(match (self.design(model, period_s)?, named) {
            (None, _) => designs,
            (Some(given), []) => vec![given],
            (Some(given), _) => [vec![given], designs].concat(),
        })
    }
}
