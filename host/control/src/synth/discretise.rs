//! Sampling with inputs held between samples, and arriving late.
//!
//! Van Loan, IEEE Trans. Automatic Control 23 (1978) 395: exp([A B; 0 0] t) = [e^{At} int_0^t
//! e^{As} ds B; 0 I]. With a delay of `whole` samples and `late` seconds, the input of sample k -
//! whole - 1 still acts for `late`: x(k+1) = e^{A Ts} x(k) + e^{A (Ts - late)} S(late) B
//! u(k-whole-1) + S(Ts - late) B u(k-whole), S(t) the integral (Astrom, Wittenmark,
//! Computer-Controlled Systems, 3rd ed., section 2.3).

use super::error::DesignError;
use super::system::{Continuous, Discrete};
use nalgebra::{DMatrix, stack};

/// A delay that differs from whole samples by less than this share of one is whole.
const WHOLE: f64 = 1e-9;

/// Most past inputs kept.
const MOST_DELAYED: usize = 100;

/// The same with each input as late as its own entry of `delays_s` says; as many past inputs are
/// kept of each as the latest needs.
///
/// # Errors
/// As [`zoh`].
pub fn zoh_each(plant: &Continuous, ts_s: f64, delays_s: &[f64]) -> Result<Discrete, DesignError> {
    let (n, m) = (plant.a.nrows(), plant.b.ncols());
    let latest_s = delays_s
        .iter()
        .fold(0.0, |most: f64, delay| most.max(*delay));
    let mut sampled = zoh(plant, ts_s, latest_s)?;
    // Inputs add up: each has the columns that it has where all are as late as it is.
    for (input, delay_s) in delays_s.iter().enumerate().take(m) {
        let own = zoh(plant, ts_s, *delay_s)?;
        for past in 0..sampled.delayed_inputs {
            let place = n + m * past + input;
            let mut column = sampled.a.view_mut((0, place), (n, 1));
            if past < own.delayed_inputs {
                column.copy_from(&own.a.view((0, place), (n, 1)));
            } else {
                column.fill(0.0);
            }
        }
        let direct = own.b.view((0, input), (n, 1));
        sampled.b.view_mut((0, input), (n, 1)).copy_from(&direct);
    }
    Ok(sampled)
}

/// The plant sampled every `ts_s`, its inputs held between samples and `delay_s` late.
///
/// # Errors
/// A sampling time that is not positive, a delay that is negative or longer than 100 samples, a
/// plant that grows beyond all numbers within a sample.
pub fn zoh(plant: &Continuous, ts_s: f64, delay_s: f64) -> Result<Discrete, DesignError> {
    check(ts_s, delay_s)?;
    let (n, m) = (plant.a.nrows(), plant.b.ncols());
    let samples = delay_s / ts_s;
    let mut whole = samples.floor();
    let mut late_s = delay_s - whole * ts_s;
    if samples - whole > 1.0 - WHOLE {
        whole += 1.0;
        late_s = 0.0;
    } else if samples - whole < WHOLE {
        late_s = 0.0;
    }
    let whole = whole as usize;
    let (state, newer) = held(plant, ts_s - late_s);
    let delayed_inputs = whole + usize::from(late_s > 0.0);
    let size = n + m * delayed_inputs;
    let (mut a, mut b) = (DMatrix::zeros(size, size), DMatrix::zeros(size, m));
    if late_s > 0.0 {
        let (late_state, older) = held(plant, late_s);
        a.view_mut((0, n + m * whole), (n, m))
            .copy_from(&(&state * older));
        a.view_mut((0, 0), (n, n)).copy_from(&(&state * late_state));
    } else {
        a.view_mut((0, 0), (n, n)).copy_from(&state);
    }
    match whole {
        0 => b.view_mut((0, 0), (n, m)).copy_from(&newer),
        _ => a
            .view_mut((0, n + m * (whole - 1)), (n, m))
            .copy_from(&newer),
    }
    if delayed_inputs > 0 {
        b.view_mut((n, 0), (m, m)).fill_with_identity();
        let later = m * (delayed_inputs - 1);
        a.view_mut((n + m, n), (later, later)).fill_with_identity();
    }
    let c = plant.c.clone().resize_horizontally(size, 0.0);
    if a.iter().chain(b.iter()).any(|value| !value.is_finite()) {
        return Err(DesignError::model(
            format!("the plant grows beyond all numbers within one sample of {ts_s} s"),
            "sample faster",
        ));
    }
    Ok(Discrete {
        a,
        b,
        c,
        ts_s,
        delayed_inputs,
    })
}

