//! The firmware: its logic in process, and the real ELF in simavr where both are there.

use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::dynamixel::{ErrorBits, Packet};
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::plan::{Law, Plan};
use handstand_shared::raw::Signed;
use handstand_shared::velocity::Velocity;
use handstand_tests::bench::*;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// Streams for three seconds: every cycle of 10 ms, nothing lost, the servos where they were sent.
fn streams(bench: &mut impl Bench) {
    let run = stream(bench, 3.0);
    assert_eq!((run.lost, run.missing, run.bad_frames), (0, 0, 0));
    let (least, most) = (run.cycles_ms[0], run.cycles_ms[run.cycles_ms.len() - 1]);
    assert!(least > 8.0 && most < 12.0, "{least} to {most} ms");
    assert!(run.bytes_per_frame <= 57.0, "{}", run.bytes_per_frame);
    assert!(run.worst_tracking < 30, "{}", run.worst_tracking);
    assert!(
        run.telemetry
            .is_some_and(|telemetry| telemetry.overruns == 0)
    );
}

fn lets_down(bench: &mut impl Bench, times: usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut worst = Worst::default();
    (0..times).for_each(|_| worst.add(link_loss(bench, &mut rng)));
    assert_eq!(worst.failed, 0);
    assert!(worst.soft_ms <= 100.0 && worst.off_ms <= 300.0, "{worst:?}");
}

#[test]
fn eighteen_servos_stream_at_100_hz() {
    streams(&mut PcRig::new());
}

#[test]
fn a_silent_link_lets_the_robot_down() {
    lets_down(&mut PcRig::new(), 20);
}

#[test]
fn a_dead_servo_costs_its_own_slot_only() {
    let mut rig = PcRig::new();
    rig.bus().servo(7).unwrap().faults.dead = true;
    let run = stream(&mut rig, 1.0);
    assert_eq!(run.lost, 0);
    assert!(
        run.reports
            .iter()
            .all(|(_, r)| (0..SERVOS).all(|at| r.is_present(at) == (at != 6)))
    );
}

#[test]
fn garbled_late_and_strange_answers_are_counted_and_asked_for_again() {
    let mut rig = PcRig::new();
    rig.bus().servo(3).unwrap().faults.flip = 0.2;
    rig.bus().servo(5).unwrap().faults.wrong_id = 0.2;
    rig.bus().servo(9).unwrap().faults.drop = 0.2;
    let run = stream(&mut rig, 3.0);
    assert_eq!(run.lost, 0);
    rig.forget();
    rig.say(&Command::Ask(Subject::Statistics));
    rig.run_ms(30.0);
    let counted = rig.reports().into_iter().find_map(|(_, r)| match r {
        Report::Statistics(statistics) => Some(statistics),
        _ => None,
    });
    let counted = counted.expect("statistics");
    assert!(
        counted.garbled > 20 && counted.strangers > 20 && counted.timeouts > 20,
        "{counted:?}"
    );
    // One repetition finds most of them: 0.2 x 0.2 of 300 ticks stay missing.
    assert!(
        counted.retries > 100 && counted.missed[2] < 60,
        "{counted:?}"
    );
    assert_eq!(counted.missed[0], 0);
}

fn refused(rig: &mut PcRig, command: Command) -> Option<Refusal> {
    rig.forget();
    let sequence = rig.say(&command);
    rig.run_ms(30.0);
    rig.reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome.err()),
            _ => None,
        })?
}

fn greet(rig: &mut PcRig) -> Hello {
    rig.forget();
    rig.say(&Command::Hello { version: VERSION });
    rig.run_ms(20.0);
    let hello = rig
        .reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Hello(hello) => Some(hello),
            _ => None,
        });
    hello.expect("an answer")
}

