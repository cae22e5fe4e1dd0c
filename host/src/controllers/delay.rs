//! The longest delay a controller survives: in the linear loop, and in the simulated one.
//!
//! Any controller here is linear about rest once its filter stands still and nothing saturates; its matrices are read
//! off it by small pushes, so that what is judged is the code that runs.

use super::{Condition, Design, Known, Robots, try_out};
use crate::closed_loop::{Controller, Seen};
use crate::error::Result;
use crate::synth::{spectral_radius, zoh};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Samples after which every controller's filter stands still.
const UNTIL_STILL: usize = 1200;

/// Size of a push: rad, rad/s, or of a number it remembers.
const PUSH: f64 = 1e-6;

/// The delays around one at which a controller survives.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Longest {
    /// The shortest one up to which nothing fails on the way down, s; none if it falls where the search begins.
    pub shortest_s: Option<f64>,
    /// The longest one up to which nothing fails on the way up, s.
    pub delay_s: Option<f64>,
    /// Whether longer ones may be survived: the search ended there.
    pub open: bool,
}

impl Longest {
    /// Steps out from `from_s`, down to 0 and up to `until_s`.
    fn search(
        from_s: f64,
        step_s: f64,
        until_s: f64,
        mut survives: impl FnMut(f64) -> Result<bool>,
    ) -> Result<Longest> {
        let steps = |span_s: f64| (span_s / step_s + 1e-9).floor() as usize;
        let mut longest = Longest {
            shortest_s: None,
            delay_s: None,
            open: true,
        };
        for step in 0..=steps(until_s - from_s) {
            let delay_s = from_s + step as f64 * step_s;
            if !survives(delay_s)? {
                longest.open = false;
                break;
            }
            longest.delay_s = Some(delay_s);
        }
        if longest.delay_s.is_none() {
            return Ok(longest);
        }
        longest.shortest_s = Some(from_s);
        for step in 1..=steps(from_s) {
            let delay_s = from_s - step as f64 * step_s;
            if !survives(delay_s.max(0.0))? {
                break;
            }
            longest.shortest_s = Some(delay_s.max(0.0));
        }
        Ok(longest)
    }

    /// Whether a delay lies within.
    pub fn survives(&self, delay_s: f64) -> bool {
        matches!((self.shortest_s, self.delay_s), (Some(least), Some(most)) if least <= delay_s && delay_s <= most)
    }
}

/// The delays, up to `until_s` in steps of `step_s`, under which the linear loop with the nominal plant is stable: of
/// a controller told `told_s` (the search begins there), or told each delay.
///
/// # Errors
/// A controller that cannot be made.
pub fn longest_linear(
    design: &dyn Design,
    known: &Known,
    told_s: Option<f64>,
    step_s: f64,
    until_s: f64,
) -> Result<Longest> {
    let build = |delay_s: f64| -> Result<Law> {
        let known = Known {
            delay_s,
            ..known.clone()
        };
        Ok(Law::of(design.build(&known)?.as_ref(), &known))
    };
    let fixed = told_s.map(build).transpose()?;
    Longest::search(told_s.unwrap_or(0.0), step_s, until_s, |delay_s| {
        let radius = match &fixed {
            Some(law) => law.radius(known, delay_s)?,
            // Told a delay for which nothing holds the plant, a design may fail: then it doesn't survive.
            None => match build(delay_s) {
                Ok(law) => law.radius(known, delay_s)?,
                Err(_) => f64::INFINITY,
            },
        };
        Ok(radius < 1.0)
    })
}

/// The longest delay, as above, under which a controller told each delay still holds 95 % of the robots.
///
/// # Errors
/// A model the closed loop does not have.
pub fn longest_held(
    design: &dyn Design,
    robots: &Robots<'_>,
    condition: &Condition,
    known: &Known,
    step_s: f64,
    until_s: f64,
) -> Result<Longest> {
    Longest::search(0.0, step_s, until_s, |delay_s| {
        let known = Known {
            delay_s,
            ..condition.tell(known)
        };
        if design.build(&known).is_err() {
            return Ok(false);
        }
        Ok(try_out(robots, design, condition, &known, &|| ())?.held >= 0.95)
    })
}

/// A controller about rest: memory' = A memory + B seen, torque = C memory + D seen.
struct Law {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl Law {
    fn of(controller: &dyn Controller, known: &Known) -> Law {
        let (joints, drives) = (known.joints(), known.drives());
        let mut rest = vec![0.0; controller.memory_len()];
        controller.reset(&mut rest);
        let step = |memory: &mut [f64], seen: &[f64]| {
            let (angle_rad, speed_rad_s) = seen.split_at(joints);
            let mut torque = vec![0.0; drives];
            controller.control(
                memory,
                Seen {
                    angle_rad,
                    speed_rad_s,
                },
                &mut torque,
            );
            torque
        };
        let still = vec![0.0; 2 * joints];
        for _ in 0..UNTIL_STILL {
            step(&mut rest, &still);
        }
        let pushed = |place: Option<usize>, seen: &[f64]| {
            let mut memory = rest.clone();
            if let Some(place) = place {
                memory[place] += PUSH;
            }
            let torque = step(&mut memory, seen);
            let memory = memory
                .iter()
                .zip(&rest)
                .map(|(new, old)| (new - old) / PUSH);
            (
                memory.collect::<Vec<f64>>(),
                torque.iter().map(|t| t / PUSH).collect::<Vec<f64>>(),
            )
        };
        let from_memory: Vec<_> = (0..rest.len()).map(|i| pushed(Some(i), &still)).collect();
        let from_seen: Vec<_> = (0..2 * joints)
            .map(|i| {
                let mut seen = still.clone();
                seen[i] = PUSH;
                pushed(None, &seen)
            })
            .collect();
        let columns = |all: &[(Vec<f64>, Vec<f64>)], torque: bool| {
            let height = if torque { drives } else { rest.len() };
            let column = |one: &(Vec<f64>, Vec<f64>)| {
                DVector::from_vec(if torque { one.1.clone() } else { one.0.clone() })
            };
            let mut matrix = DMatrix::zeros(height, all.len());
            for (j, one) in all.iter().enumerate() {
                matrix.set_column(j, &column(one));
            }
            matrix
        };
        Law {
            a: columns(&from_memory, false),
            b: columns(&from_seen, false),
            c: columns(&from_memory, true),
            d: columns(&from_seen, true),
        }
    }

    /// Spectral radius of the loop closed through the nominal plant, `delay_s` late.
    fn radius(&self, known: &Known, delay_s: f64) -> Result<f64> {
        let plant = zoh(&known.plant, known.period_s, delay_s)?;
        let (n, memory, seen) = (plant.a.nrows(), self.a.nrows(), self.d.ncols());
        let mut closed = DMatrix::zeros(n + memory, n + memory);
        let mut c = DMatrix::zeros(seen, n);
        c.view_mut((0, 0), (seen, seen)).fill_with_identity();
        closed
            .view_mut((0, 0), (n, n))
            .copy_from(&(&plant.a + &plant.b * &self.d * &c));
        closed
            .view_mut((0, n), (n, memory))
            .copy_from(&(&plant.b * &self.c));
        closed
            .view_mut((n, 0), (memory, n))
            .copy_from(&(&self.b * &c));
        closed.view_mut((n, n), (memory, memory)).copy_from(&self.a);
        Ok(spectral_radius(&closed))
    }
}
