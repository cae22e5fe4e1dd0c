//! What the CM-5 commands, tick by tick, against the laws told the same readings.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::gains::{GainTable, Row};
use handstand_shared::law::control;
use handstand_shared::message::*;
use handstand_shared::observer::{self, FINE, Observer};
use handstand_shared::plan::{AppliedInput, Gyro, Law, Moment, Plan};
use handstand_shared::raw::Position;
use handstand_shared::velocity;
use micromath::F32Ext;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// In a period, when the tick is over and what is said now arrives before the next one.
const PHASE_MS: f64 = 7.3;
/// The gyro's code at rest.
const ZERO: u16 = 510;

/// Links that do not balance upright: each centre of mass beside its line.
const MOMENTS: [Moment; 3] = [
    Moment {
        along: 3000,
        aside: 130,
    },
    Moment {
        along: 2000,
        aside: -60,
    },
    Moment {
        along: 900,
        aside: 40,
    },
];

/// A table whose rows forget a tenth, with some of everything.
fn table<const M: usize, const N: usize>(
    random: &mut ChaCha8Rng,
    most: i16,
    keeps: bool,
) -> GainTable<M, N> {
    let row = |at: usize, random: &mut ChaCha8Rng| {
        let mut k = [0; N];
        k.fill_with(|| random.random_range(-most..=most));
        if keeps {
            k[at] = -230;
        }
        Row {
            k,
            bias: 128,
            shift: 8,
            low: -30_000,
            high: 30_000,
        }
    };
    GainTable {
        rows: std::array::from_fn(|at| row(at, random)),
        x0: [0; N],
    }
}

/// A plan with an observer of no robot, whose every word counts.
fn observer_plan() -> Plan {
    let random = &mut ChaCha8Rng::seed_from_u64(7);
    let observer = Observer {
        predict: table(random, 9, false),
        feedback: table(random, 30, false),
        update: table(random, 9, true),
        reading_places: [1, 2, 2, 1],
        balance_places: [3, 4, 4],
    };
    Plan {
        law: Law::Observer(observer),
        ..plan()
    }
}

/// A plan on plain states away from the straight pose.
fn state_plan() -> Plan {
    let mut plan = plan();
    if let Law::State { table, .. } = &mut plan.law {
        table.x0 = [300, 7, -9, 0, 0, 0];
    }
    plan
}

/// The laws as `docs/firmware.md` states them.
struct Reference<'a> {
    plan: &'a Plan,
    /// Where the robot balances beside the operating point: first link's angle, joints' fine.
    balance: [i16; 3],
    velocities: [velocity::Memory; 2],
    estimate: observer::Memory,
    applied: [AppliedInput; 2],
    /// Of a gyro, 1e-5 rad.
    angle: i32,
}

impl<'a> Reference<'a> {
    fn new(plan: &'a Plan) -> Self {
        let leans = plan
            .moments
            .map(|m| -F32Ext::atan2(f32::from(m.aside), f32::from(m.along)));
        let fine = ((1 << FINE) as f64 / Position::LSB_RAD) as f32;
        let balance = [
            leans[0] * 1e4,
            (leans[1] - leans[0]) * fine,
            (leans[2] - leans[1]) * fine,
        ];
        let mut reference = Reference {
            plan,
            balance: balance.map(|steps| steps as i16),
            velocities: [velocity::Memory::NONE; 2],
            estimate: observer::Memory::ZERO,
            applied: [AppliedInput::NOTHING; 2],
            angle: 0,
        };
        reference.angle = i32::from(reference.point()[0]) * 10;
        reference
    }

    /// Where it begins: the operating point, and where the masses balance beside it.
    fn point(&self) -> [i16; 3] {
        let x0 = match &self.plan.law {
            Law::State { table, .. } => [table.x0[0], table.x0[1], table.x0[2]],
            Law::Observer(_) => [0; 3],
        };
        let balance = self.whole();
        std::array::from_fn(|i| x0[i] + balance[i])
    }

    /// The same beside it, the joints' in whole codes.
    fn whole(&self) -> [i16; 3] {
        let whole = |e: i16| (f64::from(e) / f64::from(1 << FINE) + 0.5).floor() as i16;
        [
            self.balance[0],
            whole(self.balance[1]),
            whole(self.balance[2]),
        ]
    }

