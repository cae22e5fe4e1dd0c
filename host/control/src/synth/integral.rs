//! Integral action: sums of the driven joints' angles as states of the regulator (LQI).
//!
//! w(k+1) = w(k) + Ts q(k) of each driven joint. A stable loop with these states holds the driven
//! joints at the pose under any lasting torque that the drives can bear; passive joints go to where
//! gravity balances them. (Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., section 4.5.)

use super::error::DesignError;
use super::quantise::positive;
use super::signal::{Signal, of_joint};
use super::system::Discrete;
use super::weight::Weight;
use crate::model::Model;
use nalgebra::DMatrix;

/// The joints whose angles are summed, and what their sums weigh.
#[derive(Debug, Clone, PartialEq)]
pub struct Integral {
    /// Counted from 0: the driven joints.
    pub joints: Vec<usize>,
    /// Weight of each sum, 1/(rad s)^2; of slides 1/(m s)^2.
    pub weights: Vec<f64>,
}

/// How the caller of a fixed-point law keeps the sums, in 32-bit integers: `sum += x - x0` of its
/// joint's angle in steps, held within 2^15 2^shift, unless an input is at its limit; the law's
/// state is `sum >> shift`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sums {
    /// Place of the first sum among the states.
    pub first: usize,
    /// The joint of each sum, counted from 0.
    pub joints: Vec<usize>,
    /// Places by which each sum is shifted right.
    pub shift: Vec<u32>,
}

impl Integral {
    /// Sums of all driven joints of `model` with these weights.
    ///
    /// # Errors
    /// A number of weights that is not that of the driven joints; weights that are not positive.
    pub(super) fn of(model: &Model, weight: &Weight) -> Result<Integral, DesignError> {
        let joints = model.driven_joints();
        let weights = weight.diagonal("the weight of the integrals", joints.len())?;
        positive("weight", "integral", &weights, joints.len())?;
        Ok(Integral { joints, weights })
    }

    /// The plant with the sums as states, between its own and the past inputs.
    pub(super) fn with_sums(&self, plant: &Discrete) -> Discrete {
        let (own, count) = (plant.plant_states(), self.joints.len());
        let mut a = plant.a.clone().insert_columns(own, count, 0.0);
        a = a.insert_rows(own, count, 0.0);
        for (sum, joint) in self.joints.iter().enumerate() {
            a[(own + sum, own + sum)] = 1.0;
            a[(own + sum, *joint)] = plant.ts_s;
        }
        Discrete {
            a,
            b: plant.b.clone().insert_rows(own, count, 0.0),
            c: plant.c.clone().insert_columns(own, count, 0.0),
            ..*plant
        }
    }

    /// A weight of the plant's own states with those of the sums behind.
    pub(super) fn weight(&self, q: &DMatrix<f64>) -> DMatrix<f64> {
        let (own, count) = (q.nrows(), self.joints.len());
        let mut whole = q.clone().resize(own + count, own + count, 0.0);
        for (sum, weight) in self.weights.iter().enumerate() {
            whole[(own + sum, own + sum)] = *weight;
        }
        whole
    }

    /// How large each sum must be able to grow, rad s, for the sums to hold any inputs within
    /// `limit`; `k` is m x N, the sums' columns from `own` on.
    pub(super) fn range(&self, k: &DMatrix<f64>, own: usize, limit: &[f64]) -> Option<Vec<f64>> {
        let inverse = k
            .columns(own, self.joints.len())
            .into_owned()
            .try_inverse()?;
        let reach = |row: usize| -> f64 {
            let row = inverse.row(row);
            row.iter().zip(limit).map(|(w, u)| w.abs() * u).sum()
        };
        Some((0..self.joints.len()).map(reach).collect())
    }

    /// The sums' integers for angles in these steps and sums within `range`, and the sums' steps,
    /// rad s.
    pub(super) fn in_words(
        &self,
        ts_s: f64,
        angle_step: &[f64],
        range: &[f64],
        word: f64,
    ) -> (Vec<u32>, Vec<f64>) {
        let of = |(joint, range): (&usize, &f64)| {
            let one = ts_s * angle_step[*joint];
            // More would not fit the 32 bits of a sum.
            let places = (range / (one * word)).log2().ceil().clamp(0.0, 16.0);
            (places as u32, one * 2f64.powf(places))
        };
        self.joints.iter().zip(range).map(of).unzip()
    }

