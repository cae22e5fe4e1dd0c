//! The angles at which a robot balances that is not symmetric: the paper's angle compensation.

use handstand_shared::message::Attitude;
use handstand_shared::observer::FINE;
use handstand_shared::plan::Moment;
use handstand_shared::raw::Position;
use micromath::F32Ext;

/// Angles with the joints' in whole codes.
pub(super) fn coarse([e1, e2, e3]: [i16; 3]) -> [i16; 3] {
    let whole = |e: i16| e.saturating_add(1 << (FINE - 1)) >> FINE;
    [e1, whole(e2), whole(e3)]
}

/// The angles at which the links' masses balance, beside upright: every link's resultant centre of
/// mass above its joint.
///
/// The paper, section IV.D: "finding and compensating the system with the angle of the resultant
/// center of gravity". Gravity's torques vanish where the moments p_j e^{i t_j} of all links point
/// up, so at absolute angles t_j = -arg p_j. micromath's arc is off by up to 0.003 rad; an observer
/// finds the rest.
#[inline(never)]
pub(super) fn compensation(moments: &[Moment; 3]) -> [i16; 3] {
    const STEPS: [f32; 3] = [
        (1.0 / Attitude::ANGLE_LSB_RAD) as f32,
        ((1 << FINE) as f64 / Position::LSB_RAD) as f32,
        ((1 << FINE) as f64 / Position::LSB_RAD) as f32,
    ];
    let mut angles = [0; 3];
    let mut before = 0.0;
    for ((angle, moment), steps) in angles.iter_mut().zip(moments).zip(STEPS) {
        let absolute = match moment.aside {
            // Exactly, not nearly, straight.
            0 => 0.0,
            aside => -F32Ext::atan2(f32::from(aside), f32::from(moment.along)),
        };
        *angle = ((absolute - before) * steps) as i16;
        before = absolute;
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A millimetre aside at 30: 33 mrad; a straight link between tilted ones turns both its
    /// joints.
    #[test]
    fn resultant_masses_come_to_lie_above_their_joints() {
        let tilted = Moment {
            along: 3000,
            aside: 100,
        };
        let straight = Moment {
            along: 3000,
            aside: 0,
        };
        let found = compensation(&[tilted, straight, tilted]);
        let rad = (100f64 / 3000.0).atan();
        let fine = f64::from(1 << FINE) / Position::LSB_RAD;
        let exact = [-rad * 1e4, rad * fine, -rad * fine];
        for (i, exact) in exact.into_iter().enumerate() {
            let step = if i == 0 { 1e4 } else { fine };
            assert!(
                (f64::from(found[i]) - exact).abs() <= 3e-3 * step + 1.0,
                "{found:?}"
            );
        }
        assert_eq!(compensation(&[Moment::ZERO; 3]), [0; 3]);
        assert_eq!(coarse([7, 48, -48]), [7, 2, -1]);
    }
}
