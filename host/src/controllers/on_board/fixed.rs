//! The machine in fixed point, and the plan around it.
//!
//! Steps are such that rounding lies far below what the sensors round: estimated angles in 1/128 of a position code or half a
//! step of attitude, speeds in 5e-4 rad/s, angles of balance four times as fine as angles, torques in 2^-13 N m.

use super::{OnBoard, Timing};
use crate::controllers::DesignModel;
use crate::dynamics::EquationsOfMotion;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::synth::{Format, Ranges, quantise, upright};
use handstand_shared::gains::GainTable;
use handstand_shared::message::Attitude;
use handstand_shared::observer::{
    ESTIMATED, FINE, INPUTS, JOINTS, Observer, READINGS, SEEN, STATE, WIDTH,
};
use handstand_shared::plan::{Gyro, Joint, Law, Moment, Plan};
use handstand_shared::raw::Position;
use handstand_shared::velocity::Velocity;
use nalgebra::DMatrix;

/// Torques' step, N m.
const INPUT_STEP_NM: f64 = 1.0 / 8192.0;
/// See [`Observer`].
const READING_PLACES: [u8; READINGS] = [1, 2, 2, 1];
const BALANCE_PLACES: [u8; JOINTS] = [3, 4, 4];
/// Largest estimate or reading in steps: a little below 16 bits, that rounding a range does not exceed them.
const WORD: f64 = 32_766.0;

/// A driven joint's servos.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Servo {
    /// The servo that measures and drives.
    pub id: u8,
    /// The servo that drives along, mirrored; 255 if there is none.
    pub mirror: u8,
    /// Whether the joint's angle falls when the servo turns counter-clockwise.
    pub reversed: bool,
    /// Position code at the joint's zero.
    pub centre: u16,
}

/// What is known of a robot and its servos beside the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitting {
    /// Period of the law, s.
    pub period_s: f64,
    /// Shoulder and hip.
    pub servos: [Servo; INPUTS],
    /// Torque of a joint at full output, N m.
    pub full_nm: f64,
    /// Largest torque asked for, N m.
    pub most_nm: f64,
    /// Share of full output below which a servo does not move.
    pub dead_zone: f64,
    /// Whether torque begins at nothing behind the dead zone; else a command that passes passes whole.
    pub begins_at_nothing: bool,
    /// Largest change of a torque in a period, N m.
    pub slew_nm: f64,
    /// Where the first link's attitude comes from.
    pub gyro: Gyro,
    /// Departure of the first link at which the robot has fallen, rad.
    pub range_rad: f64,
}

impl Fitting {
    /// The Bioloid humanoid: shoulders 1 and 2, hips 11 and 12, 2 N m, 8 % dead zone, attitude from the host.
    pub const BIOLOID: Fitting = Fitting {
        period_s: 0.01,
        servos: [
            Servo {
                id: 1,
                mirror: 2,
                reversed: false,
                centre: Position::CENTRE.0,
            },
            Servo {
                id: 11,
                mirror: 12,
                reversed: false,
                centre: Position::CENTRE.0,
            },
        ],
        full_nm: 2.0,
        most_nm: 2.0,
        dead_zone: 0.08,
        begins_at_nothing: true,
        slew_nm: 1.0,
        gyro: Gyro {
            from_host: true,
            zero: 512,
            scale: 16,
        },
        range_rad: 0.8,
    };
}

/// The machine for a robot, and the plan that makes the CM-5 run it.
///
/// # Errors
/// As [`OnBoard::new`]; limits that do not fit the words.
pub fn plan(model: &Model, fitting: &Fitting, timing: &Timing) -> Result<(OnBoard, Plan)> {
    let known = DesignModel {
        limit_nm: fitting.most_nm,
        ..DesignModel::new(model, &upright(model), fitting.period_s)?
    };
    let machine = OnBoard::new(&known, timing)?;
    let law = Law::Observer(observer(&machine, fitting.most_nm)?);
    let plan = fitting.plan(law, moments(model), [INPUT_STEP_NM; INPUTS])?;
    Ok((machine, plan))
}

/// The plan that makes the CM-5 run a regulator on plain states, its speeds differences of positions as `velocity` takes them.
///
/// Where the table's operating point is upright, the CM-5 moves it to where the masses balance.
///
/// # Errors
/// Limits that do not fit the words.
pub fn regulator_plan(
    model: &Model,
    fitting: &Fitting,
    table: GainTable<INPUTS, { 2 * JOINTS }>,
    velocity: Velocity,
    input_step_nm: [f64; INPUTS],
) -> Result<Plan> {
    let moments = match table.x0 == [0; 2 * JOINTS] {
        true => moments(model),
        false => [Moment::ZERO; JOINTS],
    };
    fitting.plan(Law::State { table, velocity }, moments, input_step_nm)
}

/// What an observer's words stand for.
pub fn si() -> [f64; WIDTH] {
    let mut step = [INPUT_STEP_NM; WIDTH];
    let reading = reading_steps();
    let finer = |reading: f64, places: u8| reading / f64::from(1 << places);
    let surprise: [f64; READINGS] = std::array::from_fn(|i| finer(reading[i], READING_PLACES[i]));
    for joint in 0..JOINTS {
        step[joint] = surprise[joint];
        step[JOINTS + joint] = surprise[JOINTS];
        step[2 * JOINTS + joint] = finer(reading[joint], BALANCE_PLACES[joint]);
    }
    step[STATE..SEEN].copy_from_slice(&surprise);
    step
}

