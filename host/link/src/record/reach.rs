//! Whether servos can get to the goals of a motion, asked before any of them has torque: a goal
//! beyond a limit is ignored, and a goal that several servos get in one packet is not answered.

use crate::error::{Error, Result};
use crate::{OneMode, OneServo};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT};

/// The least and the largest goal of a servo in a motion, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalRange {
    /// The least.
    pub least_rad: f64,
    /// The largest.
    pub most_rad: f64,
}

impl GoalRange {
    /// Of these goals, rad; none of no goals.
    pub fn of(mut goals_rad: impl Iterator<Item = f64>) -> Option<GoalRange> {
        let first = goals_rad.next()?;
        let one = GoalRange {
            least_rad: first,
            most_rad: first,
        };
        Some(goals_rad.fold(one, |range, goal| GoalRange {
            least_rad: range.least_rad.min(goal),
            most_rad: range.most_rad.max(goal),
        }))
    }
}

/// How far a servo was told to go in a motion, and how far it went, rad.
#[derive(Debug, Clone, Copy, Default)]
pub struct ServoTravel {
    goals: Option<GoalRange>,
    measured: Option<GoalRange>,
}

impl ServoTravel {
    /// Goals that go over less say little of whether they are followed, rad.
    const LEAST_RAD: f64 = 0.1;
    /// A servo that covers less than this share of its goals' range does not follow them.
    const LEAST_SHARE: f64 = 0.2;

    /// Counts a sample under torque.
    pub fn count(&mut self, goal_rad: f64, measured_rad: f64) {
        let with = |range: Option<GoalRange>, new: f64| {
            let old = range
                .into_iter()
                .flat_map(|range| [range.least_rad, range.most_rad]);
            GoalRange::of(old.chain([new]))
        };
        self.goals = with(self.goals, goal_rad);
        self.measured = with(self.measured, measured_rad);
    }

    /// How far it went and how far it was told to, rad, where it did not follow.
    pub fn not_followed(&self) -> Option<(f64, f64)> {
        let span = |range: GoalRange| range.most_rad - range.least_rad;
        let (wanted, went) = (span(self.goals?), span(self.measured?));
        let stays = wanted > Self::LEAST_RAD && went < Self::LEAST_SHARE * wanted;
        stays.then_some((went, wanted))
    }
}

/// Within which codes a servo takes goals, and which registers say so.
pub(super) struct GoalLimits {
    /// The servo.
    pub id: u8,
    /// The least and the largest code.
    pub codes: (i32, i32),
    /// What they are called, the least first; none where the kind of servo sets them.
    pub registers: Option<(&'static str, &'static str)>,
}

impl GoalLimits {
    /// Whether all goals lie within; `code_of` gives a goal's code, `angle_of` a code's angle.
    ///
    /// # Errors
    /// The goal that does not, and the limit.
    pub fn hold(
        &self,
        goals: GoalRange,
        code_of: impl Fn(f64) -> i32,
        angle_of: impl Fn(i32) -> f64,
    ) -> Result<()> {
        let (id, (least, most)) = (self.id, self.codes);
        let is_beyond = |goal: f64| !(least..=most).contains(&code_of(goal));
        let Some(goal) = [goals.least_rad, goals.most_rad]
            .into_iter()
            .find(|g| is_beyond(*g))
        else {
            return Ok(());
        };
        let (code, is_low) = (code_of(goal), code_of(goal) < least);
        let limit = if is_low { least } else { most };
        let name = self
            .registers
            .map(|(low, high)| if is_low { low } else { high });
        let what = format!(
            "servo {id} cannot get to its goal of {goal:.3} rad (code {code}): its {} is code \
             {limit}, {:.3} rad",
            name.unwrap_or("range's end"),
            angle_of(limit)
        );
        let remedy = match name {
            Some(name) => format!(
                "keep the motion within, or move the limit, torque off: handstand bus write {id} \
                 {} CODE",
                name.replace(' ', "-")
            ),
            None => "keep the motion within".to_string(),
        };
        Err(Error::device(what, remedy))
    }

    /// The code at which a servo that stands at `code` is held when its torque comes on: that
    /// itself, or the limit that it was pushed beyond by no more than `slack` codes.
    ///
    /// # Errors
    /// It stands farther outside, where no goal can hold it.
    pub fn held(&self, code: i32, slack: i32) -> Result<i32> {
        let (id, (least, most)) = (self.id, self.codes);
        let nearest = code.clamp(least, most);
        if (code - nearest).abs() <= slack {
            return Ok(nearest);
        }
        let (low, high) = self.registers.unwrap_or(("least code", "largest code"));
        Err(Error::device(
            format!("servo {id} stands at code {code}, outside its limits of {least} to {most}"),
            format!(
                "turn it back by hand, torque off, or move the limit (`{low}`, `{high}`): with \
                 torque it would swing to the limit"
            ),
        ))
    }
}

