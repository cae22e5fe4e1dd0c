//! What a plan for a model is made with: each effect of the model where a plan has a place for it.
//!
//! Masses, smooth friction, back-EMF and whatever else has a derivative shape the gains. The
//! drives' delay and the encoders' lag go into the observer, which knows when inputs act and how
//! old readings are; what a drive loses of a command, by dead zone and dry friction, is jumped
//! over; its limits limit. [`PlanBasis::uses`] says so of each effect, and of those that no plan
//! has a place for.

mod uses;

pub use uses::{EffectUse, UsePlace};

use super::{Board, BoardLaw, observer_design, plan};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::synth::controllers::BoardTiming;
use handstand_shared::observer::{DELAYS, INPUTS};
use handstand_shared::plan::Plan;

/// A command this many times the nominal width of a dead zone passes every robot's own, which may
/// differ by a fifth.
const MARGIN: f64 = 1.21;
/// Left of the periods that the CM-5 keeps inputs of, s: so much rounding may take.
const SPARE_S: f64 = 1e-4;

/// Shorter filters are lost in the period, and the state before them is hardly to be computed, s.
const LEAST_LAG_S: f64 = 2e-3;

/// What is told of the drives beside the model, and goes before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToldDrives {
    /// Torque of a joint that is left at full output, N m.
    pub full_nm: Option<f64>,
    /// Share of full output that is lost of every command.
    pub dead_zone: Option<f64>,
    /// Delay of the drives, s.
    pub delay_s: Option<f64>,
    /// Time constant with which a torque follows its command, s; no effect of a model says it.
    pub lag_s: f64,
    /// Supply that the robot will have, V; else that for which the model's figures hold.
    pub supply_v: Option<f64>,
    /// Largest share of the torque that may be commanded.
    pub most_share: f64,
}

impl Default for ToldDrives {
    /// Nothing: all of it is the model's.
    fn default() -> Self {
        ToldDrives {
            full_nm: None,
            dead_zone: None,
            delay_s: None,
            lag_s: 0.0,
            supply_v: None,
            most_share: 1.0,
        }
    }
}

/// What a plan for a model is made with.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanBasis {
    /// Servos, limits and compensation.
    pub board: Board,
    /// When readings are taken and torques act.
    pub timing: BoardTiming,
    /// Supply that the torques are for, V; none where neither the model nor anybody says one.
    pub supply_v: Option<f64>,
    /// What became of the drives' figures and of each effect of the model.
    pub uses: Vec<EffectUse>,
}

/// What a driven joint's effects make of a command.
#[derive(Debug, Clone, Copy, Default)]
struct DriveLoss {
    /// Lost of every command by the dead zone, a share of full output.
    swallowed: f64,
    /// Width of the dead zone, a share of full output.
    width: f64,
    /// Dry friction, N m.
    friction_nm: f64,
    delay_s: f64,
    sensor_lag_s: f64,
    /// Limit of the torque, in torque of the command.
    limit_nm: f64,
}

impl DriveLoss {
    fn of(model: &Model, joint: usize) -> DriveLoss {
        let mut loss = DriveLoss {
            limit_nm: f64::INFINITY,
            ..DriveLoss::default()
        };
        let mut scale = 1.0;
        for effect in model.effects_at(joint) {
            let values = &effect.values;
            match effect.effect.info().id {
                "dead_zone" => {
                    loss.width = loss.width.max(values[0]);
                    loss.swallowed += (-values[1]).max(0.0);
                }
                "coulomb" => loss.friction_nm += values[0],
                "delay" => loss.delay_s += values[0],
                "sensor_lag" => loss.sensor_lag_s += values[0],
                "torque_scale" => scale *= values[0],
                "torque_saturation" => loss.limit_nm = loss.limit_nm.min(values[0]),
                _ => {}
            }
        }
        // A limit is one of the torque that arrives; commands are in torque of the model's motor.
        loss.limit_nm /= scale;
        loss
    }
}

