//! The robot in closed loop with the firmware: three links on a bar, two joints driven by servos in wheel mode.

use super::Bench;
use handstand::Model;
use handstand::dynamics::{Chain, Workspace};
use handstand::synth::{Format, Ranges, dlqr, linearise, quantise, upright, zoh};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT};
use handstand_shared::crc::crc32;
use handstand_shared::gains::GainTable;
use handstand_shared::message::{
    Attitude, Command, Condition, GAIN_CHUNK, Mode, Refusal, Report, VERSION,
};
use handstand_shared::plan::{Gyro, Joint, Plan};
use handstand_shared::raw::Position;
use handstand_shared::velocity::Velocity;
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::path::Path;

/// Torque of a joint at full output, N m: the paper's limit.
const FULL_NM: f64 = 2.0;
const PERIOD_S: f64 = 0.01;

/// The simulated rig around the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Weight of the states, a multiple of the unit matrix; the inputs' is 1.
    pub weight: f64,
    /// Share of full output below which a servo does not move.
    pub dead_zone: f64,
    /// How the firmware estimates joint velocities.
    pub velocity: Velocity,
    /// First link's angle from upright at the start, rad.
    pub start_rad: f64,
}

/// What became of the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Balanced {
    /// How long it stood, s.
    pub stood_s: f64,
    /// Root mean square of the first link's angle from upright after the first second, rad.
    pub rms_rad: f64,
    /// Root mean square of each joint's torque, N m.
    pub torque_rms_nm: [f64; 2],
    /// What the firmware said at the end.
    pub condition: Option<Condition>,
}

/// The plan for these conditions: DLQR of the paper's robot, in fixed point.
///
/// # Panics
/// The repository's own model cannot be read or designed for: a bug.
pub fn plan(conditions: &Conditions) -> Plan {
    let model = model();
    let continuous = linearise(&model, &upright(&model)).expect("the model can be linearised");
    let discrete = zoh(&continuous, PERIOD_S, 0.0).expect("and sampled");
    let q = DMatrix::identity(6, 6) * conditions.weight;
    let gains = dlqr(&discrete, &q, &DMatrix::identity(2, 2)).expect("and regulated");
    let velocity = conditions.velocity;
    let speed_step = Position::LSB_RAD / PERIOD_S / f64::from(1 << velocity.fraction);
    let (angle, position) = (Attitude::ANGLE_LSB_RAD, Position::LSB_RAD);
    let format = Format {
        state_step: Some(vec![
            angle,
            position,
            position,
            Attitude::RATE_LSB_RAD_S,
            speed_step,
            speed_step,
        ]),
        ..Format::default()
    };
    let ranges = Ranges {
        state: vec![1.0, 1.0, 1.0, 20.0, 20.0, 20.0],
        input: vec![FULL_NM; 2],
    };
    let law = quantise(&gains.k, &[0.0; 6], &[0.0; 2], &ranges, &format).expect("and rounded");
    let table = GainTable::from_bytes(&law.bytes()).expect("16 bits, two by six");
    let dead = (conditions.dead_zone * 1023.0).round() as u16;
    let joint = |id, input_step: f64| Joint {
        id,
        mirror: id + 1,
        reversed: false,
        centre: Position::CENTRE.0,
        dead,
        gain: (input_step / FULL_NM * f64::from(1023 - dead) * 65536.0).round() as u16,
        most: 1023,
    };
    Plan {
        table,
        joints: [joint(1, law.input_step[0]), joint(11, law.input_step[1])],
        velocity,
        gyro: Gyro {
            from_host: true,
            zero: 512,
            scale: 16,
        },
        range: 5000,
    }
}

fn model() -> Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/models/handstand.toml");
    Model::load(&file).expect("the repository's own model")
}

/// Uploads the plan and arms it, the first link upright and the servos at their centres.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn arm_balance(
    bench: &mut impl Bench,
    conditions: &Conditions,
) -> Result<Plan, Option<Refusal>> {
    for id in [1, 2, 11, 12] {
        let servo = bench.bus().servo(id).expect("18 servos");
        servo.set(CW_LIMIT, 0);
        servo.set(CCW_LIMIT, 0);
        servo.free = false;
    }
    bench.run_ms(10.0);
    let token = greet(bench)?;
    let plan = plan(conditions);
    upload(bench, &plan)?;
    command(bench, &Command::Mode(Mode::Balance))?;
    for _ in 0..25 {
        bench.say(&Command::Attitude(Attitude::default()));
        bench.run_ms(10.0);
    }
    command(bench, &Command::Arm { token })?;
    Ok(plan)
}

/// Arms and lets the robot go; the host says the first link's attitude every 10 ms.
///
/// # Errors
/// As [`arm_balance`].
pub fn balance(
    bench: &mut impl Bench,
    conditions: &Conditions,
    seconds: f64,
) -> Result<Balanced, Option<Refusal>> {
    arm_balance(bench, conditions)?;
    Ok(Robot::new(conditions).run(bench, seconds))
}

fn greet(bench: &mut impl Bench) -> Result<u16, Option<Refusal>> {
    bench.say(&Command::Hello { version: VERSION });
    wait(bench, |report| match report {
        Report::Hello(hello) => Some(Ok(hello.token)),
        _ => None,
    })
}

fn command(bench: &mut impl Bench, command: &Command) -> Result<(), Option<Refusal>> {
    bench.forget();
    let sequence = bench.say(command);
    wait(bench, |report| match report {
        Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome.map_err(Some)),
        _ => None,
    })
}

fn wait<T>(
    bench: &mut impl Bench,
    kind: impl Fn(Report) -> Option<Result<T, Option<Refusal>>>,
) -> Result<T, Option<Refusal>> {
    for _ in 0..600 {
        bench.run_ms(1.0);
        if let Some(found) = bench
            .reports()
            .into_iter()
            .find_map(|(_, report)| kind(report))
        {
            return found;
        }
    }
    Err(None)
}