/// How far a servo may be pushed beyond its limit and still be held there, rad.
pub(super) const SLACK_RAD: f64 = 0.05;

/// Within which codes a servo of Protocol 1.0 takes goals.
///
/// # Errors
/// It is in wheel mode.
pub(super) fn one_limits(servo: &OneServo) -> Result<GoalLimits> {
    let (id, last) = (servo.id, servo.model.codes - 1);
    let Some(codes) = servo.goal_limits() else {
        return Err(Error::device(
            format!("servo {id} is in wheel mode (both angle limits 0), which takes no positions"),
            format!("handstand bus write {id} ccw-angle-limit {last} makes it a joint again"),
        ));
    };
    let named = servo.mode == OneMode::Joint;
    Ok(GoalLimits {
        id,
        codes,
        registers: named.then_some((CW_LIMIT.name, CCW_LIMIT.name)),
    })
}

/// Whether a servo of Protocol 1.0 can get to all of these goals.
///
/// # Errors
/// Wheel mode, or the goal and the limit beyond which it lies.
pub(super) fn one_may_reach(servo: &OneServo, goals: GoalRange) -> Result<()> {
    one_limits(servo)?.hold(goals, |rad| servo.code_of(rad), |code| servo.angle_of(code))
}

/// The code at which a servo of Protocol 1.0 that stands at `code` is held.
///
/// # Errors
/// Wheel mode, a turn that is not the first, or it stands outside its limits.
pub(super) fn one_held(servo: &OneServo, code: i32) -> Result<i32> {
    let (id, turn) = (servo.id, servo.first_turn());
    if servo.mode == OneMode::MultiTurn && !turn.contains(&code) {
        let (first, last) = (turn.start, turn.end - 1);
        return Err(Error::device(
            format!("servo {id} stands at code {code}, outside the turn from {first} to {last}"),
            "a motion's angles are within that turn: torque off, and turn it back, or switch its \
             power off and on, which forgets the turns",
        ));
    }
    let slack = (SLACK_RAD / servo.lsb_rad()).round() as i32;
    one_limits(servo)?.held(code, slack)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: GoalLimits = GoalLimits {
        id: 2,
        codes: (10, 100),
        registers: Some(("min position limit", "max position limit")),
    };

    fn hold(least_rad: f64, most_rad: f64) -> Result<()> {
        let goals = GoalRange {
            least_rad,
            most_rad,
        };
        LIMITS.hold(
            goals,
            |rad| (rad * 100.0).round() as i32,
            |code| f64::from(code) / 100.0,
        )
    }

    #[test]
    fn a_goal_beyond_a_limit_is_named_with_it() {
        hold(0.1, 1.0).unwrap();
        let over = hold(0.1, 1.02).unwrap_err();
        let said = "servo 2 cannot get to its goal of 1.020 rad (code 102): its max position limit \
                    is code 100, 1.000 rad";
        assert_eq!(over.to_string(), said);
        assert!(
            over.remedy()
                .unwrap()
                .contains("bus write 2 max-position-limit CODE")
        );
        let under = hold(-0.5, 1.02).unwrap_err().to_string();
        assert!(under.contains("min position limit is code 10"), "{under}");
    }

    #[test]
    fn a_servo_that_stands_still_is_told_from_one_that_lags() {
        let travel = |share: f64| {
            let mut travel = ServoTravel::default();
            for k in 0..100 {
                let goal = 0.3 * (f64::from(k) * 0.1).sin();
                travel.count(goal, share * goal);
            }
            travel.not_followed()
        };
        assert_eq!(travel(0.9), None);
        assert_eq!(travel(0.3), None);
        let (went, wanted) = travel(0.01).unwrap();
        assert!((wanted - 0.6).abs() < 0.01 && went < 0.01);
        assert_eq!(ServoTravel::default().not_followed(), None);
    }

    #[test]
    fn a_servo_is_held_where_it_stands_or_at_the_limit_it_leans_on() {
        assert_eq!(LIMITS.held(50, 5).unwrap(), 50);
        assert_eq!(LIMITS.held(104, 5).unwrap(), 100);
        let error = LIMITS.held(106, 5).unwrap_err().to_string();
        assert!(
            error.contains("stands at code 106, outside its limits of 10 to 100"),
            "{error}"
        );
    }
}
