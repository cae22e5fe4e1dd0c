//! Everything that follows from a model and weights, as one value; `export` writes it in many ways.

use super::controllability::{Controllability, controllability, observability};
use super::eigen::{largest, poles};
use super::error::{DesignError, MOST_GROWTH};
use super::estimator::{Compensator, Estimator, kalman, lqg, rounding_variance};
use super::fixed_law::{FixedLaw, Loss};
use super::gains::{Gains, dlqr, lqr};
use super::linearise::{Linearisation, linearise};
use super::omitted::OmittedEffect;
use super::operating_point::input_delay_s;
use super::quantise::{Ranges, largest_word, power_of_two_above, quantise};
use super::request::{Request, Sensors, Time};
use super::signal::{Signal, input, states};
use super::system::{Continuous, Discrete};
use super::zeros::transmission_zeros;
use super::zoh;
use crate::model::Model;
use nalgebra::{Complex, DMatrix, DVector};

/// A finished design.
#[derive(Debug, Clone)]
pub struct Design {
    /// The model's name.
    pub model: String,
    /// The states that K multiplies.
    pub states: Vec<Signal>,
    /// The inputs it makes.
    pub inputs: Vec<Signal>,
    /// The operating point of the states, SI.
    pub x0: Vec<f64>,
    /// The inputs that hold it, SI.
    pub u0: Vec<f64>,
    /// Effects of the model that the design leaves out: they have no derivative at the operating
    /// point.
    pub omitted: Vec<OmittedEffect>,
    /// The plant in continuous time.
    pub plant: Continuous,
    /// The sampled plant, and the delay it holds, s.
    pub sampled: Option<(Discrete, f64)>,
    /// Q and R.
    pub weights: [DMatrix<f64>; 2],
    /// K and what goes with it.
    pub gains: Gains,
    /// Poles of the plant, 1/s.
    pub poles: Vec<Complex<f64>>,
    /// Zeros from the inputs to the angles of the driven joints, 1/s.
    pub zeros: Vec<Complex<f64>>,
    /// Controllability of the plant by its inputs.
    pub controllability: Controllability,
    /// Observability of the plant by its measured angles.
    pub observability: Controllability,
    /// The estimator.
    pub estimator: Option<Estimation>,
    /// The fixed-point law.
    pub fixed: Option<Fixed>,
}

/// An estimator and the controller it makes with the gains.
#[derive(Debug, Clone)]
pub struct Estimation {
    /// What is measured.
    pub outputs: Vec<Signal>,
    /// The plant with those outputs.
    pub plant: Discrete,
    /// The Kalman filter.
    pub estimator: Estimator,
    /// Gains and filter as one.
    pub compensator: Compensator,
}

/// A law in fixed point.
#[derive(Debug, Clone)]
pub struct Fixed {
    /// What it covers.
    pub ranges: Ranges,
    /// The table.
    pub law: FixedLaw,
    /// What rounding costs.
    pub loss: Loss,
}

impl Design {
    /// Everything that follows from `model` and `request`.
    ///
    /// # Errors
    /// Whatever stands in the way, with what to change.
    pub fn of(model: &Model, request: &Request) -> Result<Design, DesignError> {
        let slide = model.joints.iter().position(|joint| joint.slide.is_some());
        if let (Some(joint), true) = (slide, request.sensors.is_some()) {
            return Err(DesignError::SlideFiltered { joint });
        }
        let Linearisation {
            plant,
            inputs: u0,
            omitted,
        } = linearise(model, &request.pose_rad)?;
        let n = plant.a.nrows();
        let state_range = request.state_ranges(n)?;
        let input_range = request.input_ranges(model)?;
        let weigh = |with_past| {
            request
                .weights
                .matrices(&state_range, &input_range, with_past)
        };
        let (gains, sampled, weights) = match request.time {
            Time::Continuous => {
                let [q, r] = weigh(n)?;
                (lqr(&plant, &q, &r)?, None, [q, r])
            }
            Time::Sampled { ts_s, delay_s } => {
                let delay_s = delay_s.map_or_else(|| input_delay_s(model), Ok)?;
                let sampled = zoh(&plant, ts_s, delay_s)?;
                let [q, r] = weigh(sampled.a.nrows())?;
                let gains = dlqr(&sampled, &q, &r);
                let gains = gains.map_err(|error| by_sampling(error, &plant, ts_s))?;
                (gains, Some((sampled, delay_s)), [q, r])
            }
        };
        let driven = model.driven_joints();
        let outputs = plant.c.select_rows(&driven);
        let angles = plant.c.rows(0, model.link_count()).into_owned();
        let inputs: Vec<Signal> = driven.iter().map(|joint| input(model, *joint)).collect();
        let delayed = sampled
            .as_ref()
            .map_or(0, |(sampled, _)| sampled.delayed_inputs);
        let mut design = Design {
            model: model.name.clone(),
            states: states(model, &inputs, delayed),
            x0: point(&request.pose_rad, &u0, delayed),
            u0,
            omitted,
            poles: poles(&plant.a)?,
            zeros: transmission_zeros(&plant.a, &plant.b, &outputs)?,
            controllability: controllability(&plant.a, &plant.b)?,
            observability: observability(&plant.a, &angles)?,
            weights,
            inputs,
            plant,
            sampled,
            gains,
            estimator: None,
            fixed: None,
        };
        if let Some((sampled, _)) = design.sampled.clone() {
            let ranges = Ranges {
                state: state_range,
                input: input_range.clone(),
            };
            design.fixed = Some(design.fixed(request, &sampled, ranges)?);
            if let Some(sensors) = &request.sensors {
                design.estimator = Some(design.estimator(sensors, sampled, &input_range)?);
            }
        }
        Ok(design)
    }

