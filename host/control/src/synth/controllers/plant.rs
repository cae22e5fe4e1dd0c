//! The plant as the observers believe it: sampled, with late inputs, servos and the angles at which
//! it balances.

use super::{DesignModel, ServoLag};
use crate::error::Result;
use crate::synth::{Continuous, Discrete, zoh};
use nalgebra::DMatrix;

/// z(k+1) = A z + B u with z = [angles, speeds, offsets, past inputs, servos], of the delay and the
/// servos that are known. The offsets, if they are wanted, are unknown angles of balance, constant:
/// eccentric masses shift the equilibrium, x' = A (x - [e, 0]) + B u.
pub(super) fn plant(known: &DesignModel, offsets: bool) -> Result<Discrete> {
    let sampled = zoh(&continuous(known, offsets), known.period_s, known.delay_s)?;
    Ok(match known.servo {
        Some(servo) => behind(&sampled, servo),
        None => sampled,
    })
}

/// x' = A x + B u, with the angles of balance behind the state if they are wanted.
pub(super) fn continuous(known: &DesignModel, offsets: bool) -> Continuous {
    let Continuous { a, b, .. } = &known.plant;
    let (n, m, joints) = (a.nrows(), b.ncols(), known.joints());
    let all = if offsets { n + joints } else { n };
    let mut wide = a.clone().resize(all, all, 0.0);
    if offsets {
        let angles = -a.columns(0, joints);
        wide.view_mut((0, n), (n, joints)).copy_from(&angles);
    }
    Continuous {
        a: wide,
        b: b.clone().resize(all, m, 0.0),
        c: DMatrix::identity(all, all),
    }
}

/// Gains on [angles, speeds, ..] as gains on [angles, speeds, offsets, ..]: offsets act as the
/// angles' negatives.
pub(super) fn with_offsets(gains: &DMatrix<f64>, joints: usize) -> DMatrix<f64> {
    let mut wide = gains.clone().insert_columns(2 * joints, joints, 0.0);
    let angles = -gains.columns(0, joints);
    wide.columns_mut(2 * joints, joints).copy_from(&angles);
    wide
}

/// The plant with a servo before each input; their states come last.
fn behind(plant: &Discrete, servo: ServoLag) -> Discrete {
    let (n, m) = plant.b.shape();
    let all = n + 2 * m;
    let (mut a, mut b) = (
        plant.a.clone().resize(all, all, 0.0),
        DMatrix::zeros(all, m),
    );
    for drive in 0..m {
        let at = n + 2 * drive;
        let mut torque = a.view_mut((0, at), (n, 1));
        torque.copy_from(&plant.b.column(drive));
        a[(at, at)] = -servo.a[0];
        a[(at, at + 1)] = 1.0;
        a[(at + 1, at)] = -servo.a[1];
        b[(at, drive)] = servo.b;
    }
    Discrete {
        a,
        b,
        c: plant.c.clone().resize(plant.c.nrows(), all, 0.0),
        ..*plant
    }
}
