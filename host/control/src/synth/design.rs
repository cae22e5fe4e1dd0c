//! Everything that follows from a model and weights, as one value; `export` writes it in many ways.

mod fixed;

pub use fixed::FixedDesign;

use super::controllability::{Controllability, controllability, observability};
use super::eigen::{largest, poles};
use super::error::DesignError;
use super::estimator::{Compensator, Estimator, kalman, lqg, rounding_variance};
use super::gains::{Gains, dlqr, lqr};
use super::integral::Integral;
use super::linearise::{Linearisation, linearise};
use super::omitted::OmittedEffect;
use super::operating_point::input_delay_s;
use super::quantise::Ranges;
use super::request::{Request, Sensors, Time};
use super::signal::{Signal, input, states};
use super::stationary::{Stationary, stationary};
use super::system::{Continuous, Discrete};
use super::zeros::transmission_zeros;
use super::zoh;
use crate::model::{JointNames, Model};
use nalgebra::{Complex, DMatrix, DVector};

/// A finished design.
#[derive(Debug, Clone)]
pub struct Design {
    /// The model's name.
    pub model: String,
    /// What its joints are called, of a robot in space.
    pub names: JointNames,
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
    /// The sampled plant, and the delay it holds, s. With integral action the sums are states of
    /// it, between its own and the past inputs.
    pub sampled: Option<(Discrete, f64)>,
    /// The sums of angles among the states.
    pub integral: Option<Integral>,
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
    pub fixed: Option<FixedDesign>,
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
    /// The share of the inputs' ranges by which the filter takes them to err, beside the process
    /// noise.
    pub recovery: f64,
    /// How far noise moves the loop; none of a loop that does not decay.
    pub stationary: Option<Stationary>,
}

impl Design {
    /// Everything that follows from `model` and `request`.
    ///
    /// # Errors
    /// Whatever stands in the way, with what to change.
    pub fn of(model: &Model, request: &Request) -> Result<Design, DesignError> {
        let slide = model.joints.iter().position(|joint| joint.slide.is_some());
        if let (Some(joint), true) = (slide, request.sensors.is_some()) {
            let joint = JointNames::of(model).label(joint);
            return Err(DesignError::model(
                format!("joint {joint} slides, and the filter measures angles and a gyro"),
                "leave --lqg out",
            ));
        }
        let Linearisation {
            plant,
            inputs: u0,
            omitted,
        } = linearise(model, &request.pose_rad)?;
        let ranges = Ranges {
            state: request.state_ranges(plant.a.nrows())?,
            input: request.input_ranges(model, &u0)?,
        };
        let integral = request.integral.as_ref();
        let integral = integral.map(|weight| Integral::of(model, weight));
        let integral = integral.transpose()?;
        let (gains, sampled, weights) = solved(model, request, &plant, &ranges, integral.as_ref())
            .map_err(|error| named(error, model, request, integral.as_ref()))?;
        let driven = model.driven_joints();
        let outputs = plant.c.select_rows(&driven);
        let angles = plant.c.rows(0, model.link_count()).into_owned();
        let inputs: Vec<Signal> = driven.iter().map(|joint| input(model, *joint)).collect();
        let delayed = sampled
            .as_ref()
            .map_or(0, |(sampled, _)| sampled.delayed_inputs);
        let sums = integral.as_ref().map_or(0, |it| it.joints.len());
        let mut design = Design {
            model: model.name.clone(),
            names: JointNames::of(model),
            states: states(model, &inputs, integral.as_ref(), delayed),
            x0: point(&request.pose_rad, sums, &u0, delayed),
            integral,
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
            let input_range = ranges.input.clone();
            design.fixed = Some(design.fixed(request, &sampled, ranges)?);
            if let Some(sensors) = &request.sensors {
                let estimator = design.estimator(sensors, sampled, &input_range);
                let named = |error| named(error, model, request, None);
                design.estimator = Some(estimator.map_err(named)?);
            }
        }
        Ok(design)
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
        let held = zoh(&self.plant, plant.ts_s, 0.0)?.b;
        let of_inputs = |share: f64| {
            let sd = share * DVector::from_column_slice(input_range);
            let noisy = &held * DMatrix::from_diagonal(&sd);
            &noisy * noisy.transpose()
        };
        let process = match &sensors.process {
            Some(process) => process.matrix("W", own, "states")?,
            None => of_inputs(0.01),
        };
        let process = plant.whole_state("W", &process)?;
        let recovery = of_inputs(sensors.recovery);
        let mut taken = process.clone();
        let mut own_part = taken.view_mut((0, 0), (own, own));
        own_part += recovery;
        let measurement = DMatrix::from_diagonal(&variance.into());
        let estimator = kalman(&plant, &taken, &measurement)?;
        let compensator = lqg(&plant, &self.gains, &estimator)?;
        let stationary = stationary(&plant, &compensator, &process, &measurement);
        Ok(Estimation {
            outputs: self.states[..=joints].to_vec(),
            plant,
            estimator,
            compensator,
            recovery: sensors.recovery,
            stationary,
        })
    }
}