    /// The first link's angle and rate.
    fn sense(&mut self, attitude: Attitude, code: u16) -> (i16, i16) {
        if self.plan.gyro.from_host {
            return (attitude.angle, attitude.rate);
        }
        let off = i32::from(code) - i32::from(ZERO);
        let rate = (off * i32::from(self.plan.gyro.scale)).div_euclid(16);
        self.angle += rate;
        ((self.angle / 10) as i16, rate as i16)
    }

    /// As an observer sees them: of a gyro the angle from equilibrium.
    fn seen(&self, (angle, rate): (i16, i16), joints: [i16; 2]) -> [i16; 4] {
        let from_host = self.plan.gyro.from_host;
        let lean = if from_host { 0 } else { self.balance[0] };
        let fine = |q: i16| q << FINE;
        [angle - lean, fine(joints[0]), fine(joints[1]), rate]
    }

    /// The estimate begins at rest at these, the last readings before torque comes on.
    fn begin(&mut self, sensed: (i16, i16), joints: [i16; 2]) {
        let readings = self.seen(sensed, joints);
        let mut balance = self.balance;
        if !self.plan.gyro.from_host {
            balance[0] = 0;
        }
        if let Law::Observer(observer) = &self.plan.law {
            observer.start(&mut self.estimate, &readings, balance);
        }
    }

    /// What shoulder and hip are commanded.
    fn commands(
        &mut self,
        (angle, rate): (i16, i16),
        joints: [i16; 2],
        is_heard: [bool; 2],
    ) -> [i16; 2] {
        let whole = self.whole();
        let raw = match &self.plan.law {
            Law::State { table, velocity } => {
                let speeds: [i16; 2] =
                    std::array::from_fn(|i| velocity.estimate(&mut self.velocities[i], joints[i]));
                let states = [
                    angle - whole[0],
                    joints[0] - whole[1],
                    joints[1] - whole[2],
                    rate,
                    speeds[0],
                    speeds[1],
                ];
                control(table, &states)
            }
            Law::Observer(observer) => {
                let readings = self.seen((angle, rate), joints);
                let heard = [true, is_heard[0], is_heard[1], true];
                observer.raw_command_of(&mut self.estimate, &readings, heard)
            }
        };
        let input: [i16; 2] =
            std::array::from_fn(|i| self.plan.joints[i].apply(&mut self.applied[i], raw[i]));
        if let Law::Observer(observer) = &self.plan.law {
            observer.update(&mut self.estimate, input);
        }
        std::array::from_fn(|i| self.plan.joints[i].command(input[i]))
    }
}

/// Runs until the next tick is over.
fn to_phase(cm5: &mut VirtualCm5) {
    let periods = ((cm5.now_ms() - PHASE_MS) / 10.0 + 1e-6).floor();
    cm5.run_ms((periods + 1.0) * 10.0 + PHASE_MS - cm5.now_ms());
}

/// Turns the driven joints to these angles, codes from their centres.
fn turn(cm5: &mut VirtualCm5, plan: &Plan, angles: [i16; 2]) {
    for (joint, angle) in plan.joints.iter().zip(angles) {
        for (id, angle) in [(joint.id, angle), (joint.mirror, -angle)] {
            let code = joint.centre as i16 + angle;
            cm5.bus().servo(id).unwrap().shaft.angle_rad = Position(code as u16).to_rad();
        }
    }
}

