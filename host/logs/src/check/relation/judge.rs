//! What the relations of a file's columns say of signs, scales and zeros.

use super::super::excitation::name;
use super::super::finding::Findings;
use super::super::fit::LineFit;
use super::{InputKind, MOVING_RAD_S, Relations};
use crate::error::Place;
use crate::model::Model;

/// Standard errors for a sign to be believed. Under feedback the input follows the motion: an idle
/// shoulder of a public double pendulum reaches -4.8 with the sign right, and a delayed PD loop
/// shows no sign at all.
const SURE: f64 = 8.0;

impl Relations {
    pub fn judge(&mut self, place: &Place, model: &Model, findings: &mut Findings) {
        for joint in 0..self.drives.len() {
            let columns = &model.log.joints[joint];
            let (speed, angle) = (name(&columns.velocity), name(&columns.position));
            let measured = match (self.drives[joint], &columns.velocity) {
                (InputKind::Speed, Some(_)) => &speed,
                _ => &angle,
            };
            if let Some(input) = &columns.input {
                self.judge_follow(joint, &input.name(), measured, place, findings);
                self.judge_push(joint, &input.name(), place, findings);
            }
            if columns.velocity.is_some() && columns.position.is_some() {
                judge_speed(&self.speed[joint], (&speed, &angle), place, findings);
            }
            if columns.rate.is_some() {
                judge_speed(
                    &self.rate[joint],
                    (&name(&columns.rate), &angle),
                    place,
                    findings,
                );
            }
            let nominal = model.joints[joint]
                .drive
                .motor()
                .and_then(|motor| motor.nominal_supply_v);
            self.judge_supply(nominal, place, findings);
        }
        self.judge_gravity(model, place, findings);
    }

    fn judge_follow(
        &self,
        joint: usize,
        goal: &str,
        measured: &str,
        place: &Place,
        findings: &mut Findings,
    ) {
        let lines = &self.follow[joint];
        let by_correlation =
            |a: &&LineFit, b: &&LineFit| a.correlation().total_cmp(&b.correlation());
        let enough = lines
            .iter()
            .filter(|line| line.count() >= 20 && line.spread() > 0.02);
        let Some(best) = enough.clone().max_by(by_correlation) else {
            return;
        };
        let worst = enough.min_by(by_correlation).unwrap_or(best);
        let (correlation, slope, offset) = (best.correlation(), best.slope(), best.offset());
        let (what, remedy) = if correlation < 0.3 && worst.correlation() < -0.5 {
            let against = worst.correlation();
            (
                format!("{measured} runs against {goal} (correlation {against:.2})"),
                "one of the two counts the other way round: set reversed on it",
            )
        } else if correlation < 0.8 {
            (
                format!("{measured} hardly follows {goal} (correlation {correlation:.2})"),
                "was the drive saturated, stuck, or off? Are the columns named right?",
            )
        } else if !(0.8..1.25).contains(&slope) {
            let guess = if (45.0..72.0).contains(&slope.max(1.0 / slope)) {
                "degrees on one side, radians on the other?"
            } else {
                "a wrong unit, count per turn or gear ratio, or a drive too weak for its goal?"
            };
            (
                format!("{measured} moves {slope:.3} times as far as {goal}: {guess}"),
                "check both columns' units in the model's [log]",
            )
        } else if self.drives[joint] == InputKind::Angle && offset.abs() > 0.1 {
            (
                format!("{measured} lies {offset:.3} rad from {goal} on the mean: a wrong zero?"),
                "set the offset of one of them, unless the load really makes the joint sag so far",
            )
        } else {
            return;
        };
        findings.warn("relation", place.clone(), (what, remedy));
    }

    fn judge_push(&self, joint: usize, input: &str, place: &Place, findings: &mut Findings) {
        if self.drives[joint] != InputKind::Push {
            return;
        }
        let Some(own) = self.push[joint].solve().map(|all| all[5 * joint]) else {
            return;
        };
        if own.t < -SURE {
            let what = format!(
                "{input} pushes the joint the wrong way ({:.1} standard errors)",
                own.t
            );
            let remedy = "the input or the angle counts the other way round: set reversed on it";
            findings.warn("relation", place.clone(), (what, remedy));
        }
    }

    /// A single link must be pulled towards hanging.
    fn judge_gravity(&self, model: &Model, place: &Place, findings: &mut Findings) {
        if self.drives.len() != 1 || matches!(self.drives[0], InputKind::Angle | InputKind::Speed) {
            return;
        }
        let Some(all) = self.push[0].solve() else {
            return;
        };
        let (sine, cosine) = (all[1], all[2]);
        let tilt = cosine.value.atan2(-sine.value);
        if tilt.abs() > 0.35 && sine.t.hypot(cosine.t) > 3.0 * SURE {
            let name = name(&model.log.joints[0].position);
            let what = format!(
                "gravity pulls {tilt:.2} rad beside where {name} has it hang: a wrong angle_zero, \
                 sign or unit, or a tilted rig"
            );
            let remedy = "compare the resting angle in the log with the model's angle_zero";
            findings.warn("relation", place.clone(), (what, remedy));
        }
    }

    fn judge_supply(&self, nominal: Option<f64>, place: &Place, findings: &mut Findings) {
        let Some(nominal) = nominal else {
            return;
        };
        let (low, high) = (self.supply_v.low.0, self.supply_v.high.0);
        if low < 0.5 * nominal || high > 1.5 * nominal {
            let what =
                format!("the supply ranges from {low:.2} to {high:.2} V; {nominal} V is nominal");
            let remedy = "check the supply column's unit, and the wiring";
            findings.warn("supply", place.clone(), (what, remedy));
        }
    }
}

fn judge_speed(
    line: &LineFit,
    (speed, angle): (&str, &str),
    place: &Place,
    findings: &mut Findings,
) {
    if line.count() < 20 || line.spread() < MOVING_RAD_S {
        return;
    }
    let what = if line.correlation() < -0.5 {
        format!("{speed} runs against the change of {angle}")
    } else if line.correlation() > 0.8 && !(0.8..1.25).contains(&line.slope()) {
        format!("{speed} is {:.3} times the change of {angle}", line.slope())
    } else if line.correlation() < 0.8 {
        format!(
            "{speed} is not the change of {angle} (correlation {:.2})",
            line.correlation()
        )
    } else {
        return;
    };
    let remedy = "check names, units and signs of both columns, and the unit of time";
    findings.warn("relation", place.clone(), (what, remedy));
}
