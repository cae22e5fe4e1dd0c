//! Compare the firmware's law with integers that cannot overflow.

use crate::error::{Error, Result};
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::plan::Law;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Compute every table of the law at `states` random states drawn from `seed`; `progress` gets the
/// number so far.
///
/// # Errors
/// A bit differs.
pub fn replay(law: &Law, states: u64, seed: u64, mut progress: impl FnMut(u64)) -> Result<()> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for count in 0..states {
        match law {
            Law::State { table, .. } => same(table, &mut random)?,
            Law::Observer(observer) => {
                same(&observer.predict, &mut random)?;
                same(&observer.feedback, &mut random)?;
                same(&observer.update, &mut random)?;
            }
        }
        if count % 4096 == 0 {
            progress(count);
        }
    }
    Ok(())
}

fn same<const M: usize, const N: usize>(
    table: &GainTable<M, N>,
    random: &mut ChaCha8Rng,
) -> Result<()> {
    let x: [i16; N] = std::array::from_fn(|_| random.random());
    let (ours, wide) = (control(table, &x), wide(table, &x));
    if ours.map(i64::from) == wide {
        return Ok(());
    }
    Err(Error::device(
        format!("the laws differ at the states {x:?}: {ours:?}, in wide integers {wide:?}"),
        "this is a bug; please report it with the model",
    ))
}

/// u = sat((bias - K (x - x0)) / 2^shift), rounded down: the bias has the half that makes that
/// rounding.
fn wide<const M: usize, const N: usize>(table: &GainTable<M, N>, x: &[i16; N]) -> [i64; M] {
    std::array::from_fn(|i| {
        let row = &table.rows[i];
        let departures = x
            .iter()
            .zip(&table.x0)
            .map(|(x, x0)| i64::from(x.saturating_sub(*x0)));
        let sum: i64 = row
            .k
            .iter()
            .zip(departures)
            .map(|(k, d)| i64::from(*k) * d)
            .sum();
        let u = (i64::from(row.bias) - sum) >> row.shift;
        u.clamp(i64::from(row.low), i64::from(row.high))
    })
}
