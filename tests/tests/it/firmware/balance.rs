//! Balancing on board.

use super::{arm_with, greet, refused};
use handstand_measure::bench::*;
use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::message::*;
use handstand_shared::plan::{Law, Plan};
use handstand_shared::raw::Signed;
use handstand_shared::velocity::Velocity;

/// A law on plain states: the paper's regulator, rounded to the steps the firmware reads in.
pub fn state_plan() -> Plan {
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
pub fn commands_are_the_laws(bench: &mut impl SimulatedCm5) {
    let plan = state_plan();
    arm_balance(bench, &plan).expect("armed");
    let Law::State { table, .. } = &plan.law else {
        unreachable!()
    };
    for (angle, rate) in [(0, 0), (37, -150), (-400, 20), (1200, 900)] {
        for _ in 0..6 {
            bench.send(&Command::Attitude(Attitude { angle, rate }));
            bench.run_ms(10.0);
        }
        // The shafts stand still at their centres, so only the first link departs; six ticks are
        // enough for the slew.
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
    bench.send(&Command::Attitude(Attitude {
        angle: 9000,
        rate: 0,
    }));
    bench.run_ms(30.0);
    assert!(!bench.bus().any_torque());
}

#[test]
fn on_board_the_servos_get_what_the_law_says() {
    commands_are_the_laws(&mut VirtualCm5::new());
}

/// Two degrees off, eccentric and with another dead zone than the plan believes in, it stands; and
/// its commands are those of the host's fixed law on the same readings.
pub fn it_stands(bench: &mut impl SimulatedCm5, seconds: f64) {
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
    let doubtful = run.ticks.iter().filter(|tick| tick.or.is_some()).count();
    // Those of arming are longer: their reports come later, and so does the attitude behind them.
    assert!(
        doubtful <= 5,
        "{doubtful} ticks may have seen either attitude"
    );
    let (different, compared) = different(&plan, &run.ticks);
    assert!(
        different == 0 && compared as f64 > 90.0 * seconds,
        "{different} of {compared}"
    );
}

#[test]
fn three_links_stand() {
    it_stands(&mut VirtualCm5::new(), 20.0);
}

#[test]
fn a_plan_that_was_compiled_in_balances_without_upload() {
    let mut bytes = Vec::new();
    let (_, plan) = plan();
    plan.bytes(|byte| bytes.push(byte));
    let mut rig = VirtualCm5::with_plan(bytes, vec![0xff; 4096], ResetCause(0));
    assert_eq!(greet(&mut rig).plan, plan.fingerprint());
    // One in EEPROM wins, once it is there.
    rig.send_bytes(&[0]);
    let other = state_plan();
    arm_balance(&mut rig, &other).expect("armed");
    let hello = greet(&mut rig);
    assert_eq!(hello.plan, other.fingerprint());
    assert_ne!(other.fingerprint(), plan.fingerprint());
}

#[test]
fn balancing_without_gains_is_refused() {
    let mut rig = VirtualCm5::new();
    let token = greet(&mut rig).token;
    assert_eq!(refused(&mut rig, Command::Mode(Mode::Balance)), None);
    rig.run_ms(300.0);
    assert_eq!(refused(&mut rig, arm_with(token)), Some(Refusal::NoPlan));
}

/// Real servos, which a plan with their lag stands on and one without does not; ideal ones from the
/// longest way back; and a gyro alone whose zero is not the plan's.
#[test]
fn it_stands_on_real_servos_and_by_its_gyro() {
    let one = 1f64.to_radians();
    for start in random_starts(6, one, 3) {
        assert_eq!(
            Rig::REAL.stands_s(&Rig::REAL.plan(), start, 10.0),
            10.0,
            "{start:?}"
        );
    }
    let blind = Rig {
        lag_s: 0.0,
        ..Rig::REAL
    };
    assert!(Rig::REAL.stands_s(&blind.plan(), [one, 0.0, one], 10.0) < 2.0);
    let far = [2.0 * one; 3];
    assert_eq!(Rig::IDEAL.stands_s(&Rig::IDEAL.plan(), far, 10.0), 10.0);
    let gyro = Rig {
        gyro_step_rad_s: Some(10.0 * one),
        gyro_off: 1.0,
        ..Rig::IDEAL
    };
    for start in random_starts(4, one, 4) {
        assert_eq!(gyro.stands_s(&gyro.plan(), start, 10.0), 10.0, "{start:?}");
    }
}