#[test]
fn arming_needs_a_greeting_a_token_a_state_and_a_supply() {
    let mut rig = PcRig::new();
    rig.type_bytes(&[0]);
    assert_eq!(
        refused(&mut rig, Command::Arm { token: 1 }),
        Some(Refusal::Version)
    );
    let token = greet(&mut rig).token;
    rig.type_bytes(&[0]);
    assert_eq!(
        refused(&mut rig, Command::Arm { token: token ^ 1 }),
        Some(Refusal::Token)
    );
    assert_eq!(refused(&mut rig, Command::Mode(Mode::Stream)), None);
    assert_eq!(
        refused(&mut rig, Command::Arm { token }),
        Some(Refusal::Supply)
    );
    rig.bus().servo(4).unwrap().supply_v = 8.0;
    rig.run_ms(300.0);
    assert_eq!(
        refused(&mut rig, Command::Arm { token }),
        Some(Refusal::Supply)
    );
    rig.bus().servo(4).unwrap().supply_v = 9.5;
    rig.run_ms(300.0);
    assert_eq!(refused(&mut rig, Command::Arm { token }), None);
    assert!(rig.bus().any_torque());
}

#[test]
fn the_first_thing_on_the_bus_is_torque_off() {
    let mut rig = PcRig::new();
    assert!(
        rig.board.bus.torque_offs[0] < 200_000,
        "{:?} ns",
        rig.board.bus.torque_offs
    );
    rig.run_ms(100.0);
    assert!(!rig.bus().any_torque());
}

#[test]
fn after_the_watchdog_nothing_arms_without_a_greeting() {
    let mut rig = PcRig::boot(vec![0xff; 4096], ResetCause(ResetCause::WATCHDOG));
    rig.run_ms(50.0);
    let hello = greet(&mut rig);
    assert_eq!(hello.condition, Condition::Fault(Cause::Watchdog));
    assert_eq!(
        refused(&mut rig, Command::Arm { token: hello.token }),
        Some(Refusal::State)
    );
    arm(&mut rig);
}

#[test]
fn goals_move_nothing_before_arming_and_jump_nowhere_after() {
    let mut rig = PcRig::new();
    greet(&mut rig);
    rig.say(&Command::Mode(Mode::Stream));
    for _ in 0..30 {
        rig.say(&Command::Goals(Positions::pack([900; SERVOS])));
        rig.run_ms(10.0);
    }
    assert!(!rig.bus().any_torque());
    arm(&mut rig);
    rig.say(&Command::Goals(Positions::pack([1023; SERVOS])));
    rig.run_ms(12.0);
    use handstand_shared::control_table::GOAL_POSITION;
    let goal = rig.bus().servo(1).unwrap().get(GOAL_POSITION);
    assert!(
        (513..=532).contains(&goal),
        "one tick may move it by 20 codes: {goal}"
    );
}

#[test]
fn any_button_stops_an_armed_robot() {
    let mut rig = PcRig::new();
    arm(&mut rig);
    rig.board.buttons = handstand_firmware::panel::button::LEFT;
    for _ in 0..5 {
        rig.say(&Command::KeepAlive);
        rig.run_ms(10.0);
    }
    assert!(!rig.bus().any_torque());
}

/// What the last report of a tick says.
fn condition(bench: &mut impl Bench) -> Option<Condition> {
    bench.forget();
    bench.run_ms(30.0);
    let last = bench.reports().into_iter().rev();
    last.filter_map(|(_, report)| match report {
        Report::Stream(report) => Some(report.condition),
        _ => None,
    })
    .next()
}

#[test]
fn start_chooses_balancing_and_moves_nothing() {
    let mut rig = PcRig::new();
    rig.board.buttons = handstand_firmware::panel::button::START;
    rig.run_ms(20.0);
    assert_eq!(rig.app.condition(), Condition::Bridge, "it may be bouncing");
    assert_eq!(condition(&mut rig), Some(Condition::Balance));
    rig.board.buttons = handstand_firmware::panel::button::UP;
    rig.run_ms(50.0);
    assert_eq!(rig.app.condition(), Condition::Balance);
    assert!(!rig.bus().any_torque());
}

