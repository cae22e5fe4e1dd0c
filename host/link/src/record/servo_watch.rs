//! What must hold before servos of Protocol 2.0 are moved, and their bus watchdog while they are.

use crate::error::{Error, Result};
use handstand_shared::control_table::WATCHDOG_LSB_MS;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x;
use std::time::Duration;

/// The shortest silence that trips. A recording is brought to the disk twice a second, which may
/// take longer than the 100 ms that the manual's example has.
const LEAST_MS: u32 = 200;
/// Rounds that may be lost before it trips.
const ROUNDS: u32 = 5;

/// The bus watchdog: a deadman in each servo, which stops it when its host falls silent.
#[derive(Debug, Clone, Copy)]
pub(super) struct ServoWatch {
    code: u8,
}

impl ServoWatch {
    /// For rounds every `period`; off unless `on`.
    ///
    /// # Errors
    /// Rounds too far apart for it, or firmware that lacks it.
    pub fn new(
        on: bool,
        period: Duration,
        models: &[&ServoModel],
        firmware: &[u8],
        ids: &[u8],
    ) -> Result<Self> {
        const REMEDY: &str = "or pass --no-watchdog: then nothing stops the servos when the line \
                              breaks";
        if !on {
            return Ok(ServoWatch { code: 0 });
        }
        let lacking = models
            .iter()
            .zip(firmware)
            .position(|(model, version)| !model.has_watchdog(*version));
        if let Some(place) = lacking {
            return Err(Error::device(
                format!(
                    "servo {} has firmware {}, which has no bus watchdog",
                    ids[place], firmware[place]
                ),
                format!("renew it with ROBOTIS's program, {REMEDY}"),
            ));
        }
        let wanted_ms = period.as_millis().saturating_mul(u128::from(ROUNDS));
        let code = wanted_ms
            .max(u128::from(LEAST_MS))
            .div_ceil(u128::from(WATCHDOG_LSB_MS));
        match u8::try_from(code) {
            Ok(code @ 1..=127) => Ok(ServoWatch { code }),
            _ => Err(Error::usage(
                format!(
                    "rounds every {} ms are too slow for the bus watchdog",
                    period.as_millis()
                ),
                format!("give --hz 2 or more, {REMEDY}"),
            )),
        }
    }

    /// Whether it is on.
    pub fn is_on(self) -> bool {
        self.code > 0
    }

    /// The code of the register.
    pub fn code(self) -> i32 {
        i32::from(self.code)
    }

    /// What to say when it has tripped.
    pub fn tripped(self, id: u8) -> String {
        let ms = u32::from(self.code) * WATCHDOG_LSB_MS;
        format!("the bus watchdog of servo {id} tripped: it heard nothing for {ms} ms")
    }
}

/// Whether an operating mode takes positions.
///
/// # Errors
/// It does not, and what to do.
pub(super) fn takes_positions(id: u8, mode: i32) -> Result<()> {
    match mode {
        3..=5 => Ok(()),
        _ => Err(Error::device(
            format!("servo {id} is in operating mode {mode}, which takes no positions"),
            format!("handstand bus write {id} operating-mode 3 (position), torque off"),
        )),
    }
}

/// Whether a servo may be moved: it has no hardware error, and where its turns are counted it
/// stands within `turn`, the codes of the first, which its homing offset shifts.
///
/// # Errors
/// Why not, and what to do.
pub(super) fn may_move(
    id: u8,
    position: i32,
    turn: Option<std::ops::Range<i32>>,
    error: i32,
) -> Result<()> {
    if error != 0 {
        let names: Vec<&str> = x::hardware_errors(error as u8).collect();
        return Err(Error::device(
            format!("servo {id} reports: {}", names.join(", ")),
            format!("remove the cause, then: handstand bus reboot {id}"),
        ));
    }
    if let Some(turn) = turn
        && !turn.contains(&position)
    {
        let (first, last) = (turn.start, turn.end - 1);
        return Err(Error::device(
            format!(
                "servo {id} stands at code {position}, outside the turn from {first} to {last}"
            ),
            format!(
                "a motion's angles are within that turn: torque off, turn it back, or \
                 handstand bus reboot {id}, which forgets the turns"
            ),
        ));
    }
    Ok(())
}

/// The first goal after torque went on may be at most so far from where the servo stands, rad.
const FIRST_GOAL_RAD: f64 = 0.35;

/// Whether the first goals are near enough to where the servos stand.
///
/// # Errors
/// The servo that would swing.
pub(super) fn may_begin(ids: &[u8], stood_rad: &[f64], goals_rad: &[f64]) -> Result<()> {
    for ((id, stood), goal) in ids.iter().zip(stood_rad).zip(goals_rad) {
        if (goal - stood).abs() > FIRST_GOAL_RAD {
            return Err(Error::device(
                format!("servo {id} stands at {stood:.2} rad, and its first goal is {goal:.2} rad"),
                format!("begin within {FIRST_GOAL_RAD} rad of where the servos stand"),
            ));
        }
    }
    Ok(())
}
