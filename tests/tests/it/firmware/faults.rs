//! Servos that give up, and servos of one id.

use super::condition;
use handstand_cm5_sim::{Bus, Servo};
use handstand_measure::bench::*;
use handstand_shared::control_table::{MOVING_SPEED, TORQUE_ENABLE};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};

/// How a servo gives up.
#[derive(Debug, Clone, Copy)]
pub enum GivesUp {
    /// Its protection tripped: torque limit 0, torque off.
    Overload,
    /// The same in a servo that only drops its limit: a new limit would wake it.
    LimitOnly,
    /// It is too hot.
    Heat,
}

pub const WAYS: [GivesUp; 3] = [GivesUp::Overload, GivesUp::LimitOnly, GivesUp::Heat];

impl GivesUp {
    fn strike(self, servo: &mut Servo) {
        match self {
            GivesUp::Overload => servo.overload(),
            GivesUp::LimitOnly => {
                servo.overload();
                servo.set(TORQUE_ENABLE, 1);
            }
            GivesUp::Heat => servo.temperature = 90.0,
        }
    }

    fn says(self) -> ErrorBits {
        match self {
            GivesUp::Overload | GivesUp::LimitOnly => ErrorBits::OVERLOAD,
            GivesUp::Heat => ErrorBits::OVERHEAT,
        }
    }
}

fn asked<T>(
    bench: &mut impl SimulatedCm5,
    subject: Subject,
    kind: impl Fn(Report) -> Option<T>,
) -> Option<T> {
    bench.clear();
    bench.send(&Command::Ask(subject));
    bench.run_ms(60.0);
    let mut reports = bench.reports().into_iter();
    reports.find_map(|(_, report)| kind(report))
}

fn tripped(bench: &mut impl SimulatedCm5) -> Option<TrippedServo> {
    let telemetry = asked(bench, Subject::Telemetry, |report| match report {
        Report::Telemetry(telemetry) => Some(telemetry),
        _ => None,
    });
    telemetry.expect("telemetry").tripped
}

/// Conditions in the order they were reported, each once.
fn conditions(bench: &impl SimulatedCm5) -> Vec<Condition> {
    let of_stream = |(_, report)| match report {
        Report::Stream(report) => Some(report.condition),
        _ => None,
    };
    let mut seen: Vec<Condition> = bench.reports().into_iter().filter_map(of_stream).collect();
    seen.dedup();
    seen
}

/// From the blow on the host goes on speaking: torque falls in all, and never comes back to who
/// gave up.
fn is_let_down(
    bench: &mut impl SimulatedCm5,
    id: u8,
    way: GivesUp,
    armed: Condition,
    say: &Command,
) {
    bench.clear();
    way.strike(bench.bus().servo(id).expect("18 servos"));
    let struck_ms = bench.now_ms();
    let mut held_ms = 0.0;
    while bench.bus().any_torque() {
        bench.send(say);
        for _ in 0..10 {
            bench.run_ms(1.0);
            let after_ms = bench.now_ms() - struck_ms;
            assert!(
                after_ms < 300.0,
                "{way:?}: torque is on {after_ms} ms later"
            );
            let bus = bench.bus();
            // Two ticks to be heard and acted upon.
            if after_ms > 25.0 {
                let is_on = bus.servo(id).is_some_and(|servo| servo.torque_is_on());
                assert!(!is_on, "{way:?}: servo {id} is awake, {after_ms} ms later");
            }
            if bus.any_torque() {
                held_ms = after_ms;
            }
        }
    }
    // Ticks of the logic in process pass at once, so it is looked at every 5 ms only.
    assert!(held_ms > 140.0, "{way:?}: torque fell after {held_ms} ms");
    bench.run_ms(30.0);
    let fault = Condition::Fault(Cause::ServoError);
    assert_eq!(
        conditions(bench),
        [armed, Condition::Soft, fault],
        "{way:?}"
    );
    let error = way.says().0;
    assert_eq!(tripped(bench), Some(TrippedServo { id, error }), "{way:?}");
}

pub fn a_servo_gives_up_while_streaming(bench: &mut impl SimulatedCm5, way: GivesUp) {
    arm(bench);
    let goals = Command::Goals(Positions::pack([530; SERVOS]));
    for _ in 0..5 {
        bench.send(&goals);
        bench.run_ms(10.0);
    }
    assert_eq!(tripped(bench), None);
    is_let_down(bench, 7, way, Condition::StreamArmed, &goals);
    // Cooled down it arms again, and no servo is named any more.
    bench.bus().servo(7).expect("18 servos").temperature = 30.0;
    arm(bench);
    assert_eq!(tripped(bench), None, "{way:?}");
}

pub fn a_servo_gives_up_while_balancing(bench: &mut impl SimulatedCm5, way: GivesUp) {
    let (_, plan) = plan();
    arm_balance(bench, &plan).expect("armed");
    let upright = Command::Attitude(Attitude::default());
    // Until all of them have torque.
    for _ in 0..10 {
        bench.send(&upright);
        bench.run_ms(10.0);
    }
    // The hip's mirror: its angle is not read.
    is_let_down(bench, 12, way, Condition::BalanceArmed, &upright);
    for id in [1, 2, 11] {
        let servo = bench.bus().servo(id).expect("18 servos");
        assert_eq!(servo.get(MOVING_SPEED), 0, "servo {id} was told to stop");
    }
}

