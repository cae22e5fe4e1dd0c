//! The laws side by side: in floating point and in fixed point on the host, in a loop timed like
//! the CM-5's; and the CM-5's own, told tick by tick what it saw.

use super::SimulatedCm5;
use super::balance::{Balanced, Conditions, Source, Tick, balance};
use super::robot::{FULL_NM, GYRO_STEP_RAD_S, Robot, STEP_MS};
use handstand::deploy::{reading_steps, state_steps};
use handstand::synth::controllers::{BoardTiming, OnBoard};
use handstand_shared::message::{Attitude, Refusal};
use handstand_shared::observer::{FINE, Memory, WIDTH};
use handstand_shared::plan::{AppliedInput, Law, Plan};
use handstand_shared::raw::{Position, Signed};

/// A law of the host, between readings in steps and commands in codes.
pub trait HostLaw {
    /// Commands at these readings; goes on by a tick.
    fn commands(&mut self, readings: [i16; 4]) -> [i16; 2];
}

/// The plan's law with the firmware's own fixed-point code.
#[derive(Clone, PartialEq)]
pub struct Fixed<'a> {
    plan: &'a Plan,
    memory: Option<Memory>,
    applied: [AppliedInput; 2],
}

/// The machine as it was designed, with the plan's servos.
pub struct Float<'a> {
    plan: &'a Plan,
    machine: &'a OnBoard,
    memory: Option<[f64; WIDTH]>,
}

impl<'a> Fixed<'a> {
    /// Before its first readings.
    pub fn new(plan: &'a Plan) -> Self {
        Fixed {
            plan,
            memory: None,
            applied: [AppliedInput::NOTHING; 2],
        }
    }
}

impl<'a> Float<'a> {
    /// Before its first readings.
    pub fn new(plan: &'a Plan, machine: &'a OnBoard) -> Self {
        Float {
            plan,
            machine,
            memory: None,
        }
    }
}

impl HostLaw for Fixed<'_> {
    fn commands(&mut self, [angle, q2, q3, rate]: [i16; 4]) -> [i16; 2] {
        let Law::Observer(observer) = &self.plan.law else {
            panic!("the plan has an observer")
        };
        let readings = [angle, q2 << FINE, q3 << FINE, rate];
        let memory = self.memory.get_or_insert_with(|| {
            let mut memory = Memory::ZERO;
            observer.start(&mut memory, &readings, [0; 3]);
            memory
        });
        let raw_command = observer.raw_command(memory, &readings);
        let joints = &self.plan.joints;
        let applied = [0, 1].map(|i| joints[i].apply(&mut self.applied[i], raw_command[i]));
        observer.update(memory, applied);
        [0, 1].map(|i| joints[i].command(applied[i]))
    }
}

impl HostLaw for Float<'_> {
    fn commands(&mut self, [angle, q2, q3, rate]: [i16; 4]) -> [i16; 2] {
        let step = state_steps();
        let readings = [angle, q2 << FINE, q3 << FINE, rate];
        let reading_step = reading_steps();
        let readings: [f64; 4] = std::array::from_fn(|i| f64::from(readings[i]) * reading_step[i]);
        let memory = self.memory.get_or_insert_with(|| {
            let mut memory = [0.0; WIDTH];
            memory[..3].copy_from_slice(&readings[..3]);
            memory
        });
        let raw_command = self.machine.raw_command(memory, &readings);
        let applied = raw_command.map(|torque| torque.clamp(-FULL_NM, FULL_NM));
        self.machine.update(memory, applied);
        [0, 1].map(|i| self.plan.joints[i].command((applied[i] / step[WIDTH - 1]).round() as i16))
    }
}

/// How many ticks of the firmware differ from the fixed law on the same readings, and how many were
/// compared.
///
/// The firmware's memory is not told, so that the fixed law follows from the first tick on: one
/// difference would show in all later ones. Where a tick may have seen either of two attitudes,
/// both are followed as long as they agree with it.
pub fn different(plan: &Plan, ticks: &[Tick]) -> (usize, usize) {
    let mut possible = vec![Fixed::new(plan)];
    let mut different = 0;
    for tick in ticks {
        let all = after(tick, &possible);
        let mut agreeing: Vec<Fixed> = Vec::new();
        for (law, commands) in &all {
            if *commands == tick.commands && !agreeing.contains(law) {
                agreeing.push(law.clone());
            }
        }
        if agreeing.is_empty() {
            different += 1;
            agreeing.extend(all.into_iter().map(|(law, _)| law).take(1));
        }
        possible = agreeing;
    }
    (different, ticks.len())
}

/// The laws after a tick, each with its commands, for all that the tick may have seen.
fn after<'a>(tick: &Tick, laws: &[Fixed<'a>]) -> Vec<(Fixed<'a>, [i16; 2])> {
    let seen = std::iter::once(tick.readings).chain(tick.or);
    let gone_on = |readings: [i16; 4]| {
        laws.iter().map(move |law| {
            let mut law = law.clone();
            let commands = law.commands(readings);
            (law, commands)
        })
    };
    seen.flat_map(gone_on).collect()
}

/// The first link's angle and rate as the law gets them, in steps of [`Attitude`].
struct Sensor {
    source: Source,
    /// The sum of the gyro's rates, rad.
    turned_rad: f64,
}