impl PlanBasis {
    /// The basis of a plan for this model on servos, sensors and safety limits of `board`, whose
    /// torques, dead zone and least commands the model replaces.
    ///
    /// # Errors
    /// Drives that lose more than the slew limit; a supply for a model that states no nominal one.
    pub fn of(
        model: &Model,
        board: &Board,
        timing: &BoardTiming,
        told: &ToldDrives,
    ) -> Result<PlanBasis> {
        model.planar_only("the CM-5 balances planar chains")?;
        let driven = model.driven_joints();
        let mut board = *board;
        let mut losses = [DriveLoss::default(); INPUTS];
        for (place, &joint) in driven.iter().take(INPUTS).enumerate() {
            losses[place] = DriveLoss::of(model, joint);
            compensate(&mut board, place, model, joint, &losses[place], told)?;
        }
        let mut timing = BoardTiming {
            lag_s: told.lag_s,
            ..*timing
        };
        // What is older than the inputs that the CM-5 keeps is left out.
        let kept_s = DELAYS as f64 * board.period_s - SPARE_S;
        let oldest_s = timing
            .age_s
            .iter()
            .fold(0.0, |most: f64, age| most.max(*age));
        let room_s = kept_s - timing.effect_s - oldest_s;
        let late_s = losses.map(|loss| told.delay_s.unwrap_or(loss.delay_s));
        timing.drive_delay_s = late_s.map(|late_s| late_s.clamp(0.0, room_s));
        let latest_s = timing.latest_effect_s();
        let mut aged_s = losses.map(|loss| loss.sensor_lag_s);
        let own_state = aged_s.map(|lag_s| timing.lag_s <= 0.0 && lag_s >= LEAST_LAG_S);
        for (place, aged_s) in aged_s.iter_mut().enumerate() {
            if own_state[place] {
                timing.sensor_lag_s[place] = *aged_s;
                continue;
            }
            let age_s = &mut timing.age_s[1 + place];
            *aged_s = aged_s.min(kept_s - latest_s - *age_s);
            *age_s += *aged_s;
        }
        let taken = uses::TakenLags {
            told,
            late_s,
            taken_s: timing.drive_delay_s,
            aged_s,
            own_state,
        };
        Ok(PlanBasis {
            uses: uses::of(model, &board, &taken)?,
            supply_v: told.supply_v.or_else(|| {
                let mut motors = driven
                    .iter()
                    .filter_map(|at| model.joints[*at].drive.motor());
                motors.find_map(|motor| motor.nominal_supply_v)
            }),
            board,
            timing,
        })
    }

    /// The plan with the observer-based law.
    ///
    /// # Errors
    /// A model that cannot be balanced.
    pub fn plan(&self, model: &Model) -> Result<Plan> {
        let machine = observer_design(model, &self.board, &self.timing)?;
        plan(model, BoardLaw::Observer(&machine), &self.board)
    }
}

/// Torque, jump and least command of a joint.
fn compensate(
    board: &mut Board,
    place: usize,
    model: &Model,
    joint: usize,
    loss: &DriveLoss,
    told: &ToldDrives,
) -> Result<()> {
    let motor = model.joints[joint].drive.motor();
    let mut stall_nm = motor.map_or(board.full_nm[place], |motor| motor.stall_torque_nm);
    if let Some(supply_v) = told.supply_v {
        let nominal_v = motor.and_then(|motor| motor.nominal_supply_v);
        let nominal_v = nominal_v.ok_or_else(|| {
            Error::usage(
                format!(
                    "`{}` does not say at which supply its torque holds",
                    model.name
                ),
                "give its drives nominal_supply_v, or leave the supply out",
            )
        })?;
        stall_nm *= supply_v / nominal_v;
    }
    // Dry friction costs a command as much as a dead zone does.
    let lost = loss.swallowed + loss.friction_nm / stall_nm;
    let lost = told.dead_zone.unwrap_or(lost);
    if board.slew_nm <= lost * stall_nm || lost >= 1.0 {
        return Err(Error::design(
            format!("a dead zone of {:.0} %", 100.0 * lost),
            "the slew limit must exceed it: record more, or look at the diagnosis",
        ));
    }
    board.dead_zone[place] = lost;
    // What is lost is lost of the whole command too: less than the stall torque is ever left.
    board.full_nm[place] = told.full_nm.unwrap_or(stall_nm * (1.0 - lost));
    let most_nm = told.most_share * board.full_nm[place];
    board.most_nm[place] = most_nm.min(loss.limit_nm);
    // Beyond what is jumped over, a dead zone's width still stops small commands.
    let stopped = match told.dead_zone {
        Some(_) => 0.0,
        None => (loss.width - lost).max(0.0),
    };
    board.least_nm[place] = MARGIN * stopped * stall_nm;
    Ok(())
}

#[cfg(test)]
mod tests;