/// Arms and balances for a while, readings at random, and compares each tick; how many commands
/// were none.
fn compare(cm5: &mut VirtualCm5, plan: &Plan, random: &mut ChaCha8Rng) -> usize {
    let mut reference = Reference::new(plan);
    let mut angles = reference.point();
    let mut attitude = Attitude {
        angle: angles[0],
        rate: 0,
    };
    turn(cm5, plan, [angles[1], angles[2]]);
    cm5.set_gyro(ZERO);
    let token = greet(cm5).token;
    assert_eq!(ask(cm5, &Command::Mode(Mode::Balance)), Some(Ok(())));
    say(cm5, &Command::Attitude(attitude), 300);
    to_phase(cm5);
    cm5.send(&Command::Attitude(attitude));
    cm5.send(&arm_with(token));
    // It arrives while a tick is under way, and is obeyed after it; torque comes on when the servos
    // have said their limits.
    for _ in 0..30 {
        cm5.run_ms(10.0);
        if cm5.app.is_armed() {
            break;
        }
        cm5.send(&Command::Attitude(attitude));
    }
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed, "{plan:?}");
    let mut none = 0;
    let mut heard = [angles[1], angles[2]];
    let sensed = reference.sense(attitude, ZERO);
    reference.begin(sensed, heard);
    for tick in 0..60 {
        // The hip's servo is silent for two ticks.
        let is_heard = [true, !(20..22).contains(&tick)];
        for angle in &mut angles[1..] {
            *angle = (*angle + random.random_range(-4..=4)).clamp(-60, 60);
        }
        attitude.angle = (attitude.angle + random.random_range(-90..=90)).clamp(-2500, 2500);
        attitude.rate = random.random_range(-900..=900);
        let code = random.random_range(ZERO - 9..=ZERO + 9);
        turn(cm5, plan, [angles[1], angles[2]]);
        cm5.set_gyro(code);
        let hip = plan.joints[1].id;
        cm5.bus().servo(hip).unwrap().faults.dead = !is_heard[1];
        cm5.send(&Command::Attitude(attitude));
        to_phase(cm5);
        let into_ms = cm5.now_ms() % 10.0;
        assert!(into_ms < 7.8, "the attitude comes too late: {into_ms}");
        assert_eq!(cm5.app.condition(), Condition::BalanceArmed, "tick {tick}");
        for (heard, (angle, is_heard)) in heard.iter_mut().zip(angles[1..].iter().zip(is_heard)) {
            *heard = if is_heard { *angle } else { *heard };
        }
        let sensed = reference.sense(attitude, code);
        let commands = reference.commands(sensed, heard, is_heard);
        none += commands.iter().filter(|command| **command == 0).count();
        for (i, joint) in plan.joints.iter().enumerate() {
            for (id, wanted) in joint.commands(commands[i]).into_iter().flatten() {
                if id == hip && !is_heard[1] {
                    continue;
                }
                let sent = cm5.bus().servo(id).unwrap().get(MOVING_SPEED);
                assert_eq!(
                    sent, wanted.0,
                    "tick {tick}, servo {id}: {commands:?}, {plan:?}"
                );
            }
        }
    }
    // The gyro's zero is measured again from here on.
    cm5.set_gyro(ZERO);
    assert_eq!(ask(cm5, &Command::Disarm), Some(Ok(())));
    none
}

/// Both laws, by the host's attitude and by the gyro, straight and crooked; each begins at rest
/// when it is armed again.
#[test]
fn the_commands_are_those_of_the_law() {
    for law in [state_plan(), observer_plan()] {
        for from_host in [true, false] {
            for moments in [[Moment::ZERO; 3], MOMENTS] {
                let gyro = Gyro {
                    from_host,
                    ..law.gyro
                };
                let plan = Plan {
                    gyro,
                    moments,
                    ..law
                };
                let random = &mut ChaCha8Rng::seed_from_u64(1);
                let mut cm5 = with_wheels();
                greet(&mut cm5);
                upload(&mut cm5, &plan);
                assert_eq!(greet(&mut cm5).plan, plan.fingerprint());
                assert_eq!(cm5.app.plan_fingerprint(), Some(plan.fingerprint()));
                for _ in 0..2 {
                    let none = compare(&mut cm5, &plan, random);
                    assert!(none < 40, "{none} of 120 commands were none");
                }
            }
        }
    }
}

/// At the edge of its range the first link has not fallen, a step beyond it has.
#[test]
fn the_first_link_falls_at_the_end_of_its_range() {
    let range = plan().range as i16;
    for (angle, condition) in [
        (range, Condition::BalanceArmed),
        (-range, Condition::BalanceArmed),
        (range + 1, Condition::Fault(Cause::Fallen)),
        (-range - 1, Condition::Fault(Cause::Fallen)),
    ] {
        let mut cm5 = with_wheels();
        balance(&mut cm5);
        say(
            &mut cm5,
            &Command::Attitude(Attitude { angle, rate: 0 }),
            50,
        );
        assert_eq!(cm5.app.condition(), condition, "{angle}");
    }
}