    fn fixed(
        &self,
        request: &Request,
        plant: &Discrete,
        mut ranges: Ranges,
    ) -> Result<Fixed, DesignError> {
        let Ranges { state, input } = &mut ranges;
        let mut format = request.format.clone();
        if plant.delayed_inputs > 0 {
            // Past inputs come back in the steps in which they went out.
            let word = largest_word(format.bits);
            let step = |range: &f64| power_of_two_above(range / word);
            let input_step = format.input_step.take();
            // As states they count from zero, and so reach the operating point's input as well.
            let past = input.iter().zip(&self.u0);
            let past = past.map(|(range, u)| step(&(range + u.abs())));
            let input_step = input_step.unwrap_or_else(|| past.collect());
            let reach = state.iter().zip(&self.x0);
            let own = reach.map(|(range, x)| step(&(range + x.abs())));
            let mut steps = format.state_step.take().unwrap_or_else(|| own.collect());
            for _ in 0..plant.delayed_inputs {
                steps.extend(&input_step);
                state.extend(&*input);
            }
            (format.state_step, format.input_step) = (Some(steps), Some(input_step));
        }
        let law = quantise(&self.gains.k, &self.x0, &self.u0, &ranges, &format)?;
        let loss = law.loss(plant, &self.gains, &self.x0, &self.u0, &ranges.state)?;
        if loss.radius_fixed >= 1.0 {
            return Err(DesignError::UnstableWhenRounded {
                bits: law.bits,
                radius: loss.radius_fixed,
            });
        }
        Ok(Fixed { ranges, law, loss })
    }

    fn estimator(
        &self,
        sensors: &Sensors,
        plant: Discrete,
        input_range: &[f64],
    ) -> Result<Estimation, DesignError> {
        let (own, joints) = (plant.plant_states(), plant.plant_states() / 2);
        let plant = Discrete {
            c: plant.c.rows(0, joints + 1).into_owned(),
            ..plant
        };
        let mut variance = vec![rounding_variance(sensors.position_step_rad); joints];
        variance.push(rounding_variance(sensors.gyro_step_rad_s));
        let process = match &sensors.process {
            Some(process) => process.matrix("W", own, "states")?,
            None => {
                let held = zoh(&self.plant, plant.ts_s, 0.0)?.b;
                let sd = 0.01 * DVector::from_column_slice(input_range);
                let noisy = held * DMatrix::from_diagonal(&sd);
                &noisy * noisy.transpose()
            }
        };
        let measurement = DMatrix::from_diagonal(&variance.into());
        let estimator = kalman(&plant, &process, &measurement)?;
        let compensator = lqg(&plant, &self.gains, &estimator)?;
        Ok(Estimation {
            outputs: self.states[..=joints].to_vec(),
            plant,
            estimator,
            compensator,
        })
    }
}

/// A mode that no input reaches is the sampling time's doing where the inputs reach every mode of
/// the plant in continuous time.
fn by_sampling(error: DesignError, plant: &Continuous, ts_s: f64) -> DesignError {
    match error {
        DesignError::Uncontrollable { mode, .. }
            if mode.mode.pole.norm() <= MOST_GROWTH
                && controllability(&plant.a, &plant.b).is_ok_and(|it| it.is_full()) =>
        {
            let fastest = poles(&plant.a).map_or(0.0, |poles| largest(&poles));
            DesignError::LostBySampling {
                mode,
                ts_s,
                faster: fastest * ts_s > 1.0,
            }
        }
        error => error,
    }
}

/// Angles, speeds of 0, then past inputs.
fn point(pose_rad: &[f64], inputs: &[f64], delayed: usize) -> Vec<f64> {
    let mut point = pose_rad.to_vec();
    point.resize(2 * pose_rad.len(), 0.0);
    for _ in 0..delayed {
        point.extend(inputs);
    }
    point
}
