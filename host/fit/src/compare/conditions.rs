//! Conditions under which a model may fail, each in words and as a question to a sample's features.
//!
//! Adding one is an entry in [`CONDITIONS`]. A condition that always holds, or never, is never a
//! finding.

use super::sample_features::{STILL_SHARE, SampleFeatures};

/// A condition as it ends a sentence, and whether a sample meets it.
type NamedCondition = (&'static str, fn(&SampleFeatures) -> bool);

/// All but the ranges of angle, which depend on the motion.
pub(super) const CONDITIONS: &[NamedCondition] = &[
    ("within 80 ms after a reversal", |m| {
        m.since_reversal_s <= 0.08
    }),
    ("near standstill", |m| m.speed.abs() < STILL_SHARE),
    ("while the joint is held still", |m| m.still_s >= 0.25),
    ("at high speed (fastest fifth)", |m| m.speed_rank > 0.8),
    ("while moving in positive direction", |m| {
        m.speed > STILL_SHARE
    }),
    ("while moving in negative direction", |m| {
        m.speed < -STILL_SHARE
    }),
    ("while moving up, against gravity", |m| {
        m.against_gravity > 0.0
    }),
    ("while moving down, with gravity", |m| {
        m.against_gravity < 0.0
    }),
    ("under high load (upper fifth)", |m| m.load_rank > 0.8),
    ("at low supply (lowest quarter)", |m| m.supply_rank < 0.25),
    ("at high supply (highest quarter)", |m| m.supply_rank > 0.75),
    (
        "while the drive is asked for little (below 15 % of its most)",
        |m| m.energised && m.demand.abs() < 0.15,
    ),
    (
        "while the drive is asked for much (above 85 % of its most)",
        |m| m.energised && m.demand.abs() > 0.85,
    ),
    ("within 0.2 s after the command jumps", |m| {
        m.since_jump_s <= 0.2
    }),
    ("while the drive is released", |m| !m.energised),
    ("early in a motion (first third)", |m| m.run < 1.0 / 3.0),
    ("late in a motion (last third)", |m| m.run > 2.0 / 3.0),
    ("with payload", |m| m.payload),
    ("with the rig turned round", |m| m.turned),
];

/// Parts into which the range of angle is cut.
const ANGLE_PARTS: usize = 6;

/// Which samples meet a condition.
pub(super) struct ConditionSamples {
    /// The condition in words.
    pub words: String,
    /// One flag per sample.
    pub holds: Vec<bool>,
}

/// Every condition, ranges of angle included, asked of every sample; `shown` is the unit in which
/// people read the angle, or a slide's displacement, and how many of them one SI unit is.
pub(super) fn met(features: &[SampleFeatures], shown: (&str, f64)) -> Vec<ConditionSamples> {
    let mut all: Vec<ConditionSamples> = CONDITIONS
        .iter()
        .map(|(words, holds)| ConditionSamples {
            words: words.to_string(),
            holds: features.iter().map(holds).collect(),
        })
        .collect();
    all.extend(angle_ranges(features, shown));
    all
}

/// Sixths of the range between the smallest and the largest angle.
fn angle_ranges(features: &[SampleFeatures], (unit, per_si): (&str, f64)) -> Vec<ConditionSamples> {
    let angles = || features.iter().map(|m| m.angle_rad);
    let low = angles().fold(f64::INFINITY, f64::min);
    let high = angles().fold(f64::NEG_INFINITY, f64::max);
    if high.partial_cmp(&low) != Some(std::cmp::Ordering::Greater) {
        return Vec::new();
    }
    let edge = |part: usize| low + (high - low) * part as f64 / ANGLE_PARTS as f64;
    // Ends that differ look different.
    let digits = match per_si * (high - low) {
        range if range < 0.6 => 3,
        range if range < 60.0 => 2,
        _ => 0,
    };
    (0..ANGLE_PARTS)
        .map(|part| {
            let (from, to) = (edge(part), edge(part + 1));
            let last = part + 1 == ANGLE_PARTS;
            ConditionSamples {
                words: format!(
                    "between {:.digits$} and {:.digits$} {unit}",
                    per_si * from,
                    per_si * to
                ),
                holds: angles().map(|a| a >= from && (a < to || last)).collect(),
            }
        })
        .collect()
}