/// SI values of one step of each reading.
pub fn reading_steps() -> [f64; READINGS] {
    let joint = Position::LSB_RAD / f64::from(1 << FINE);
    [
        Attitude::ANGLE_LSB_RAD,
        joint,
        joint,
        Attitude::RATE_LSB_RAD_S,
    ]
}

fn observer(machine: &OnBoard, limit_nm: f64) -> Result<Observer> {
    let step = si();
    let feedback = rounded(
        &machine.feedback,
        &step[..SEEN],
        &[INPUT_STEP_NM; INPUTS],
        limit_nm / INPUT_STEP_NM,
    )?;
    let update = rounded(&machine.update, &step, &step[..ESTIMATED], WORD)?;
    let expect = rounded(&machine.expect, &step[..STATE], &step[STATE..SEEN], WORD)?;
    Ok(Observer {
        expect: table(&expect)?,
        feedback: table(&feedback)?,
        update: table(&update)?,
        reading_places: READING_PLACES,
        balance_places: BALANCE_PLACES,
    })
}

/// Rows of `matrix` in fixed point; outputs saturate at `most` steps.
fn rounded(
    matrix: &DMatrix<f64>,
    from_step: &[f64],
    to_step: &[f64],
    most: f64,
) -> Result<Vec<u8>> {
    let ranges = Ranges {
        state: from_step.iter().map(|step| step * WORD).collect(),
        input: to_step.iter().map(|step| step * most).collect(),
    };
    let format = Format {
        state_step: Some(from_step.to_vec()),
        input_step: Some(to_step.to_vec()),
        ..Format::default()
    };
    let (x0, u0) = (vec![0.0; from_step.len()], vec![0.0; to_step.len()]);
    // The law subtracts its gains.
    Ok(quantise(&-matrix, &x0, &u0, &ranges, &format)?.bytes())
}

fn table<const M: usize, const N: usize>(bytes: &[u8]) -> Result<GainTable<M, N>> {
    GainTable::from_bytes(bytes)
        .filter(GainTable::is_safe)
        .ok_or_else(|| Error::design("the machine overflows its words", "take a coarser step"))
}

impl Fitting {
    fn plan(
        &self,
        law: Law,
        moments: [Moment; JOINTS],
        input_step_nm: [f64; INPUTS],
    ) -> Result<Plan> {
        let [shoulder, hip] = input_step_nm;
        let plan = Plan {
            law,
            joints: [self.joint(0, shoulder)?, self.joint(1, hip)?],
            gyro: self.gyro,
            moments,
            range: (self.range_rad / Attitude::ANGLE_LSB_RAD).round() as u16,
        };
        // What the firmware would refuse must not leave here.
        let mut bytes = Vec::new();
        plan.bytes(|byte| bytes.push(byte));
        match Plan::from_bytes(&bytes) {
            Some(back) if back == plan => Ok(plan),
            _ => Err(Error::design(
                "the firmware would refuse this plan",
                "check the servos' ids, centres and dead zone; the slew limit must exceed the dead zone",
            )),
        }
    }

    fn joint(&self, place: usize, input_step_nm: f64) -> Result<Joint> {
        let servo = self.servos[place];
        let steps = |torque_nm: f64| (torque_nm / input_step_nm).round().min(WORD) as i16;
        let codes = (self.dead_zone * 1023.0).round() as u16;
        // Behind the dead zone the rest of the range makes the whole torque, or torque is proportional to the command.
        let (dead, least, span) = match self.begins_at_nothing {
            true => (codes, 0, 1023 - codes),
            false => (0, steps(SURELY * self.dead_zone * self.full_nm), 1023),
        };
        let gain = (input_step_nm / self.full_nm * f64::from(span) * 65_536.0).round();
        if !(1.0..=65_535.0).contains(&gain) {
            return Err(Error::design(
                format!(
                    "a torque step of {input_step_nm} N m and a full torque of {} N m make {gain} / 65536 codes a step",
                    self.full_nm
                ),
                "that has to be 1 to 65535: give another step or another full torque",
            ));
        }
        Ok(Joint {
            id: servo.id,
            mirror: servo.mirror,
            reversed: servo.reversed,
            centre: servo.centre,
            dead,
            gain: gain as u16,
            least,
            most: steps(self.most_nm),
            slew: steps(self.slew_nm),
        })
    }
}

/// Commands this much beyond the nominal zone pass every robot's own zone, which may differ by a fifth.
const SURELY: f64 = 1.21;

/// Each link's moment with all that hangs on its end, in 1/16384 of the largest.
fn moments(model: &Model) -> [Moment; JOINTS] {
    let rig = model.rig(false);
    let equations = EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad);
    let moments = equations.moments_kg_m();
    let most = moments
        .iter()
        .flatten()
        .fold(0.0, |most: f64, part| most.max(part.abs()));
    let scaled = |part: f64| (part / most * 16_384.0).round() as i16;
    let mut links = [Moment::ZERO; JOINTS];
    for (link, [along, aside]) in links.iter_mut().zip(moments) {
        (link.along, link.aside) = (scaled(along), scaled(aside));
    }
    links
}
