//! In which manner a robot stands: at rest, leaning, swinging, or hunting by stick-slip.

use crate::effects::{AtRest, Site};
use crate::model::Model;
use serde::Serialize;

/// A servo's code is 0.29 deg: a joint that is read within two of them rests, rad.
const REST_RAD: f64 = 0.0103;
/// Mean departure of a joint from which a robot at rest leans, rad: 1 deg.
const LEAN_RAD: f64 = 0.017_453_292_519_943_295;
/// A joint whose reading stays within a code for so long, s, keeps still: one that swings does so
/// at either end, for less than half of the time.
const STICKS_S: f64 = 0.15;
/// Share of the time that the liveliest joint keeps still where the robot hunts.
const STILL_SHARE: f64 = 0.5;

/// In which manner a robot stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "manner", rename_all = "snake_case")]
pub enum Manner {
    /// No joint moves by more than two steps of its encoder, near upright.
    AtRest {
        /// Largest departure of a joint from peak to peak, rad.
        swing_rad: f64,
    },
    /// The same away from upright.
    Leaning {
        /// Largest mean departure of a joint, rad.
        lean_rad: f64,
        /// Largest departure of a joint from peak to peak, rad.
        swing_rad: f64,
    },
    /// Joints move all the time.
    Swinging {
        /// Largest departure of a joint from peak to peak, rad.
        swing_rad: f64,
    },
    /// A joint with dry friction sticks and slips.
    Hunting {
        /// Largest departure of a joint from peak to peak, rad.
        swing_rad: f64,
    },
}

impl Manner {
    /// Of a robot that stood to its end: times, s, and the angle of each joint from its pose, rad.
    /// The last `window_s` count, for what came before is the way back from the start; `sticks`
    /// says whether anything in the robot can ([`can_stick`]).
    pub fn of(samples: &[(f64, Vec<f64>)], window_s: f64, sticks: bool) -> Manner {
        let end_s = samples.last().map_or(0.0, |(time_s, _)| *time_s);
        let late = samples.partition_point(|(time_s, _)| *time_s <= end_s - window_s);
        let late = &samples[late..];
        let (mut swing_rad, mut lean_rad, mut liveliest) = (0.0_f64, 0.0_f64, 0);
        for joint in 0..late.first().map_or(0, |(_, angles)| angles.len()) {
            let angles = || late.iter().map(|(_, angles)| angles[joint]);
            let low = angles().fold(f64::INFINITY, f64::min);
            let high = angles().fold(f64::NEG_INFINITY, f64::max);
            let mean = angles().sum::<f64>() / late.len() as f64;
            if high - low > swing_rad {
                (swing_rad, liveliest) = (high - low, joint);
            }
            lean_rad = lean_rad.max(mean.abs());
        }
        let hunts = sticks && still_share(late, liveliest) > STILL_SHARE;
        match (swing_rad > REST_RAD, hunts, lean_rad > LEAN_RAD) {
            (true, true, _) => Manner::Hunting { swing_rad },
            (true, false, _) => Manner::Swinging { swing_rad },
            (false, _, true) => Manner::Leaning {
                lean_rad,
                swing_rad,
            },
            (false, _, false) => Manner::AtRest { swing_rad },
        }
    }

    /// Largest departure of a joint from peak to peak, rad.
    pub fn swing_rad(&self) -> f64 {
        match *self {
            Manner::AtRest { swing_rad }
            | Manner::Leaning { swing_rad, .. }
            | Manner::Swinging { swing_rad }
            | Manner::Hunting { swing_rad } => swing_rad,
        }
    }

    /// For people.
    pub fn words(&self) -> String {
        let swing_deg = self.swing_rad().to_degrees();
        match self {
            Manner::AtRest { .. } => "at rest".to_string(),
            Manner::Leaning { lean_rad, .. } => {
                format!("leaning by {:.1} deg", lean_rad.to_degrees())
            }
            Manner::Swinging { .. } => format!("swinging by {swing_deg:.1} deg peak to peak"),
            Manner::Hunting { .. } => {
                format!("hunting by stick-slip, {swing_deg:.1} deg peak to peak")
            }
        }
    }
}

/// Whether a joint of this robot can stick: its friction jumps at standstill.
pub fn can_stick(model: &Model) -> bool {
    let at_rest = AtRest {
        angle_rad: 0.0,
        duty: 0.0,
        torque_nm: 0.0,
        full_torque_nm: 1.0,
    };
    let mut effects = model.effects.iter();
    effects.any(|instance| {
        let effect = instance.effect;
        let is_friction = effect.info().site == Site::Friction;
        is_friction && effect.slope(&instance.values, &at_rest).is_none()
    })
}

/// Share of the time in which a joint's reading has stayed within a code for `STICKS_S`.
fn still_share(late: &[(f64, Vec<f64>)], joint: usize) -> f64 {
    let (mut since, mut still_s) = (0, 0.0);
    for at in 1..=late.len() {
        let moved = late.get(at).is_none_or(|(_, angles)| {
            (angles[joint] - late[since].1[joint]).abs() > 0.6 * REST_RAD
        });
        if moved {
            let span_s = late[at - 1].0 - late[since].0;
            if span_s >= STICKS_S {
                still_s += span_s;
            }
            since = at;
        }
    }
    match (late.first(), late.last()) {
        (Some((first, _)), Some((last, _))) if last > first => still_s / (last - first),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten seconds in which the shoulder does this, rad over s, read in codes; the last five count.
    fn shoulder(of: impl Fn(f64) -> f64) -> Manner {
        let step = 0.005_113_27;
        let sample = |at: usize| {
            let time_s = 0.01 * at as f64;
            (time_s, vec![0.0, (of(time_s) / step).round() * step, 0.0])
        };
        Manner::of(&(0..=1000).map(sample).collect::<Vec<_>>(), 5.0, true)
    }

    #[test]
    fn manners_are_told_apart() {
        assert!(matches!(shoulder(|_| 0.0), Manner::AtRest { .. }));
        let leans = shoulder(|_| 0.1);
        assert!(matches!(leans, Manner::Leaning { .. }), "{leans:?}");
        assert!(leans.words().contains("5.9 deg"), "{leans:?}");
        let swings = shoulder(|t| 0.1 * (5.0 * t).sin());
        assert!(matches!(swings, Manner::Swinging { .. }), "{swings:?}");
        // Still for half a second, then on to the other side at once.
        let hunts = shoulder(|t| 0.02 * f64::from(u8::from(t.fract() < 0.5)));
        assert!(matches!(hunts, Manner::Hunting { .. }), "{hunts:?}");
    }

    /// What comes before the last seconds is the way back from the start.
    #[test]
    fn the_way_back_does_not_count() {
        let back = shoulder(|t| if t < 4.0 { 0.3 } else { 0.0 });
        assert!(matches!(back, Manner::AtRest { .. }), "{back:?}");
    }
}
