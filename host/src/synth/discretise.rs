//! Sampling with inputs held between samples, and arriving late.
//!
//! Van Loan, IEEE Trans. Automatic Control 23 (1978) 395: exp([A B; 0 0] t) = [e^{At} int_0^t e^{As} ds B; 0 I].
//! With a delay of `whole` samples and `late` seconds, the input of sample k - whole - 1 still acts for `late`:
//! x(k+1) = e^{A Ts} x(k) + e^{A (Ts - late)} S(late) B u(k-whole-1) + S(Ts - late) B u(k-whole), S(t) the integral
//! (Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., section 2.3).

use super::system::{Continuous, Discrete};
use crate::error::{Error, Result};
use nalgebra::DMatrix;

/// A delay that differs from whole samples by less than this share of one is whole.
const WHOLE: f64 = 1e-9;

/// Most past inputs kept.
const MOST_DELAYED: usize = 100;

/// The plant sampled every `ts_s`, its inputs held between samples and `delay_s` late.
///
/// # Errors
/// A sampling time that is not positive, a delay that is negative or longer than 100 samples, a plant that grows beyond
/// all numbers within a sample.
pub fn zoh(plant: &Continuous, ts_s: f64, delay_s: f64) -> Result<Discrete> {
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
    let mut c = DMatrix::zeros(plant.c.nrows(), size);
    c.view_mut((0, 0), plant.c.shape()).copy_from(&plant.c);
    if a.iter().chain(b.iter()).any(|value| !value.is_finite()) {
        return Err(Error::design(
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

fn check(ts_s: f64, delay_s: f64) -> Result<()> {
    if !(ts_s > 0.0 && ts_s.is_finite()) {
        return Err(Error::design(
            format!("a sampling time of {ts_s} s"),
            "give seconds above 0",
        ));
    }
    if !(delay_s >= 0.0 && delay_s <= MOST_DELAYED as f64 * ts_s) {
        return Err(Error::design(
            format!("a delay of {delay_s} s at a sampling time of {ts_s} s"),
            format!("give a delay from 0 to {MOST_DELAYED} samples"),
        ));
    }
    Ok(())
}

/// e^{At} and int_0^t e^{As} ds B.
fn held(plant: &Continuous, t_s: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let (n, m) = (plant.a.nrows(), plant.b.ncols());
    let mut block = DMatrix::zeros(n + m, n + m);
    block.view_mut((0, 0), (n, n)).copy_from(&(&plant.a * t_s));
    block.view_mut((0, n), (n, m)).copy_from(&(&plant.b * t_s));
    let exponential = block.exp();
    (
        exponential.view((0, 0), (n, n)).into_owned(),
        exponential.view((0, n), (n, m)).into_owned(),
    )
}