/// A servo loses its RAM while it is sent goals, so many ticks after arming: within two rounds of
/// the housekeeping the robot is let down, and the servo named.
pub fn a_restart_is_noticed(bench: &mut impl SimulatedCm5, id: u8, phase: u8) {
    let noticed_ms = restart(bench, id, phase);
    assert!(
        noticed_ms.is_some_and(|ms| ms <= 200.0),
        "servo {id}, phase {phase}: {noticed_ms:?} ms"
    );
    let goals = Command::Goals(Positions::pack([540; SERVOS]));
    for _ in 0..20 {
        bench.send(&goals);
        bench.run_ms(10.0);
    }
    let fault = Condition::Fault(Cause::TorqueLost);
    assert_eq!(condition(bench), Some(fault), "servo {id}, phase {phase}");
    assert!(!bench.bus().any_torque());
    assert_eq!(tripped(bench).map(|servo| servo.id), Some(id));
}

/// Eighteen servos and one more of this id.
fn with_twin(id: u8) -> Bus {
    Bus::new((1..=18).chain([id]))
}

pub fn twins_cost_their_own_slot_only(bench: &mut impl SimulatedCm5) {
    *bench.bus() = with_twin(5);
    let run = stream(bench, 2.0);
    assert_eq!((run.lost, run.bad_frames), (0, 0));
    let others = (0..SERVOS).filter(|place| *place != 4);
    for place in others {
        let missing = run.reports.iter().filter(|(_, r)| !r.is_present(place));
        assert_eq!(missing.count(), 0, "servo {}", place + 1);
    }
    let heard = run.reports.iter().filter(|(_, r)| r.is_present(4)).count();
    // While its motor interrupt holds one of them back, the other one is heard whole.
    assert!(
        heard * 3 < run.reports.len(),
        "twins were heard {heard} times"
    );
    assert!(
        run.telemetry
            .is_some_and(|telemetry| telemetry.overruns == 0)
    );
    let counted = asked(bench, Subject::Statistics, |report| match report {
        Report::Statistics(statistics) => Some(statistics),
        _ => None,
    });
    let counted = counted.expect("statistics");
    assert!(
        counted.garbled > 100 && counted.missed[4] > 100,
        "{counted:?}"
    );
    let (before, after) = (counted.missed[3], counted.missed[5]);
    // While arming the twins were read whole, now and then: the end of so long an answer meets the
    // request to the next servo.
    assert!(before == 0 && after <= 5, "{counted:?}");
}

pub fn twins_do_not_balance(bench: &mut impl SimulatedCm5, id: u8) {
    let (_, plan) = plan();
    *bench.bus() = with_twin(id);
    match arm_balance(bench, &plan) {
        // One of them was heard whole in that very tick.
        Ok(()) => stops_balancing(bench, id),
        // The same, but neither ever said its mode undisturbed.
        Err(Some(Refusal::Wheel)) => {}
        refused => assert_eq!(refused, Err(Some(Refusal::Servo)), "servo {id}"),
    }
    assert!(!bench.bus().any_torque());
}

/// A servo that is plugged in while the robot balances.
pub fn a_twin_ends_balancing(bench: &mut impl SimulatedCm5, id: u8) {
    let (_, plan) = plan();
    *bench.bus() = with_twin(id);
    set_twin(bench.bus(), id, true);
    arm_balance(bench, &plan).expect("armed");
    set_twin(bench.bus(), id, false);
    stops_balancing(bench, id);
}

fn stops_balancing(bench: &mut impl SimulatedCm5, id: u8) {
    bench.clear();
    for _ in 0..20 {
        bench.send(&Command::Attitude(Attitude::default()));
        bench.run_ms(10.0);
    }
    assert!(!bench.bus().any_torque(), "servo {id}");
    let fault = Condition::Fault(Cause::ServoLost);
    assert_eq!(conditions(bench).last(), Some(&fault), "servo {id}");
}

fn set_twin(bus: &mut Bus, id: u8, is_dead: bool) {
    let twin = bus.servos.iter_mut().rfind(|servo| servo.id() == id);
    twin.expect("the second of its id").faults.dead = is_dead;
}

#[test]
fn a_servo_that_gives_up_lets_the_streaming_robot_down() {
    for way in WAYS {
        a_servo_gives_up_while_streaming(&mut VirtualCm5::new(), way);
    }
}

#[test]
fn a_servo_that_gives_up_lets_the_balancing_robot_down() {
    for way in WAYS {
        a_servo_gives_up_while_balancing(&mut VirtualCm5::new(), way);
    }
}

#[test]
fn a_servo_that_restarts_under_goals_is_noticed_at_every_phase() {
    for id in 1..=18 {
        let mut rig = VirtualCm5::new();
        for phase in 0..18 {
            a_restart_is_noticed(&mut rig, id, phase);
        }
    }
}

#[test]
fn two_servos_of_one_id_cost_their_own_slot_only() {
    twins_cost_their_own_slot_only(&mut VirtualCm5::new());
}

#[test]
fn two_servos_of_one_id_do_not_balance() {
    for id in [1, 2, 11, 12] {
        twins_do_not_balance(&mut VirtualCm5::new(), id);
        a_twin_ends_balancing(&mut VirtualCm5::new(), id);
    }
}
