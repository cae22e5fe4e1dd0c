//! The fixed-point law of a design: ranges and steps of all that its table multiplies.

use super::Design;
use crate::error::Problem;
use crate::synth::error::DesignError;
use crate::synth::fixed_law::{FixedLaw, Loss};
use crate::synth::integral::{Integral, Sums};
use crate::synth::quantise::{Format, Ranges, largest_word, power_of_two_above, quantise};
use crate::synth::request::Request;
use crate::synth::system::Discrete;

/// A law in fixed point.
#[derive(Debug, Clone)]
pub struct FixedDesign {
    /// What it covers.
    pub ranges: Ranges,
    /// The table.
    pub law: FixedLaw,
    /// How the caller keeps the sums of angles among the states.
    pub sums: Option<Sums>,
    /// What rounding costs.
    pub loss: Loss,
}

impl Design {
    /// The gains in fixed point, with their sums and past inputs.
    pub(super) fn fixed(
        &self,
        request: &Request,
        plant: &Discrete,
        mut ranges: Ranges,
    ) -> Result<FixedDesign, DesignError> {
        let Ranges { state, input } = &mut ranges;
        let mut format = request.format.clone();
        let mut sums = None;
        if let Some(integral) = &self.integral {
            sums = Some(self.sums(integral, plant.ts_s, input, state, &mut format)?);
        }
        if plant.delayed_inputs > 0 {
            // Past inputs come back in the steps in which they went out.
            let word = largest_word(format.bits);
            let step = |range: &f64| power_of_two_above(range / word);
            let input_step = format.input_step.take();
            // As states they count from zero, and so reach the operating point's input as well.
            let past = input.iter().zip(&self.u0);
            let past = past.map(|(range, u)| step(&(range + u.abs())));
            let input_step = input_step.unwrap_or_else(|| past.collect());
            let mut steps = match format.state_step.take() {
                Some(steps) => steps,
                None => self.own_steps(state, word),
            };
            for _ in 0..plant.delayed_inputs {
                steps.extend(&input_step);
                state.extend(&*input);
            }
            (format.state_step, format.input_step) = (Some(steps), Some(input_step));
        }
        let law = quantise(&self.gains.k, &self.x0, &self.u0, &ranges, &format)?;
        let loss = law.loss(plant, &self.gains, &self.x0, &self.u0, &ranges.state)?;
        if loss.radius_fixed >= 1.0 {
            return Err(DesignError::Rounded(Problem::new(
                format!(
                    "rounded to {} bits the gains no longer stabilise: the spectral radius is \
                     {:.6}",
                    law.bits, loss.radius_fixed
                ),
                "declare smaller ranges: steps and gains are rounded to what they need",
            )));
        }
        Ok(FixedDesign {
            ranges,
            law,
            sums,
            loss,
        })
    }

    /// The sums in fixed point: their ranges and steps join those of the plant's own states.
    fn sums(
        &self,
        integral: &Integral,
        ts_s: f64,
        input: &[f64],
        state: &mut Vec<f64>,
        format: &mut Format,
    ) -> Result<Sums, DesignError> {
        let (own, word) = (self.plant.a.nrows(), largest_word(format.bits));
        let range = integral.range(&self.gains.k, own, input);
        let range = range.ok_or_else(|| {
            DesignError::model(
                "the gains of the integrals are singular: some sum acts on no input",
                "raise the weight of the integrals",
            )
        })?;
        let mut steps = match format.state_step.take() {
            Some(steps) => steps,
            None => self.own_steps(state, word),
        };
        let (shift, sum_step) = integral.in_words(ts_s, &steps, &range, word);
        steps.extend(sum_step);
        state.extend(range);
        format.state_step = Some(steps);
        Ok(Sums {
            first: own,
            joints: integral.joints.clone(),
            shift,
        })
    }

    /// Powers of two that let the plant's own states reach `range` about the operating point.
    fn own_steps(&self, range: &[f64], word: f64) -> Vec<f64> {
        let reach = range.iter().zip(&self.x0);
        reach
            .map(|(range, x)| power_of_two_above((range + x.abs()) / word))
            .collect()
    }
}