fn check(ts_s: f64, delay_s: f64) -> Result<(), DesignError> {
    if !(ts_s > 0.0 && ts_s.is_finite()) {
        return Err(DesignError::request(
            format!("a sampling time of {ts_s} s"),
            "give seconds above 0",
        ));
    }
    if !(delay_s >= 0.0 && delay_s <= MOST_DELAYED as f64 * ts_s) {
        return Err(DesignError::request(
            format!("a delay of {delay_s} s at a sampling time of {ts_s} s"),
            format!("give a delay from 0 to {MOST_DELAYED} samples"),
        ));
    }
    Ok(())
}

/// e^{At} and int_0^t e^{As} ds B.
fn held(plant: &Continuous, t_s: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let (n, m) = (plant.a.nrows(), plant.b.ncols());
    let block = stack![&plant.a * t_s, &plant.b * t_s].resize_vertically(n + m, 0.0);
    let exponential = block.exp();
    (
        exponential.view((0, 0), (n, n)).into_owned(),
        exponential.view((0, n), (n, m)).into_owned(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plant(values: &[f64]) -> Continuous {
        Continuous {
            a: DMatrix::from_row_slice(2, 2, &values[..4]),
            b: DMatrix::from_row_slice(2, 1, &values[4..6]),
            c: DMatrix::identity(2, 2),
        }
    }

    /// Two inputs of which each is late by itself move the plant as the sum of what either does.
    #[test]
    fn inputs_are_late_each_by_itself() {
        let plant = Continuous {
            a: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 30.0, -0.5]),
            b: DMatrix::from_row_slice(2, 2, &[0.1, 0.0, 2.0, -3.0]),
            c: DMatrix::identity(2, 2),
        };
        for delays_s in [[0.003, 0.014], [0.021, 0.0], [0.01, 0.01]] {
            let own = delays_s.map(|delay_s| zoh(&plant, 0.01, delay_s).unwrap());
            let both = zoh_each(&plant, 0.01, &delays_s).unwrap();
            let at_rest = |sampled: &Discrete| DMatrix::zeros(sampled.a.nrows(), 1);
            let mut sum = at_rest(&both);
            let mut alone = [at_rest(&own[0]), at_rest(&own[1])];
            for k in 0..12 {
                let u = [f64::from(k).sin(), f64::from(k * k).cos()];
                sum = &both.a * &sum + &both.b * DMatrix::from_row_slice(2, 1, &u);
                for input in 0..2 {
                    let mut only = DMatrix::zeros(2, 1);
                    only[input] = u[input];
                    alone[input] = &own[input].a * &alone[input] + &own[input].b * only;
                }
                let parts = alone[0].rows(0, 2) + alone[1].rows(0, 2);
                assert!((sum.rows(0, 2) - parts).amax() < 1e-12, "{delays_s:?} {k}");
            }
        }
    }

    proptest! {
        /// Against 100 short samples, each with the input that then acts.
        #[test]
        fn a_late_input_acts_late(
            values in prop::collection::vec(-3.0f64..3.0, 6),
            inputs in prop::collection::vec(-1.0f64..1.0, 6),
            late in 0u32..250,
        ) {
            let plant = plant(&values);
            let fine = zoh(&plant, 0.001, 0.0).unwrap();
            let coarse = zoh(&plant, 0.1, 0.001 * f64::from(late)).unwrap();
            prop_assert_eq!(coarse.delayed_inputs as u32, late.div_ceil(100));
            let mut x = DMatrix::from_row_slice(2, 1, &[0.3, -0.2]);
            let mut z = x.clone().resize_vertically(coarse.a.nrows(), 0.0);
            for k in 0..600_i64 {
                if k % 100 == 0 {
                    z = &coarse.a * &z + &coarse.b * inputs[k as usize / 100];
                }
                let asked = (k - i64::from(late)).div_euclid(100);
                let u = usize::try_from(asked).map_or(0.0, |asked| inputs[asked]);
                x = &fine.a * &x + &fine.b * u;
            }
            let off = (z.rows(0, 2) - &x).amax();
            prop_assert!(off < 1e-10 * x.amax().max(1.0), "{off:e}");
        }
    }

    #[test]
    fn a_whole_delay_is_whole() {
        let plant = plant(&[0.0, 1.0, 2.0, -1.0, 0.0, 1.0]);
        for (delay_s, delayed) in [(0.0, 0), (0.01, 1), (0.03, 3), (0.1 + 0.2, 30), (0.0301, 4)] {
            let sampled = zoh(&plant, 0.01, delay_s).unwrap();
            assert_eq!(sampled.delayed_inputs, delayed, "{delay_s}");
            assert_eq!(sampled.plant_states(), 2);
        }
        for (ts_s, delay_s) in [(0.0, 0.0), (f64::NAN, 0.0), (0.01, -0.01), (0.01, 1.1)] {
            let error = crate::error::Error::from(zoh(&plant, ts_s, delay_s).unwrap_err());
            assert_eq!(error.exit_code(), 3);
        }
    }
}