    /// The sums as signals.
    pub(super) fn signals(&self, model: &Model) -> Vec<Signal> {
        let signal = |joint: &usize| Signal {
            name: of_joint("int_q", model, *joint),
            unit: match model.joints[*joint].slide {
                Some(_) => "m s",
                None => "rad s",
            },
        };
        self.joints.iter().map(signal).collect()
    }
}

impl Sums {
    /// The largest magnitude of the sum in place `sum`.
    pub(crate) fn most(&self, sum: usize) -> i64 {
        32_767 << self.shift[sum]
    }

    /// The sums after a sample: of the states `x` (angles first), about the operating point `x0`,
    /// all in steps.
    pub fn add(&self, sums: &mut [i64], x: &[i64], x0: &[i64]) {
        for (place, joint) in self.joints.iter().enumerate() {
            let most = self.most(place);
            sums[place] = (sums[place] + x[*joint] - x0[*joint]).clamp(-most, most);
        }
    }

    /// The law's states of these sums.
    pub fn states<'a>(&'a self, sums: &'a [i64]) -> impl Iterator<Item = i64> + 'a {
        sums.iter()
            .zip(&self.shift)
            .map(|(sum, shift)| sum >> shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::{Continuous, Design, Request, Time, stiffness, torque_inputs, zoh};
    use nalgebra::DVector;
    use std::path::Path;

    fn designed(delay_s: f64) -> (Model, Design) {
        let text = include_str!("../../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            integral: Some(Weight::Scalar(100.0)),
            time: Time::Sampled {
                ts_s: 0.01,
                delay_s: Some(delay_s),
            },
            ..Request::standard(&model)
        };
        let design = Design::of(&model, &request).unwrap();
        (model, design)
    }

    /// The linear loop with sums kept apart from it, under a lasting torque on the bar: the
    /// driven joints come back, and the bar's joint goes where the closed form says.
    #[test]
    fn driven_joints_come_back_under_a_lasting_torque() {
        for delay_s in [0.0, 0.013] {
            let (model, design) = designed(delay_s);
            let plant = zoh(&design.plant, 0.01, delay_s).unwrap();
            let push = Continuous {
                b: torque_inputs(&model, &design.x0[..3]).unwrap(),
                ..design.plant.clone()
            };
            let push = zoh(&push, 0.01, 0.0).unwrap().b.column(0) * 0.01;
            let (k, size) = (&design.gains.k, plant.a.nrows());
            assert_eq!(k.ncols(), size + 2);
            let mut x = DVector::<f64>::zeros(size);
            let mut sums = [0.0; 2];
            for _ in 0..4000 {
                let mut whole: Vec<f64> = x.rows(0, 6).iter().copied().collect();
                whole.extend(sums);
                whole.extend(x.rows(6, size - 6).iter());
                let u = -k * DVector::from_vec(whole);
                sums[0] += 0.01 * x[1];
                sums[1] += 0.01 * x[2];
                x = &plant.a * x + &plant.b * u;
                for (row, push) in push.iter().enumerate() {
                    x[row] += push;
                }
            }
            let lean = stiffness(&model, &design).unwrap().lean_per_torque;
            let rest = x.rows(0, 3).into_owned();
            assert!(rest[1].abs() < 1e-9 && rest[2].abs() < 1e-9, "{rest}");
            let expected = lean.column(0) * 0.01;
            assert!(
                rest[0].abs() > 1e-3 && (&rest - &expected).amax() < 1e-9,
                "{rest} {expected}"
            );
        }
    }

    /// A sum's step is that of its angle times the sampling time and a power of two, so that adding
    /// integers is adding angles.
    #[test]
    fn sums_count_in_steps_of_their_angle() {
        let (_, design) = designed(0.0);
        let fixed = design.fixed.unwrap();
        let sums = fixed.sums.unwrap();
        assert_eq!((sums.first, sums.joints.as_slice()), (6, &[1, 2][..]));
        for (place, joint) in sums.joints.iter().enumerate() {
            let step = fixed.law.state_step[sums.first + place];
            let one = 0.01 * fixed.law.state_step[*joint];
            assert!((step - one * f64::from(1 << sums.shift[place])).abs() < 1e-18);
            assert!(fixed.ranges.state[sums.first + place] <= 32_767.0 * step);
        }
        // Held within 32 bits, and within a word as a state.
        let mut kept = [0, 0];
        for _ in 0..300_000 {
            sums.add(&mut kept, &[0, 32_767, -32_768], &[0; 3]);
        }
        let states: Vec<i64> = sums.states(&kept).collect();
        assert_eq!(states, [32_767, -32_767]);
        assert!(kept.iter().all(|sum| i32::try_from(*sum).is_ok()));
    }
}