#[test]
fn no_start_and_no_greeting_repeats_a_token() {
    let mut eeprom = vec![0xff; 4096];
    let mut tokens = std::collections::BTreeSet::new();
    for start in 0..200 {
        // Now and then the power fails while the cell of this start is written.
        if start % 20 == 7 {
            eeprom[0x800 + start % 64] = 0x5a;
        }
        let mut rig = PcRig::boot(eeprom, ResetCause(ResetCause::POWER));
        rig.run_ms(20.0);
        for _ in 0..3 {
            rig.type_bytes(&[0]);
            let token = greet(&mut rig).token;
            assert!(tokens.insert(token), "{token:#06x} again, start {start}");
        }
        eeprom = rig.board.eeprom;
    }
    let untouched = |range: std::ops::Range<usize>| eeprom[range].iter().all(|byte| *byte == 0xff);
    assert!(untouched(0..0x800) && untouched(0x840..4096));
}

/// Existing tools see a plain adapter: their packets go through, and so do the answers.
fn is_a_plain_adapter(bench: &mut impl Bench) {
    bench.run_ms(20.0);
    bench.forget();
    bench.type_bytes(&[0xff, 0xff, 3, 2, 1, 0xf9]);
    bench.run_ms(10.0);
    assert_eq!(bench.raw(), [0xff, 0xff, 3, 2, 0, 0xfa]);
    bench.forget();
    bench.type_bytes(&[0xff, 0xff, 1, 4, 2, 36, 8, 0xff - 51]);
    bench.run_ms(10.0);
    let packet = Packet::new(bench.raw()).expect("a sound answer");
    assert_eq!((packet.id(), ErrorBits(packet.code())), (1, ErrorBits(0)));
    assert_eq!(packet.parameters().len(), 8);
    // Ids and registers of zero go to the servos too.
    bench.forget();
    bench.type_bytes(&[0xff, 0xff, 1, 4, 2, 0, 2, 0xff - 9]);
    bench.run_ms(10.0);
    assert_eq!(
        Packet::new(bench.raw()).map(|p| p.parameters().to_vec()),
        Ok(vec![12, 0])
    );
}

#[test]
fn the_adapter_is_transparent() {
    is_a_plain_adapter(&mut PcRig::new());
}

/// A law on plain states: the paper's regulator, rounded to the steps the firmware reads in.
fn state_plan() -> Plan {
    let (_, plan) = plan();
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
    assert!(table.is_safe());
    let velocity = Velocity {
        fraction: 4,
        share: 128,
    };
    Plan {
        law: Law::State { table, velocity },
        ..plan
    }
}

/// The commands that reach the servos are the host's law on the same states, through the plan.
fn commands_are_the_laws(bench: &mut impl Bench) {
    let plan = state_plan();
    arm_balance(bench, &plan).expect("armed");
    let Law::State { table, .. } = &plan.law else {
        unreachable!()
    };
    for (angle, rate) in [(0, 0), (37, -150), (-400, 20), (1200, 900)] {
        for _ in 0..6 {
            bench.say(&Command::Attitude(Attitude { angle, rate }));
            bench.run_ms(10.0);
        }
        // The shafts stand still at their centres, so only the first link departs; six ticks are enough for the slew.
        let u = control(table, &[angle, 0, 0, rate, 0, 0]);
        for (joint, u) in plan.joints.iter().zip(u) {
            let command = joint.command(u);
            let servo = |bench: &mut dyn FnMut(u8) -> u16, id| Signed(bench(id)).get();
            let mut read = |id| bench.bus().servo(id).expect("18 servos").get(MOVING_SPEED);
            assert_eq!(servo(&mut read, joint.id), command, "{angle} {rate}");
            assert_eq!(servo(&mut read, joint.mirror), -command, "{angle} {rate}");
        }
    }
    // Beyond the plan's range it has fallen, and torque is off.
    bench.say(&Command::Attitude(Attitude {
        angle: 9000,
        rate: 0,
    }));
    bench.run_ms(30.0);
    assert!(!bench.bus().any_torque());
}

#[test]
fn on_board_the_servos_get_what_the_law_says() {
    commands_are_the_laws(&mut PcRig::new());
}

