//! How old the readings are at the law's moment, and when its torques act: on the ELF, from the bus
//! itself.
//!
//! The driven joints' shafts turn as clocks, one position code every 20 us, so that an answer says
//! when it was measured. The law's moment is the end of the last answer; the host says the attitude
//! after every report, as in the closed loop.

use super::SimulatedCm5 as _;
use super::balance::{arm_balance, plan};
use super::run::HOST_MS;
use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::message::{Attitude, Command, Condition, Report};
use handstand_shared::plan::Plan;
use handstand_shared::raw::Position;
use handstand_simavr::ElfCm5;

/// A code of the shafts' clock, ms.
const CODE_MS: f64 = 0.02;
/// Codes until the clock begins again: two periods of the law.
const CODES: u64 = 1000;
/// Code with which it begins: 0 and 1023 are out of every plan's range.
const FIRST: u64 = 1;
const SHOULDER: u8 = 1;
const HIP: u8 = 11;

/// Least, median and largest, ms.
pub type Spread = [f64; 3];

/// What was measured, ms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ages {
    /// Ticks looked at.
    pub ticks: usize,
    /// From the shoulder's and the hip's measurements to the law.
    pub joints: [Spread; 2],
    /// From the moment the host says an attitude to the law that uses it.
    pub attitude: Spread,
    /// From the law until the servos have their commands.
    pub effect: Spread,
    /// From a tick's first request until its report has arrived.
    pub report: Spread,
}

/// One tick as the bus shows it, ms.
#[derive(Debug, Clone, Copy, Default)]
struct Round {
    began: f64,
    /// Position codes of shoulder and hip, and when their answers ended.
    joints: [(u16, f64); 2],
    law: f64,
    acted: f64,
}

/// Measures over so many seconds.
///
/// # Panics
/// The firmware does not arm, or lets the robot down.
pub fn ages(rig: &mut ElfCm5, seconds: f64) -> Ages {
    arm_balance(rig, &unlimited()).expect("it arms");
    rig.trace = Some(Vec::new());
    rig.clear();
    let begun_ms = rig.now_ms();
    let (mut said, mut heard) = (Vec::new(), Vec::new());
    let (mut due_ms, mut condition) = (begun_ms, Condition::Balance);
    while rig.now_ms() < begun_ms + seconds * 1e3 {
        turn(rig);
        rig.run_ms(CODE_MS);
        for (arrived_ms, report) in rig.reports() {
            if let Report::Stream(report) = report {
                condition = report.condition;
                let code = |place| report.positions.get(place);
                heard.push((arrived_ms, [code(0), code(usize::from(HIP) - 1)]));
                due_ms = arrived_ms + HOST_MS;
            }
        }
        rig.clear();
        if rig.now_ms() >= due_ms {
            due_ms = f64::INFINITY;
            rig.send(&Command::Attitude(Attitude::default()));
            said.push((rig.now_ms(), rig.arrival_ms()));
        }
    }
    assert_eq!(
        condition,
        Condition::BalanceArmed,
        "ages are those of a robot that balances"
    );
    let trace = rig.trace.take().unwrap_or_default();
    measured(&rounds(&trace), &said, &heard)
}

/// The plan of the closed loop, for joints that may be anywhere and turn as fast as a clock: else
/// the firmware would let the robot down at once.
fn unlimited() -> Plan {
    let mut plan = plan().1;
    for joint in &mut plan.joints {
        let centre = joint.centre as i16;
        (joint.lowest, joint.highest) = (1 - centre, 1022 - centre);
        joint.fastest = 1023;
    }
    plan
}

fn to_ms(cycle: u64) -> f64 {
    cycle as f64 / 16_000.0
}

/// The code that the clock shows.
fn code_at(ms: f64) -> u64 {
    FIRST + (ms / CODE_MS).round() as u64 % CODES
}

fn turn(rig: &mut ElfCm5) {
    let code = code_at(rig.now_ms()) as u16;
    for id in [SHOULDER, HIP] {
        let servo = rig.bus.servo(id).expect("18 servos");
        servo.shaft.angle_rad = Position(code).to_rad();
    }
}

/// When an answer that ended at `ended_ms` was measured.
fn measured_ms(code: u16, ended_ms: f64) -> f64 {
    let ago = (code_at(ended_ms) + CODES - u64::from(code)) % CODES;
    ended_ms - ago as f64 * CODE_MS
}

/// The ticks on the bus: from the first servo's READ to the commands.
fn rounds(trace: &[(u64, u8)]) -> Vec<Round> {
    let mut rounds = Vec::new();
    let mut round = None::<Round>;
    let mut at = 0;
    while at < trace.len() {
        let [
            (began, 0xff),
            (_, 0xff),
            (_, id),
            (_, length),
            (_, kind),
            rest @ ..,
        ] = &trace[at..]
        else {
            // It begins within a packet.
            at += 1;
            continue;
        };
        let whole = usize::from(*length) + 4;
        let Some((ended, _)) = trace.get(at + whole - 1) else {
            break;
        };
        let (began, ended) = (to_ms(*began), to_ms(*ended));
        match (kind, rest) {
            (2, _) if round.is_none_or(|round| began > round.began + 8.0) => {
                round = Some(Round {
                    began,
                    ..Round::default()
                });
            }
            (2, _) => {}
            (0x83, [(_, address), ..]) if *address == MOVING_SPEED.address => {
                rounds.extend(round.take().map(|round| Round {
                    acted: ended,
                    ..round
                }));
            }
            (0, [(_, low), (_, high), ..]) => {
                if let Some(round) = &mut round {
                    round.law = ended;
                    let place = [SHOULDER, HIP].iter().position(|known| known == id);
                    if let Some(place) = place {
                        round.joints[place] = (u16::from_le_bytes([*low, *high]), ended);
                    }
                }
            }
            _ => {}
        }
        at += whole;
    }
    rounds
}

fn measured(rounds: &[Round], said: &[(f64, f64)], heard: &[(f64, [u16; 2])]) -> Ages {
    // The attitude that had arrived when the tick began.
    let said_before = |began: f64| said.iter().rev().find(|(_, arrived)| *arrived <= began);
    let joint = |place: usize| {
        let ages = rounds.iter().map(|round| {
            let (code, ended) = round.joints[place];
            round.law - measured_ms(code, ended)
        });
        spread(ages.collect())
    };
    let attitudes = rounds.iter().filter_map(|round| {
        let (said, _) = said_before(round.began)?;
        Some(round.law - said)
    });
    // Both shafts' codes tell the report of a tick.
    let reported = |round: &Round| {
        let codes = round.joints.map(|(code, _)| code);
        let (arrived, _) = heard.iter().find(|(arrived, reported)| {
            *reported == codes && (round.acted..round.acted + 20.0).contains(arrived)
        })?;
        Some(arrived - round.began)
    };
    let reports = rounds.iter().filter_map(reported);
    Ages {
        ticks: rounds.len(),
        joints: [joint(0), joint(1)],
        attitude: spread(attitudes.collect()),
        effect: spread(rounds.iter().map(|round| round.acted - round.law).collect()),
        report: spread(reports.collect()),
    }
}

fn spread(mut values: Vec<f64>) -> Spread {
    values.sort_by(f64::total_cmp);
    let at = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
    let last = values.len().saturating_sub(1);
    [at(0), at(last / 2), at(last)]
}
