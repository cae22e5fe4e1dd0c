//! A CM-5 in process, and what a PC says to it.

use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, STATUS_LEVEL};
use handstand_shared::crc::crc32;
use handstand_shared::gains::GainTable;
use handstand_shared::message::*;
use handstand_shared::plan::{Gyro, Joint, Law, Moment, Plan};
use handstand_shared::velocity::Velocity;

/// Servos that a plan drives: shoulder, its mirror, hip, its mirror.
pub const DRIVEN: [u8; 4] = [1, 2, 11, 12];

/// A plan on plain states, with the attitude from the host.
pub fn plan() -> Plan {
    let joint = Joint {
        id: 1,
        mirror: 2,
        reversed: false,
        centre: 512,
        dead: 80,
        gain: 1 << 15,
        least: 0,
        most: 1840,
        slew: 1840,
        lowest: -200,
        highest: 180,
        fastest: 12,
    };
    let table = GainTable::new(
        [
            [-500, -2000, -700, -850, -400, -150],
            [-400, -1700, -560, -700, -330, -120],
        ],
        [1 << 7; 2],
        [8; 2],
        [[-8000, 8000]; 2],
        [0; 6],
    );
    let velocity = Velocity {
        fraction: 4,
        share: 128,
    };
    let hip = Joint {
        id: 11,
        mirror: 12,
        ..joint
    };
    Plan {
        law: Law::State { table, velocity },
        joints: [joint, hip],
        gyro: Gyro {
            from_host: true,
            zero: 510,
            scale: 279,
        },
        moments: [Moment::ZERO; 3],
        range: 8000,
    }
}

/// A plan that balances with the gyro; 1 degree/s per code.
pub fn gyro_plan() -> Plan {
    Plan {
        gyro: Gyro {
            from_host: false,
            zero: 512,
            scale: 279,
        },
        ..plan()
    }
}

/// The plan's bytes.
pub fn bytes(plan: &Plan) -> Vec<u8> {
    let mut bytes = Vec::new();
    plan.bytes(|byte| bytes.push(byte));
    bytes
}

/// A CM-5 with 18 servos, those that a plan drives turning without end, after its start.
pub fn with_wheels() -> VirtualCm5 {
    let mut cm5 = VirtualCm5::new();
    for id in DRIVEN {
        let servo = cm5.bus().servo(id).unwrap();
        servo.set(CW_LIMIT, 0);
        servo.set(CCW_LIMIT, 0);
        servo.free = false;
    }
    cm5.run_ms(250.0);
    cm5
}

/// Sends it, and gives what it is answered: none in 600 ms is none.
pub fn ask(cm5: &mut VirtualCm5, command: &Command) -> Option<Result<(), Refusal>> {
    cm5.clear();
    let sequence = cm5.send(command);
    for _ in 0..600 {
        cm5.run_ms(1.0);
        let answer = cm5
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            });
        if answer.is_some() {
            return answer;
        }
    }
    None
}

/// Greets it.
pub fn greet(cm5: &mut VirtualCm5) -> Hello {
    cm5.clear();
    cm5.send(&Command::Hello { version: VERSION });
    cm5.run_ms(20.0);
    let mut reports = cm5.reports().into_iter();
    let hello = reports.find_map(|(_, report)| match report {
        Report::Hello(hello) => Some(hello),
        _ => None,
    });
    hello.expect("an answer")
}

/// Says it every 10 ms.
pub fn say(cm5: &mut VirtualCm5, command: &Command, ms: u32) {
    for _ in 0..ms / 10 {
        cm5.send(command);
        cm5.run_ms(10.0);
    }
}

/// Torque on.
pub fn arm_with(token: u16) -> Command {
    Command::Arm {
        token,
        limits: ArmLimits::FULL,
    }
}