/// The error with its state by name; past inputs are not among the states that can lack anything.
fn named(
    error: DesignError,
    model: &Model,
    request: &Request,
    integral: Option<&Integral>,
) -> DesignError {
    let ts_s = match request.time {
        Time::Continuous => None,
        Time::Sampled { ts_s, .. } => Some(ts_s),
    };
    match error {
        DesignError::Mode(stuck) => {
            let states = states(model, &[], integral, 0);
            stuck.of_states(&states, ts_s).into()
        }
        error => error,
    }
}

/// The gains, the sampled plant with its delay, Q and R.
type Solved = (Gains, Option<(Discrete, f64)>, [DMatrix<f64>; 2]);

fn solved(
    model: &Model,
    request: &Request,
    plant: &Continuous,
    ranges: &Ranges,
    integral: Option<&Integral>,
) -> Result<Solved, DesignError> {
    let weigh = |with_past| {
        let weights = &request.weights;
        weights.matrices(&ranges.state, &ranges.input, with_past)
    };
    let Time::Sampled { ts_s, delay_s } = request.time else {
        if integral.is_some() {
            return Err(DesignError::request(
                "integral action sums angles sample by sample, and continuous time has no samples",
                "leave out one of the two",
            ));
        }
        let [q, r] = weigh(plant.a.nrows())?;
        return Ok((lqr(plant, &q, &r)?, None, [q, r]));
    };
    let delay_s = delay_s.map_or_else(|| input_delay_s(model), Ok)?;
    let mut sampled = zoh(plant, ts_s, delay_s)?;
    // Past inputs may be weighed, too, where there are no sums before them.
    let weighed = integral.map_or(sampled.a.nrows(), |_| plant.a.nrows());
    let [mut q, r] = weigh(weighed)?;
    if let Some(integral) = integral {
        sampled = integral.with_sums(&sampled);
        q = integral.weight(&q);
    }
    let by_sampling = |error| by_sampling(error, plant, ts_s, integral.is_some());
    let gains = dlqr(&sampled, &q, &r).map_err(by_sampling)?;
    Ok((gains, Some((sampled, delay_s)), [q, r]))
}

/// A mode that no input reaches is the sampling time's doing where the inputs reach every mode of
/// the plant in continuous time.
fn by_sampling(error: DesignError, plant: &Continuous, ts_s: f64, sums: bool) -> DesignError {
    match error {
        DesignError::Mode(stuck)
            if !sums
                && stuck.is_unreached
                && controllability(&plant.a, &plant.b).is_ok_and(|it| it.is_full()) =>
        {
            let fastest = poles(&plant.a).map_or(0.0, |poles| largest(&poles));
            stuck.lost_by_sampling(ts_s, fastest * ts_s > 1.0).into()
        }
        error => error,
    }
}

/// Angles, speeds of 0, sums of 0, then past inputs.
fn point(pose_rad: &[f64], sums: usize, inputs: &[f64], delayed: usize) -> Vec<f64> {
    let mut point = pose_rad.to_vec();
    point.resize(2 * pose_rad.len() + sums, 0.0);
    for _ in 0..delayed {
        point.extend(inputs);
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const PENDULUM: &str = r#"
[rig]
name = "pendulum"
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4

[[joint]]
drive = "torque"

[log]
time = { column = "time_s", unit = "s" }

[[log.joint]]
position = { column = "angle_rad", unit = "rad" }
input = { column = "torque_nm", unit = "N m" }
"#;

    fn hanging(ts_s: f64) -> Result<Design, DesignError> {
        let model = Model::parse(PENDULUM, Path::new("pendulum.toml")).unwrap();
        let request = Request {
            pose_rad: vec![0.0],
            time: Time::Sampled {
                ts_s,
                delay_s: None,
            },
            ..Request::standard(&model)
        };
        Design::of(&model, &request)
    }

    /// A pendulum that swings by half a period in each sample looks the same whatever its phase: no
    /// input parts its two modes, though one does between the samples.
    #[test]
    fn a_mode_that_sampling_hides_is_not_said_to_lack_a_drive() {
        let design = hanging(0.01).unwrap();
        assert!(design.controllability.is_full());
        let half_period_s = std::f64::consts::PI / design.poles[0].im.abs();
        let error = hanging(half_period_s).unwrap_err();
        let DesignError::Mode(stuck) = &error else {
            panic!("{error}")
        };
        assert_eq!(stuck.mode.ts_s, Some(half_period_s), "{error:?}");
        let said = error.to_string();
        assert!(
            said.contains("no input reaches it, though in continuous time") && said.contains("q1"),
            "{said}"
        );
        assert_eq!(error.problem().remedy, "sample faster");
        assert!(hanging(0.9 * half_period_s).is_ok());
    }
}
