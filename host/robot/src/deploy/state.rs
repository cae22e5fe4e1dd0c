//! State feedback on the board: a regulator on positions and their differences.

use super::board::{Board, moments};
use crate::error::{Error, Result};
use crate::model::{Angles, Model};
use crate::synth::{Design, FixedLaw, Request, upright};
use handstand_shared::gains::GainTable;
use handstand_shared::message::Attitude;
use handstand_shared::observer::{INPUTS, JOINTS};
use handstand_shared::plan::{Law, Moment, Plan};
use handstand_shared::raw::Position;
use handstand_shared::velocity::Velocity;

/// States of the law: angles and speeds.
const STATES: usize = 2 * JOINTS;

/// Speeds as the firmware estimates them: differences of positions, smoothed over two ticks.
pub(super) const VELOCITY: Velocity = Velocity {
    fraction: 4,
    share: 128,
};

/// Design as `request` asks, in the firmware's steps and with the operating point relative to
/// upright.
///
/// Input steps that are too coarse for a plan are made finer.
///
/// # Errors
/// As [`Design::of`]; state steps in `request`, which the firmware sets; continuous time; absolute
/// angles.
pub fn state_design(model: &Model, mut request: Request, board: &Board) -> Result<Design> {
    if request.format.state_step.is_some() {
        return Err(Error::usage(
            "--state-step has no place here: the firmware measures in steps of its own",
            "leave it out",
        ));
    }
    request.format.state_step = Some(measured_steps(board.period_s));
    relative(model)?;
    let mut design = Design::of(model, &request)?;
    if let Some(step_nm) = finer_step_nm(&design, board) {
        request.format.input_step = Some(vec![step_nm; design.inputs.len()]);
        design = Design::of(model, &request)?;
    }
    shift_to_upright(&mut design, model);
    Ok(design)
}

/// The plan of a design of [`state_design`].
pub(super) fn plan(model: &Model, design: &Design, board: &Board) -> Result<Plan> {
    let fixed = design.fixed.as_ref().ok_or_else(|| {
        Error::usage(
            "gains for continuous time have no table",
            "leave --continuous out",
        )
    })?;
    let ts_s = design.sampled.as_ref().map_or(0.0, |(plant, _)| plant.ts_s);
    if (ts_s - board.period_s).abs() > 1e-9 {
        return Err(Error::design(
            format!(
                "the firmware ticks every {} s, the gains are for {ts_s} s",
                board.period_s
            ),
            "leave --ts out",
        ));
    }
    let table = table(&fixed.law)?;
    // Where the operating point is upright, the CM-5 moves it to the equilibrium of the masses.
    let moments = if table.x0 == [0; STATES] {
        moments(model)
    } else {
        [Moment::ZERO; JOINTS]
    };
    let steps = [fixed.law.input_step[0], fixed.law.input_step[1]];
    let velocity = VELOCITY;
    board.plan(Law::State { table, velocity }, moments, steps)
}

/// SI value of one step of each state, as the firmware measures them.
fn measured_steps(period_s: f64) -> Vec<f64> {
    let (angle, position) = (Attitude::ANGLE_LSB_RAD, Position::LSB_RAD);
    let speed = position / period_s / f64::from(1 << VELOCITY.fraction);
    let rate = Attitude::RATE_LSB_RAD_S;
    vec![angle, position, position, rate, speed, speed]
}

/// A step of the inputs that a plan can convert to commands, N m, if those of this design are too
/// coarse.
fn finer_step_nm(design: &Design, board: &Board) -> Option<f64> {
    let law = &design.fixed.as_ref()?.law;
    // A plan holds commands per step in 16 bits behind the point.
    let drives = board.full_nm.iter().zip(board.dead_zone);
    let most_nm = drives.map(|(full_nm, dead_zone)| {
        let codes = 1023.0 - (dead_zone * 1023.0).round();
        full_nm / codes * 65_535.0 / 65_536.0
    });
    let most_nm = most_nm.fold(f64::INFINITY, f64::min);
    let is_coarse = law.input_step.iter().any(|step| *step > most_nm);
    is_coarse.then(|| 2f64.powi(most_nm.log2().floor() as i32))
}

/// Express the operating point relative to upright, as the firmware measures angles.
fn shift_to_upright(design: &mut Design, model: &Model) {
    let up = upright(model);
    design.x0.iter_mut().zip(&up).for_each(|(x0, up)| *x0 -= up);
    if let Some(fixed) = &mut design.fixed {
        let law = &mut fixed.law;
        for ((x0, up), step) in law.x0.iter_mut().zip(&up).zip(&law.state_step) {
            *x0 -= (up / step).round() as i64;
        }
    }
}

/// Refuse absolute angles, for servos measure relative ones, joints that slide, and robots in
/// space.
pub(super) fn relative(model: &Model) -> Result<()> {
    model.hinges_only("the board's plans are for servos that turn")?;
    model.planar_only("the CM-5 balances planar chains")?;
    match model.angles {
        Angles::Relative => Ok(()),
        Angles::Absolute => Err(Error::design(
            format!(
                "`{}` has absolute angles, servos measure relative ones",
                model.name
            ),
            "give a model with `angles = \"relative\"`",
        )),
    }
}

fn table(law: &FixedLaw) -> Result<GainTable<INPUTS, STATES>> {
    GainTable::from_bytes(&law.bytes()).ok_or_else(|| {
        Error::design(
            format!(
                "the firmware's law has {INPUTS} inputs and {STATES} states; this one has {} \
                 and {}",
                law.k.nrows(),
                law.k.ncols()
            ),
            "give a model of three joints, two of them driven, without delay (--delay 0)",
        )
    })
}