/// Two degrees off, eccentric and with another dead zone than the plan believes in, it stands; and its
/// commands are those of the host's fixed law on the same readings.
fn it_stands(bench: &mut impl Bench, seconds: f64) {
    let two = 2f64.to_radians();
    let conditions = Conditions {
        dead_zone: 0.09,
        eccentric_m: [0.5e-3, -0.5e-3, 0.5e-3],
        start_rad: [two, -two, two],
    };
    let (_, plan) = plan();
    let run = balance(bench, &plan, &conditions, seconds).expect("it arms");
    assert!(run.stood_s >= seconds - 1e-6, "{:.2} s", run.stood_s);
    assert_eq!(run.condition, Some(Condition::BalanceArmed));
    let (different, compared) = different(&plan, &run.ticks);
    assert!(
        different == 0 && compared as f64 > 90.0 * seconds,
        "{different} of {compared}"
    );
}

#[test]
fn three_links_stand() {
    it_stands(&mut PcRig::new(), 20.0);
}

#[test]
fn a_plan_that_was_compiled_in_balances_without_upload() {
    let mut bytes = Vec::new();
    let (_, plan) = plan();
    plan.bytes(|byte| bytes.push(byte));
    let mut rig = PcRig::with_plan(bytes, vec![0xff; 4096], ResetCause(0));
    assert_eq!(greet(&mut rig).gains, plan.fingerprint());
    // One in EEPROM wins, once it is there.
    rig.type_bytes(&[0]);
    let other = state_plan();
    arm_balance(&mut rig, &other).expect("armed");
    let hello = greet(&mut rig);
    assert_eq!(hello.gains, other.fingerprint());
    assert_ne!(other.fingerprint(), plan.fingerprint());
}

#[test]
fn balancing_without_gains_is_refused() {
    let mut rig = PcRig::new();
    let token = greet(&mut rig).token;
    assert_eq!(refused(&mut rig, Command::Mode(Mode::Balance)), None);
    rig.run_ms(300.0);
    assert_eq!(
        refused(&mut rig, Command::Arm { token }),
        Some(Refusal::NoGains)
    );
}

#[test]
fn a_power_cut_leaves_the_old_or_the_new_gains() {
    let tally = power_cuts(&[0x00, 0xff, 0x5a]);
    assert_eq!(tally.neither, 0, "{tally:?}");
    assert!(tally.cuts > 180 && tally.old > 0, "{tally:?}");
}

#[test]
fn damaged_frames_are_refused() {
    assert_eq!(patterns(4, 1).wrong, 0);
    let flips = bit_flips(12, 10, 2);
    assert_eq!(flips.wrong, 0, "{flips:?}");
    let random = random_bytes(10_000_000, 3);
    assert_eq!(random.critical, 0, "{random:?}");
    assert!(resynchronised(1000, 4) <= 2);
}

#[cfg(simavr)]
mod elf {
    use super::*;
    use handstand_simavr::{Law as LawProgram, Rig};
    use handstand_tests::firmware::{Built, find_built};
    use rand::Rng as _;

    /// The last build of `cargo xtask firmware`, or a word about its absence.
    fn built() -> Option<Built> {
        let built = find_built();
        if built.is_none() {
            eprintln!("SKIPPED: there is no ELF; `cargo xtask firmware` builds it");
        }
        built
    }

    #[test]
    fn the_elf_streams() {
        let Some(built) = built() else { return };
        let mut rig = Rig::new(&built.elf).unwrap();
        streams(&mut rig);
        assert_eq!(rig.seen.direction_faults, 0);
        assert!(
            rig.seen.most_waiting <= 2,
            "the receiver holds two bytes, {}",
            rig.seen.most_waiting
        );
        assert_eq!((rig.core.lost(0), rig.core.lost(1)), (0, 0));
        assert!(!rig.seen.charged, "the charger must stay off");
    }

    #[test]
    fn the_elf_commands_what_the_law_says() {
        let Some(built) = built() else { return };
        commands_are_the_laws(&mut Rig::new(&built.elf).unwrap());
    }

    #[test]
    fn the_elf_holds_three_links_up() {
        let Some(built) = built() else { return };
        it_stands(&mut Rig::new(&built.elf).unwrap(), 5.0);
    }

    /// Every shift has its turn in 3200 states.
    #[test]
    fn the_law_is_the_same_at_every_shift() {
        let Some(built) = built() else { return };
        let run = law(&built.law, 3200, 9);
        assert_eq!((run.states, run.different), (3200, 0), "{run:?}");
        assert!(run.over(0..SHIFTS).is_some(), "{run:?}");
    }