/// Greets, streams, and arms; the token.
pub fn arm(cm5: &mut VirtualCm5) -> u16 {
    let token = greet(cm5).token;
    assert_eq!(ask(cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(cm5, &Command::KeepAlive, 250);
    assert_eq!(ask(cm5, &arm_with(token)), Some(Ok(())));
    token
}

/// Uploads a plan and has it kept.
pub fn upload(cm5: &mut VirtualCm5, plan: &Plan) {
    assert_eq!(ask(cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    let table = bytes(plan);
    for (offset, piece) in (0..).step_by(PLAN_CHUNK).zip(table.chunks(PLAN_CHUNK)) {
        let mut bytes = [0; PLAN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        assert_eq!(
            ask(cm5, &Command::PlanChunk { offset, bytes }),
            Some(Ok(()))
        );
    }
    let (length, check) = (table.len() as u16, crc32(&table));
    assert_eq!(
        ask(cm5, &Command::PlanStore { length, check }),
        Some(Ok(()))
    );
}

/// Everything before arming: the plan uploaded, balance mode, the law's moment near; the token.
pub fn ready_to_balance(cm5: &mut VirtualCm5, plan: &Plan) -> u16 {
    let token = greet(cm5).token;
    upload(cm5, plan);
    assert_eq!(ask(cm5, &Command::Mode(Mode::Balance)), Some(Ok(())));
    say(cm5, &UPRIGHT, 300);
    token
}

/// The first link stands upright.
pub const UPRIGHT: Command = Command::Attitude(Attitude { angle: 0, rate: 0 });

/// The first link has fallen.
pub const FALLEN: Command = Command::Attitude(Attitude {
    angle: 20_000,
    rate: 0,
});

/// Sends it while the attitude goes on being said, and gives what it is answered.
pub fn ask_upright(cm5: &mut VirtualCm5, command: &Command) -> Option<Result<(), Refusal>> {
    say(cm5, &UPRIGHT, 10);
    cm5.clear();
    let sequence = cm5.send(command);
    for _ in 0..20 {
        say(cm5, &UPRIGHT, 10);
        let answer = cm5
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            });
        if answer.is_some() {
            return answer;
        }
    }
    None
}

/// Balances, the first link upright; the token.
pub fn balance(cm5: &mut VirtualCm5) -> u16 {
    let token = ready_to_balance(cm5, &plan());
    assert_eq!(ask_upright(cm5, &arm_with(token)), Some(Ok(())));
    token
}

/// What the CM-5 says when it is asked about a subject.
fn told<T>(cm5: &mut VirtualCm5, subject: Subject, of: fn(Report) -> Option<T>) -> T {
    cm5.clear();
    cm5.send(&Command::Ask(subject));
    cm5.run_ms(60.0);
    let mut reports = cm5.reports().into_iter();
    let told = reports.find_map(|(_, report)| of(report));
    told.unwrap_or_else(|| panic!("an answer about {subject:?}"))
}

/// What the CM-5 says of itself.
pub fn telemetry(cm5: &mut VirtualCm5) -> Telemetry {
    told(cm5, Subject::Telemetry, |report| match report {
        Report::Telemetry(telemetry) => Some(telemetry),
        _ => None,
    })
}

/// What the CM-5 has counted.
pub fn statistics(cm5: &mut VirtualCm5) -> Statistics {
    told(cm5, Subject::Statistics, |report| match report {
        Report::Statistics(statistics) => Some(statistics),
        _ => None,
    })
}

/// Runs until torque is off everywhere, `say`ing something every 10 ms; when the torque limit began
/// to fall and when torque was off, ms from now. At most a second.
pub fn times_to_off(cm5: &mut VirtualCm5, say: Option<&Command>) -> (Option<f64>, Option<f64>) {
    let began_ms = cm5.now_ms();
    let mut soft_ms = None;
    for step in 0..2000 {
        if step % 20 == 0
            && let Some(command) = say
        {
            cm5.send(command);
        }
        cm5.run_ms(0.5);
        let after_ms = cm5.now_ms() - began_ms;
        if soft_ms.is_none() && cm5.app.condition() == Condition::Soft {
            soft_ms = Some(after_ms);
        }
        if !cm5.bus().any_torque() {
            return (soft_ms, Some(after_ms));
        }
    }
    (soft_ms, None)
}

/// From now on the servos from 7 on do what they are told and answer nothing: noise then fills each
/// wait for their answers.
pub fn silence_most(cm5: &mut VirtualCm5) {
    for servo in cm5.bus().servos.iter_mut().filter(|servo| servo.id() > 6) {
        servo.set(STATUS_LEVEL, 0);
    }
}
