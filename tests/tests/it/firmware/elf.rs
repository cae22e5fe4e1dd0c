//! The very program of the chip, in simavr.

use super::adapter::is_a_plain_adapter;
use super::balance::{commands_are_the_laws, it_stands};
use super::condition;
use super::faults::*;
use super::safety::lets_down;
use super::stream::streams;
use handstand::deploy::plan_file;
use handstand_measure::bench::*;
use handstand_measure::firmware::{Built, Toolchain, build, find_built};
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::message::*;
use handstand_shared::plan::Law;
use handstand_simavr::{ElfCm5, Law as LawProgram};
use rand::Rng as _;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// The last build of `cargo xtask firmware`.
///
/// # Panics
/// There is none, or it is older than its sources: nothing would be tested.
fn built() -> Built {
    find_built().unwrap_or_else(|why| panic!("{why}"))
}

#[test]
fn the_elf_streams() {
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
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

/// The tick's time and the RAM that static data and stack take together.
#[test]
fn the_elf_keeps_its_budget() {
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    let telemetry = stream(&mut rig, 1.0).telemetry.expect("it was asked for");
    let ram = 4096 - telemetry.stack_size + telemetry.stack_used;
    eprintln!(
        "longest tick {} us, RAM {ram} bytes",
        telemetry.longest_tick_us
    );
    assert!(
        telemetry.longest_tick_us <= LONGEST_TICK_US,
        "{telemetry:?}"
    );
    assert!(ram <= 4096 * 8 / 10, "{telemetry:?}");
}

#[test]
fn the_elf_commands_what_the_law_says() {
    let built = built();
    commands_are_the_laws(&mut ElfCm5::new(&built.elf).unwrap());
}

#[test]
fn the_elf_holds_three_links_up() {
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    it_stands(&mut rig, 5.0);
    // What is done while servos are awaited costs no byte of their answers.
    assert!(rig.seen.most_waiting <= 2, "{}", rig.seen.most_waiting);
    assert_eq!(rig.core.lost(0), 0);
}

/// The longest ways back, which a reading that is older than designed for fells; and the longest
/// ticks, those in which torque comes on.
#[test]
fn the_elf_stands_from_the_farthest_corners() {
    let built = built();
    let two = 2f64.to_radians();
    let (_, plan) = plan();
    for start_rad in [[two; 3], [two, two, -two], [-two, -two, two], [-two; 3]] {
        let conditions = Conditions {
            dead_zone: 0.08,
            eccentric_m: [0.0; 3],
            start_rad,
        };
        let mut rig = ElfCm5::new(&built.elf).unwrap();
        let run = balance(&mut rig, &plan, &conditions, 5.0).expect("it arms");
        assert!(
            run.stood_s >= 5.0 - 1e-6,
            "{start_rad:?}: {:.2} s, {:?}",
            run.stood_s,
            run.condition
        );
        let telemetry = run.telemetry.expect("it was asked for");
        let longest_us = telemetry.longest_tick_us;
        eprintln!("{start_rad:?}: longest tick {longest_us} us");
        assert!(
            longest_us <= LONGEST_TICK_US,
            "{start_rad:?}: {longest_us} us"
        );
        assert_eq!(telemetry.overruns, 0, "{start_rad:?}");
    }
}

/// The zero that the firmware finds at rest is that of the run.
#[test]
fn the_elf_stands_by_its_gyro_alone() {
    let built = built();
    let (_, plan) = Source::Gyro.plan();
    for degrees in [0.0f64, 0.5, 1.0] {
        let conditions = Conditions {
            dead_zone: 0.08,
            eccentric_m: [0.0; 3],
            start_rad: [degrees.to_radians(); 3],
        };
        let mut rig = ElfCm5::new(&built.elf).unwrap();
        let run = balance(&mut rig, &plan, &conditions, 5.0).expect("it arms");
        assert!(
            run.stood_s >= 5.0 - 1e-6,
            "{degrees}: {:.2} s, {:?}",
            run.stood_s,
            run.condition
        );
    }
}

/// Built here: it is quick after the plain one.
#[test]
fn the_elf_balances_by_the_plan_compiled_in() {
    let toolchain = Toolchain::find().unwrap_or_else(|why| panic!("{why}"));
    let (_, plan) = plan();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.rs");
    std::fs::write(&file, plan_file(&plan, "a test")).unwrap();
    let with_plan = build(&toolchain, Some(&file)).unwrap();
    // The plan alone is added, and not the code that takes one from its bytes once more.
    let size = |file: &Path| std::fs::metadata(file).unwrap().len();
    let mut table = 0;
    plan.bytes(|_| table += 1);
    let (plain, longer) = (size(&built().bin), size(&with_plan.bin));
    assert!(longer <= plain + table + 1024, "{longer} and {plain} bytes");
    let mut rig = ElfCm5::new(&with_plan.elf).unwrap();
    it_stands(&mut rig, 5.0);
    // Nothing was uploaded: beside the fault log one byte of EEPROM is written, the counter of
    // starts.
    let bytes = rig.core.eeprom().iter().enumerate();
    let bytes = bytes.filter(|(at, _)| !(0x700..0x800).contains(at));
    let written: Vec<(usize, &u8)> = bytes.filter(|(_, byte)| **byte != 0xff).collect();
    assert_eq!(written.len(), 1, "{written:?}");
}

#[test]
fn the_elf_lets_the_robot_down_when_a_servo_gives_up() {
    let built = built();
    for way in WAYS {
        a_servo_gives_up_while_streaming(&mut ElfCm5::new(&built.elf).unwrap(), way);
        a_servo_gives_up_while_balancing(&mut ElfCm5::new(&built.elf).unwrap(), way);
    }
}

/// Each servo at a phase of its own; `cargo xtask bench-firmware` and the logic in process try all
/// of them.
#[test]
fn the_elf_notices_a_servo_that_restarts() {
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    for id in 1..=18 {
        a_restart_is_noticed(&mut rig, id, id - 1);
    }
}

/// At both rails, and at codes beside them that no gyro says.
#[test]
fn the_elf_notices_a_gyro_at_a_rail() {
    let built = built();
    for code in [0, 1018] {
        let noticed_ms = gyro_at_rail(&mut ElfCm5::new(&built.elf).unwrap(), code);
        assert!(
            noticed_ms.is_some_and(|ms| ms <= 100.0),
            "{code}: {noticed_ms:?} ms"
        );
    }
    // Nor is it armed with.
    let (_, plan) = Source::Gyro.plan();
    for code in [0, 1023] {
        let mut rig = ElfCm5::new(&built.elf).unwrap();
        rig.set_gyro(code);
        let outcome = arm_balance(&mut rig, &plan);
        assert_eq!(outcome, Err(Some(Refusal::Gyro)), "{code}");
    }
}

#[test]
fn the_elf_bears_two_servos_of_one_id() {
    let built = built();
    twins_cost_their_own_slot_only(&mut ElfCm5::new(&built.elf).unwrap());
    twins_do_not_balance(&mut ElfCm5::new(&built.elf).unwrap(), 11);
    a_twin_ends_balancing(&mut ElfCm5::new(&built.elf).unwrap(), 11);
    a_twin_ends_balancing(&mut ElfCm5::new(&built.elf).unwrap(), 2);
}

/// Every shift has its turn in 3200 states.
#[test]
fn the_law_is_the_same_at_every_shift() {
    let built = built();
    let run = law(&built.law, 3200, 9);
    assert_eq!((run.states, run.different), (3200, 0), "{run:?}");
    assert!(run.over(0..SHIFTS).is_some(), "{run:?}");
}

#[test]
fn the_observer_is_the_same_bit_for_bit() {
    let built = built();
    let (_, plan) = plan();
    let Law::Observer(observer) = &plan.law else {
        panic!("the plan has an observer")
    };
    let run = observer_law(&built.law, observer, 3000, 9);
    assert_eq!(run.different, 0, "{run:?}");
}

#[test]
fn the_elf_is_a_plain_adapter() {
    let built = built();
    is_a_plain_adapter(&mut ElfCm5::new(&built.elf).unwrap());
}

#[test]
fn the_elf_lets_the_robot_down() {
    let built = built();
    lets_down(&mut ElfCm5::new(&built.elf).unwrap(), 5);
}

#[test]
fn the_elf_reads_the_gyro() {
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    rig.run_ms(10.0);
    rig.send_bytes(&[0]);
    rig.send(&Command::Hello { version: VERSION });
    rig.run_ms(20.0);
    for millivolts in [0, 1250, 2500, 3700, 5000] {
        rig.core.adc(3, millivolts);
        rig.run_ms(5.0);
        rig.clear();
        rig.send_bytes(&[0]);
        rig.send(&Command::Ask(Subject::Telemetry));
        rig.run_ms(30.0);
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
    let built = built();
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    rig.run_ms(10.0);
    rig.core.pin('D', 0, false);
    rig.run_ms(50.0);
    assert_eq!(condition(&mut rig), Some(Condition::Balance), "Start");
    rig.core.pin('D', 0, true);
    // Each of the others stops.
    for pin in 4..8 {
        arm(&mut rig);
        assert!(rig.bus.any_torque());
        rig.core.pin('E', pin, false);
        for _ in 0..5 {
            rig.send(&Command::KeepAlive);
            rig.run_ms(10.0);
        }
        assert!(!rig.bus.any_torque(), "PE{pin}");
        rig.core.pin('E', pin, true);
        rig.run_ms(50.0);
    }
}

#[test]
fn the_elf_restarts_when_it_hangs() {
    let built = built();
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    let mut worst = Worst::default();
    (0..10).for_each(|_| worst.add(hang(&mut rig, &mut rng)));
    assert!(worst.failed == 0 && worst.off_ms <= 150.0, "{worst:?}");
}

/// The watchdog's shortest period, us: docs/firmware.md.
const SHORTEST_US: u32 = 24_000;

#[test]
fn the_elf_starts_once_after_a_hang_whatever_it_has_to_read() {
    let built = built();
    let all: Vec<u8> = (1..=18).collect();
    for plans in 0..=2 {
        let eeprom = eeprom_with(plans);
        for ids in [&all[..], &[]] {
            let boot = boot(&built.elf, &eeprom, ids, SHORTEST_US);
            let case = format!("{plans} plans, {} servos: {boot:?}", ids.len());
            assert!(boot.resets == 1 && boot.answers, "{case}");
            assert!(boot.unfed_ms < 21.0, "{case}");
        }
    }
}

#[test]
fn noise_on_the_bus_resets_nothing() {
    let built = built();
    for every_us in [10, 240] {
        let (resets, unfed_ms) = noise(&built.elf, every_us, SHORTEST_US, 400.0);
        assert!(
            resets == 0 && unfed_ms < 21.0,
            "noise every {every_us} us: {resets} resets, {unfed_ms} ms"
        );
    }
}

#[test]
fn the_elf_restarts_through_the_boot_loader_while_the_host_speaks() {
    let built = built();
    let mut rng = ChaCha8Rng::seed_from_u64(18);
    let mut rig = ElfCm5::new(&built.elf).unwrap();
    rig.set_boot_loader(50.0);
    let mut worst = Worst::default();
    (0..10).for_each(|_| worst.add(hang(&mut rig, &mut rng)));
    assert!(worst.failed == 0 && worst.off_ms <= 150.0, "{worst:?}");
    // What the frames must not hold keeps the program from starting.
    rig.core.power_cycle();
    rig.run_ms(1.0);
    rig.send_bytes(b"#");
    rig.run_ms(200.0);
    assert!(rig.loader.is_some_and(|loader| loader.has_prompt));
    rig.clear();
    rig.send(&Command::Hello { version: VERSION });
    rig.run_ms(100.0);
    assert!(rig.reports().is_empty());
}

#[test]
fn the_law_is_the_same_bit_for_bit() {
    let built = built();
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
