//! The same numbers from Table 1: linearised, sampled, solved; and the servo's model found again in
//! data made with it.

use super::case::TS_S;
use super::humanoid::{LumpedBlock, lumped_blocks};
use super::printed::PrintedQuantity;
use crate::error::Result;
use crate::model::Model;
use crate::study::handstand;
use crate::synth::{
    Continuous, Discrete, Gains, dlqr, linearise, lqr, poles, transmission_zeros, upright, zoh,
};
use crate::sysid::generate::{PAPER_TS_S, paper_model, paper_noise_model, pseudo_random};
use crate::sysid::polynomial::{at_one, roots};
use crate::sysid::{Estimate, IntervalEstimate, Record, Structure, estimate, settling_samples};
use nalgebra::{Complex, DMatrix};
use serde::Serialize;

/// Samples of the servo record.
const SAMPLES: usize = 6000;
/// Speed it is told, plus and minus, rad/s.
const COMMAND_RAD_S: f64 = 5.0;
/// Standard deviation of its noise, rad/s.
const NOISE_RAD_S: f64 = 0.1;

/// What follows from the paper's inputs.
#[derive(Debug, Clone)]
pub struct Computed {
    /// Table 1 as a model.
    pub model: Model,
    /// Linearised at upright.
    pub plant: Continuous,
    /// Sampled every 10 ms.
    pub sampled: Discrete,
    /// Q = I, R = I.
    pub lqr: Gains,
    /// Q = 100 I, R = I.
    pub dlqr: Gains,
    /// Open-loop poles, 1/s.
    pub poles: Vec<Complex<f64>>,
    /// Zeros from the two torques to two of the angles.
    pub zeros: Vec<Zeros>,
    /// Coefficients of the paper's BJ(2,1,2,1) found in data made with it, with their names.
    pub servo: Vec<(String, IntervalEstimate)>,
    /// What follows from the servo's model without being printed.
    pub servo_facts: ServoFacts,
    /// The whole robot with its 18 servos, beside Table 1.
    pub blocks: Vec<LumpedBlock>,
}

/// The transmission zeros from the torques to two of the angles: a pair on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Zeros {
    /// The angles, joints counted from 1.
    pub outputs: [usize; 2],
    /// Square of the zeros, 1/s^2: above 0 one lies in the right half plane.
    pub squared: f64,
}

/// The paper's eq. (2) in other words.
#[derive(Debug, Clone)]
pub struct ServoFacts {
    /// Speed over commanded speed at rest.
    pub gain: f64,
    /// Poles in z.
    pub poles: Vec<Complex<f64>>,
    /// ln(z) / Ts of the first, 1/s.
    pub continuous: Complex<f64>,
    /// Time to stay within 2 %, s.
    pub settling_s: f64,
}

impl Computed {
    /// Computes everything.
    ///
    /// # Errors
    /// None is known: the model is the project's own.
    pub fn new() -> Result<Computed> {
        let model = handstand()?;
        let plant = linearise(&model, &upright(&model))?.plant;
        let sampled = zoh(&plant, TS_S, 0.0)?;
        let (q, r) = (DMatrix::identity(6, 6), DMatrix::identity(2, 2));
        Ok(Computed {
            lqr: lqr(&plant, &q, &r)?,
            dlqr: dlqr(&sampled, &(100.0 * &q), &r)?,
            poles: poles(&plant.a)?,
            zeros: zeros(&plant)?,
            servo: servo(),
            servo_facts: servo_facts(),
            blocks: lumped_blocks(&model)?,
            sampled,
            plant,
            model,
        })
    }

    /// The value of a printed quantity in the print's unit; with its interval where it was
    /// estimated.
    pub fn value(&self, quantity: PrintedQuantity) -> IntervalEstimate {
        let exact = |value: f64| IntervalEstimate::around(value, 0.0);
        match quantity {
            PrintedQuantity::Link(link, field) => {
                let link = &self.model.links[link];
                exact(match field {
                    0 => 1e3 * link.length_m,
                    1 => 1e3 * link.com_m,
                    2 => 1e3 * link.mass_kg,
                    _ => 1e7 * link.inertia_kg_m2,
                })
            }
            PrintedQuantity::A(r, c) => exact(self.plant.a[(r, c)]),
            PrintedQuantity::B(r, c) => exact(self.plant.b[(r, c)]),
            PrintedQuantity::Lqr(r, c) => exact(self.lqr.k[(r, c)]),
            PrintedQuantity::Dlqr(r, c) => exact(self.dlqr.k[(r, c)]),
            PrintedQuantity::Pole(k) => exact(self.poles[k].re),
            PrintedQuantity::Servo(name) => {
                let found = self.servo.iter().find(|(known, _)| known == name);
                found.map_or(exact(f64::NAN), |(_, known)| *known)
            }
        }
    }
}

/// To each two of the three angles.
fn zeros(plant: &Continuous) -> Result<Vec<Zeros>> {
    let to = |outputs: [usize; 2]| {
        let c = DMatrix::from_fn(2, 6, |row, state| {
            f64::from(u8::from(state + 1 == outputs[row]))
        });
        let first = first(&transmission_zeros(&plant.a, &plant.b, &c)?);
        let squared = (first * first).re;
        Ok(Zeros { outputs, squared })
    };
    [[2, 3], [1, 3], [1, 2]].into_iter().map(to).collect()
}

/// BJ with the paper's orders, from data made with its eq. (2) and noise of our choice.
pub(super) fn servo_estimate(seed: u64) -> Option<(Record, Estimate)> {
    let told = pseudo_random(SAMPLES, 15, seed);
    let input: Vec<f64> = told.iter().map(|u| COMMAND_RAD_S * u).collect();
    let output = paper_noise_model().respond(&input, NOISE_RAD_S, seed);
    let record = Record::new("generated", input, output);
    let orders = Structure::bj([1, 2, 1, 2, 1]);
    let found = estimate(&orders, std::slice::from_ref(&record));
    Some((record, found.ok()?))
}

fn servo() -> Vec<(String, IntervalEstimate)> {
    let Some((_, estimate)) = servo_estimate(1) else {
        return Vec::new();
    };
    estimate.coefficients()
}

fn first(numbers: &[Complex<f64>]) -> Complex<f64> {
    let none = Complex::new(f64::NAN, 0.0);
    numbers.first().copied().unwrap_or(none)
}

fn servo_facts() -> ServoFacts {
    let model = paper_model();
    let poles = roots(&model.f).unwrap_or_default();
    ServoFacts {
        gain: at_one(&model.b) / at_one(&model.f),
        continuous: first(&poles).ln() / PAPER_TS_S,
        settling_s: settling_samples(&model.b, &model.f)
            .map_or(f64::INFINITY, |samples| samples as f64 * PAPER_TS_S),
        poles,
    }
}