impl Sensor {
    fn read(&mut self, angle_rad: f64, rate_rad_s: f64, period_s: f64) -> [i16; 2] {
        let (angle_rad, rate_rad_s) = match self.source {
            Source::Host => (angle_rad, rate_rad_s),
            Source::Gyro => {
                let rate_rad_s = (rate_rad_s / GYRO_STEP_RAD_S).round() * GYRO_STEP_RAD_S;
                self.turned_rad += rate_rad_s * period_s;
                (self.turned_rad, rate_rad_s)
            }
        };
        let steps = |value: f64, step: f64| (value / step).round() as i16;
        [
            steps(angle_rad, Attitude::ANGLE_LSB_RAD),
            steps(rate_rad_s, Attitude::RATE_LSB_RAD_S),
        ]
    }
}

/// Lets the robot go under a host's law, its readings and torques as late as the CM-5's.
pub fn balance_by_host(
    law: &mut dyn HostLaw,
    conditions: &Conditions,
    timing: &BoardTiming,
    source: Source,
    seconds: f64,
) -> Balanced {
    let mut sensor = Sensor {
        source,
        turned_rad: 0.0,
    };
    let mut robot = Robot::new(conditions);
    let in_steps = |time_s: f64| (time_s * 1e3 / STEP_MS).round() as usize;
    let period = in_steps(0.01);
    let mut past = vec![robot.readings()];
    let mut torque_nm = [0.0; 2];
    let mut next_nm = [0.0; 2];
    let mut square = [0.0; 3];
    let (mut counted, mut stood_s) = (0, 0.0);
    for step in 1..=in_steps(seconds) {
        let at = (step - 1) % period;
        if at == 0 {
            let ago = |place: usize| {
                past[past.len() - 1 - in_steps(timing.age_s[place]).min(past.len() - 1)][place]
            };
            let code = |rad: f64| {
                (i32::from(Position::from_rad(rad).0) - i32::from(Position::CENTRE.0)) as i16
            };
            let [angle, rate] = sensor.read(ago(0), ago(3), 0.01);
            let readings = [angle, code(ago(1)), code(ago(2)), rate];
            let commands = law.commands(readings);
            next_nm = commands.map(|code| robot.torque(f64::from(code) * Signed::OUTPUT_LSB));
        }
        if at == in_steps(timing.effect_s) {
            torque_nm = next_nm;
        }
        robot.advance(torque_nm);
        past.push(robot.readings());
        if robot.has_fallen() {
            break;
        }
        stood_s = step as f64 * STEP_MS * 1e-3;
        if stood_s > 1.0 {
            counted += 1;
            let values = [robot.lean_rad(), torque_nm[0], torque_nm[1]];
            (square.iter_mut().zip(values)).for_each(|(sum, value)| *sum += value * value);
        }
    }
    let rms = square.map(|sum: f64| (sum / f64::from(counted.max(1))).sqrt());
    Balanced {
        stood_s,
        rms_rad: rms[0],
        torque_rms_nm: [rms[1], rms[2]],
        condition: None,
        telemetry: None,
        ticks: Vec::new(),
    }
}

/// The same start under three laws.
#[derive(Debug, Clone, PartialEq)]
pub struct Sides {
    /// Floating point on the host.
    pub float: Balanced,
    /// Fixed point on the host.
    pub fixed: Balanced,
    /// The firmware's, or what it refused.
    pub board: Result<Balanced, Option<Refusal>>,
    /// Ticks in which the firmware differs from the fixed law on the same readings, and ticks
    /// compared; none with a gyro, whose readings no report tells.
    pub different: (usize, usize),
}

/// Lets the robot go from the same start under all three laws.
pub fn side_by_side(
    bench: &mut impl SimulatedCm5,
    conditions: &Conditions,
    source: Source,
    seconds: f64,
) -> Sides {
    let (machine, plan) = source.plan();
    let timing = source.timing();
    let board = balance(bench, &plan, conditions, seconds);
    let ticks = match (&board, source) {
        (Ok(board), Source::Host) => &board.ticks[..],
        _ => &[],
    };
    let mut float = Float::new(&plan, &machine);
    let mut fixed = Fixed::new(&plan);
    Sides {
        different: different(&plan, ticks),
        float: balance_by_host(&mut float, conditions, &timing, source, seconds),
        fixed: balance_by_host(&mut fixed, conditions, &timing, source, seconds),
        board,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::servos::corners;

    /// From the corners of two degrees with the attitude from the host; from those of one by a gyro
    /// of 10 deg/s per code alone.
    #[test]
    fn both_laws_of_the_host_stand() {
        for (source, degrees, most_rad) in [(Source::Host, 2.0f64, 0.03), (Source::Gyro, 1.0, 0.2)]
        {
            let ((machine, plan), timing) = (source.plan(), source.timing());
            for start_rad in corners(degrees.to_radians()) {
                let conditions = Conditions {
                    dead_zone: 0.08,
                    eccentric_m: [0.0; 3],
                    start_rad,
                };
                let laws: [&mut dyn HostLaw; 2] =
                    [&mut Float::new(&plan, &machine), &mut Fixed::new(&plan)];
                let runs = laws.map(|law| balance_by_host(law, &conditions, &timing, source, 60.0));
                for run in &runs {
                    let stands = run.stood_s >= 60.0 && run.rms_rad < most_rad;
                    assert!(stands, "{source:?} {start_rad:?}: {run:?}");
                }
                // By a gyro of so coarse a step each sways in its own way.
                let [float, fixed] = runs.map(|run| run.rms_rad);
                let is_near = source == Source::Gyro || (float - fixed).abs() < 0.01;
                assert!(is_near, "{start_rad:?}: {float} and {fixed} rad");
            }
        }
    }
}
