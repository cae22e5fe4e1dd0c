//! The plant as the observers believe it: sampled, with late inputs, servos and the angles at which
//! it balances.

use super::{DesignModel, ServoLag};
use crate::error::Result;
use crate::synth::{Continuous, Discrete, zoh};
use nalgebra::DMatrix;

/// What of the robot is in the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Parts {
    /// Unknown angles of balance, constant: eccentric masses shift the equilibrium, x' = A (x - [e,
    /// 0]) + B u.
    pub offsets: bool,
    /// The inputs' delay.
    pub delay: bool,
    /// The servos.
    pub servo: bool,
}

/// z(k+1) = A z + B u with z = [angles, speeds, offsets, past inputs, servos].
pub(super) fn plant(known: &DesignModel, parts: Parts) -> Result<Discrete> {
    let continuous = continuous(known, parts.offsets);
    let delay_s = if parts.delay { known.delay_s } else { 0.0 };
    let sampled = zoh(&continuous, known.period_s, delay_s)?;
    Ok(match known.servo.filter(|_| parts.servo) {
        Some(servo) => behind(&sampled, servo),
        None => sampled,
    })
}

/// x' = A x + B u, with the angles of balance behind the state if they are wanted.
pub(super) fn continuous(known: &DesignModel, offsets: bool) -> Continuous {
    let Continuous { a, b, .. } = &known.plant;
    let (n, m, joints) = (a.nrows(), b.ncols(), known.joints());
    let all = if offsets { n + joints } else { n };
    let (mut wide, mut drive) = (DMatrix::zeros(all, all), DMatrix::zeros(all, m));
    wide.view_mut((0, 0), (n, n)).copy_from(a);
    drive.view_mut((0, 0), (n, m)).copy_from(b);
    if offsets {
        wide.view_mut((0, n), (n, joints))
            .copy_from(&-a.columns(0, joints));
    }
    Continuous {
        a: wide,
        b: drive,
        c: DMatrix::identity(all, all),
    }
}

/// The plant with a servo before each input; their states come last.
fn behind(plant: &Discrete, servo: ServoLag) -> Discrete {
    let (n, m) = plant.b.shape();
    let all = n + 2 * m;
    let (mut a, mut b) = (DMatrix::zeros(all, all), DMatrix::zeros(all, m));
    a.view_mut((0, 0), (n, n)).copy_from(&plant.a);
    for drive in 0..m {
        let at = n + 2 * drive;
        a.view_mut((0, at), (n, 1))
            .copy_from(&plant.b.column(drive));
        a[(at, at)] = -servo.a[0];
        a[(at, at + 1)] = 1.0;
        a[(at + 1, at)] = -servo.a[1];
        b[(at, drive)] = servo.b;
    }
    Discrete {
        a,
        b,
        c: plant.c.clone().resize(plant.c.nrows(), all, 0.0),
        ts_s: plant.ts_s,
        delayed_inputs: plant.delayed_inputs,
    }
}