/// Uploads a plan and has it kept.
fn upload(bench: &mut impl Bench, plan: &Plan) -> Result<(), Option<Refusal>> {
    let mut table = Vec::new();
    plan.bytes(|byte| table.push(byte));
    // As an adapter it takes our frames after a zero only; another mode needs none.
    command(bench, &Command::Mode(Mode::Stream))?;
    for (offset, piece) in (0..).step_by(GAIN_CHUNK).zip(table.chunks(GAIN_CHUNK)) {
        let mut bytes = [0; GAIN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        command(bench, &Command::GainChunk { offset, bytes })?;
    }
    let (length, check) = (table.len() as u16, crc32(&table));
    command(bench, &Command::GainStore { length, check })
}

/// Three links and the servos on them. Angles are relative, the first from hanging.
struct Robot {
    chain: Chain,
    work: Workspace,
    angle_rad: [f64; 3],
    speed_rad_s: [f64; 3],
    dead_zone: f64,
}

impl Robot {
    fn new(conditions: &Conditions) -> Self {
        Robot {
            chain: Chain::of(&model()),
            work: Workspace::new(3),
            angle_rad: [PI + conditions.start_rad, 0.0, 0.0],
            speed_rad_s: [0.0; 3],
            dead_zone: conditions.dead_zone,
        }
    }

    fn attitude(&self) -> Command {
        Command::Attitude(Attitude {
            angle: ((self.angle_rad[0] - PI) / Attitude::ANGLE_LSB_RAD).round() as i16,
            rate: (self.speed_rad_s[0] / Attitude::RATE_LSB_RAD_S).round() as i16,
        })
    }

    fn run(&mut self, bench: &mut impl Bench, seconds: f64) -> Balanced {
        let mut square = [0.0; 3];
        let (mut counted, mut stood_s) = (0, 0.0);
        for step in 0..(seconds * 1000.0) as usize {
            if step % 10 == 0 {
                bench.forget();
                bench.say(&self.attitude());
            }
            let torque_nm = self.torques(bench);
            self.advance(torque_nm, 1e-3);
            self.place(bench);
            bench.run_ms(1.0);
            if (self.angle_rad[0] - PI).abs() > 0.5 {
                break;
            }
            stood_s = (step + 1) as f64 * 1e-3;
            if step >= 1000 {
                counted += 1;
                let values = [self.angle_rad[0] - PI, torque_nm[0], torque_nm[1]];
                square
                    .iter_mut()
                    .zip(values)
                    .for_each(|(sum, value)| *sum += value * value);
            }
        }
        bench.run_ms(30.0);
        let rms = square.map(|sum: f64| (sum / f64::from(counted.max(1))).sqrt());
        let condition = bench
            .reports()
            .into_iter()
            .rev()
            .find_map(|(_, report)| match report {
                Report::Stream(report) => Some(report.condition),
                _ => None,
            });
        Balanced {
            stood_s,
            rms_rad: rms[0],
            torque_rms_nm: [rms[1], rms[2]],
            condition,
        }
    }

    /// The servos' torques: linear outside the dead zone.
    fn torques(&self, bench: &mut impl Bench) -> [f64; 2] {
        [1, 11].map(|id| {
            let servo = bench.bus().servo(id).expect("18 servos");
            let duty = servo.output().duty(0.0);
            let beyond = (duty.abs() - self.dead_zone).max(0.0) / (1.0 - self.dead_zone);
            FULL_NM * beyond.copysign(duty)
        })
    }

    /// Puts the servos' shafts where the joints are.
    fn place(&self, bench: &mut impl Bench) {
        for (joint, id) in [(1, 1), (2, 11)] {
            for (id, sign) in [(id, 1.0), (id + 1, -1.0)] {
                let servo = bench.bus().servo(id).expect("18 servos");
                servo.shaft.angle_rad = sign * self.angle_rad[joint];
                servo.shaft.speed_rad_s = sign * self.speed_rad_s[joint];
            }
        }
    }

    /// One step of classical Runge-Kutta.
    fn advance(&mut self, torque_nm: [f64; 2], dt_s: f64) {
        let (q, v) = (self.angle_rad, self.speed_rad_s);
        let at = |a: [f64; 3], b: [f64; 3], h: f64| std::array::from_fn(|i| a[i] + h * b[i]);
        let a1 = self.accelerate(&q, &v, torque_nm);
        let (q2, v2): ([f64; 3], [f64; 3]) = (at(q, v, dt_s / 2.0), at(v, a1, dt_s / 2.0));
        let a2 = self.accelerate(&q2, &v2, torque_nm);
        let (q3, v3): ([f64; 3], [f64; 3]) = (at(q, v2, dt_s / 2.0), at(v, a2, dt_s / 2.0));
        let a3 = self.accelerate(&q3, &v3, torque_nm);
        let (q4, v4): ([f64; 3], [f64; 3]) = (at(q, v3, dt_s), at(v, a3, dt_s));
        let a4 = self.accelerate(&q4, &v4, torque_nm);
        for i in 0..3 {
            self.angle_rad[i] += dt_s / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
            self.speed_rad_s[i] += dt_s / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
        }
    }

    fn accelerate(&mut self, q: &[f64; 3], v: &[f64; 3], torque_nm: [f64; 2]) -> [f64; 3] {
        let torque = [0.0, torque_nm[0], torque_nm[1]];
        let mut out = [0.0; 3];
        let base = self.chain.base_m_s2(0.0);
        self.chain
            .forward(&mut self.work, base, q, v, &torque, &[false; 3], &mut out);
        out
    }
}