    #[test]
    fn the_observer_is_the_same_bit_for_bit() {
        let Some(built) = built() else { return };
        let (_, plan) = plan();
        let Law::Observer(observer) = &plan.law else {
            panic!("the plan has an observer")
        };
        let run = observer_law(&built.law, observer, 3000, 9);
        assert_eq!(run.different, 0, "{run:?}");
    }

    #[test]
    fn the_elf_is_a_plain_adapter() {
        let Some(built) = built() else { return };
        is_a_plain_adapter(&mut Rig::new(&built.elf).unwrap());
    }

    #[test]
    fn the_elf_lets_the_robot_down() {
        let Some(built) = built() else { return };
        lets_down(&mut Rig::new(&built.elf).unwrap(), 5);
    }

    #[test]
    fn the_elf_reads_the_gyro() {
        let Some(built) = built() else { return };
        let mut rig = Rig::new(&built.elf).unwrap();
        Bench::run_ms(&mut rig, 10.0);
        rig.type_bytes(&[0]);
        Bench::say(&mut rig, &Command::Hello { version: VERSION });
        Bench::run_ms(&mut rig, 20.0);
        for millivolts in [0, 1250, 2500, 3700, 5000] {
            rig.core.adc(3, millivolts);
            Bench::run_ms(&mut rig, 5.0);
            Bench::forget(&mut rig);
            rig.type_bytes(&[0]);
            Bench::say(&mut rig, &Command::Ask(Subject::Telemetry));
            Bench::run_ms(&mut rig, 30.0);
            let told = rig
                .reports()
                .into_iter()
                .find_map(|(_, report)| match report {
                    Report::Telemetry(telemetry) => Some(telemetry.gyro),
                    _ => None,
                });
            let code = (millivolts * 1023 / 5000) as u16;
            assert!(
                told.is_some_and(|told| told.abs_diff(code) <= 1),
                "{millivolts} mV: {told:?} for {code}"
            );
        }
    }

    #[test]
    fn the_elf_hears_its_buttons() {
        let Some(built) = built() else { return };
        let mut rig = Rig::new(&built.elf).unwrap();
        Bench::run_ms(&mut rig, 10.0);
        rig.core.pin('D', 0, false);
        Bench::run_ms(&mut rig, 50.0);
        assert_eq!(condition(&mut rig), Some(Condition::Balance), "Start");
        rig.core.pin('D', 0, true);
        // Each of the others stops.
        for pin in 4..8 {
            arm(&mut rig);
            assert!(rig.bus.any_torque());
            rig.core.pin('E', pin, false);
            for _ in 0..5 {
                Bench::say(&mut rig, &Command::KeepAlive);
                Bench::run_ms(&mut rig, 10.0);
            }
            assert!(!rig.bus.any_torque(), "PE{pin}");
            rig.core.pin('E', pin, true);
            Bench::run_ms(&mut rig, 50.0);
        }
    }

    #[test]
    fn the_elf_restarts_when_it_hangs() {
        let Some(built) = built() else { return };
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let mut rig = Rig::new(&built.elf).unwrap();
        let mut worst = Worst::default();
        (0..10).for_each(|_| worst.add(hang(&mut rig, &mut rng)));
        assert!(worst.failed == 0 && worst.off_ms <= 150.0, "{worst:?}");
    }

    #[test]
    fn the_law_is_the_same_bit_for_bit() {
        let Some(built) = built() else { return };
        let mut law = LawProgram::load(&built.law).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        for shift in [16, 8, 13] {
            let k = [(); 2].map(|()| [(); 6].map(|()| rng.random_range(-10_000..10_000)));
            let bias = [(); 2].map(|()| rng.random_range(-(1 << 26)..1 << 26));
            let limits = [[-1023, 1023], [i16::MIN, i16::MAX]];
            let table = GainTable::new(k, bias, [shift; 2], limits, [(); 6].map(|()| rng.random()));
            assert!(table.is_safe());
            law.set(&table);
            for _ in 0..2000 {
                let x = [(); 6].map(|()| rng.random());
                assert_eq!(law.control(&x).0, control(&table, &x), "{x:?} {table:?}");
            }
        }
    }
}
