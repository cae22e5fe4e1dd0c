//! Conditions under which a model may fail, each in words and as a question to a moment.
//!
//! Adding one is an entry in [`CONDITIONS`]. A condition that always holds, or never, is never a finding.

use super::moment::{Moment, STILL_SHARE};

/// A condition.
pub(super) struct Condition {
    /// As it ends a sentence.
    pub words: &'static str,
    /// Whether a moment meets it.
    pub holds: fn(&Moment) -> bool,
}

/// All but the ranges of angle, which depend on the motion.
pub(super) const CONDITIONS: &[Condition] = &[
    Condition {
        words: "within 80 ms after a reversal",
        holds: |m| m.since_reversal_s <= 0.08,
    },
    Condition {
        words: "near standstill",
        holds: |m| m.speed.abs() < STILL_SHARE,
    },
    Condition {
        words: "while the joint is held still",
        holds: |m| m.still_s >= 0.25,
    },
    Condition {
        words: "at high speed (fastest fifth)",
        holds: |m| m.speed_rank > 0.8,
    },
    Condition {
        words: "while moving in positive direction",
        holds: |m| m.speed > STILL_SHARE,
    },
    Condition {
        words: "while moving in negative direction",
        holds: |m| m.speed < -STILL_SHARE,
    },
    Condition {
        words: "while moving up, against gravity",
        holds: |m| m.against_gravity > 0.0,
    },
    Condition {
        words: "while moving down, with gravity",
        holds: |m| m.against_gravity < 0.0,
    },
    Condition {
        words: "under high load (upper fifth)",
        holds: |m| m.load_rank > 0.8,
    },
    Condition {
        words: "at low supply (lowest quarter)",
        holds: |m| m.supply_rank < 0.25,
    },
    Condition {
        words: "at high supply (highest quarter)",
        holds: |m| m.supply_rank > 0.75,
    },
    Condition {
        words: "while the drive is asked for little (below 15 % of its most)",
        holds: |m| m.energised && m.demand.abs() < 0.15,
    },
    Condition {
        words: "while the drive is asked for much (above 85 % of its most)",
        holds: |m| m.energised && m.demand.abs() > 0.85,
    },
    Condition {
        words: "within 0.2 s after the command jumps",
        holds: |m| m.since_jump_s <= 0.2,
    },
    Condition {
        words: "while the drive is released",
        holds: |m| !m.energised,
    },
    Condition {
        words: "early in a motion (first third)",
        holds: |m| m.run < 1.0 / 3.0,
    },
    Condition {
        words: "late in a motion (last third)",
        holds: |m| m.run > 2.0 / 3.0,
    },
    Condition {
        words: "with payload",
        holds: |m| m.payload,
    },
    Condition {
        words: "with the rig turned round",
        holds: |m| m.turned,
    },
];

/// Parts into which the range of angle is cut.
const ANGLE_PARTS: usize = 6;

/// Which samples meet a condition.
pub(super) struct Met {
    /// The condition in words.
    pub words: String,
    /// One flag per moment.
    pub holds: Vec<bool>,
}

/// Every condition, ranges of angle included, asked of every moment.
pub(super) fn met(moments: &[Moment]) -> Vec<Met> {
    let mut all: Vec<Met> = CONDITIONS
        .iter()
        .map(|condition| Met {
            words: condition.words.to_string(),
            holds: moments.iter().map(condition.holds).collect(),
        })
        .collect();
    all.extend(angle_ranges(moments));
    all
}

/// Sixths of the range between the smallest and the largest angle.
fn angle_ranges(moments: &[Moment]) -> Vec<Met> {
    let angles = || moments.iter().map(|m| m.angle_rad);
    let low = angles().fold(f64::INFINITY, f64::min);
    let high = angles().fold(f64::NEG_INFINITY, f64::max);
    if high.partial_cmp(&low) != Some(std::cmp::Ordering::Greater) {
        return Vec::new();
    }
    let edge = |part: usize| low + (high - low) * part as f64 / ANGLE_PARTS as f64;
    let digits = if high - low < 0.6 { 3 } else { 2 };
    (0..ANGLE_PARTS)
        .map(|part| {
            let (from, to) = (edge(part), edge(part + 1));
            let last = part + 1 == ANGLE_PARTS;
            Met {
                words: format!("between {from:.digits$} and {to:.digits$} rad"),
                holds: angles().map(|a| a >= from && (a < to || last)).collect(),
            }
        })
        .collect()
}
