//! Streaming: 18 servos at 100 Hz, and answers that fail.

use super::greet;
use handstand_measure::bench::*;
use handstand_shared::control_table::GOAL_POSITION;
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};

/// Streams for three seconds: every cycle of 10 ms, nothing lost, the servos where they were sent.
pub fn streams(bench: &mut impl SimulatedCm5) {
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

#[test]
fn eighteen_servos_stream_at_100_hz() {
    streams(&mut VirtualCm5::new());
}

#[test]
fn a_dead_servo_costs_its_own_slot_only() {
    let mut rig = VirtualCm5::new();
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
    let mut rig = VirtualCm5::new();
    rig.bus().servo(3).unwrap().faults.flip = 0.2;
    rig.bus().servo(5).unwrap().faults.wrong_id = 0.2;
    rig.bus().servo(9).unwrap().faults.drop = 0.2;
    let run = stream(&mut rig, 3.0);
    assert_eq!(run.lost, 0);
    rig.clear();
    rig.send(&Command::Ask(Subject::Statistics));
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

#[test]
fn goals_move_nothing_before_arming_and_jump_nowhere_after() {
    let mut rig = VirtualCm5::new();
    greet(&mut rig);
    rig.send(&Command::Mode(Mode::Stream));
    for _ in 0..30 {
        rig.send(&Command::Goals(Positions::pack([900; SERVOS])));
        rig.run_ms(10.0);
    }
    assert!(!rig.bus().any_torque());
    arm(&mut rig);
    rig.send(&Command::Goals(Positions::pack([1023; SERVOS])));
    let mut goals = Vec::new();
    for _ in 0..40 {
        rig.run_ms(1.0);
        goals.push(rig.bus().servo(1).unwrap().get(GOAL_POSITION));
    }
    goals.dedup();
    assert!(goals.len() >= 3, "{goals:?}");
    let steps = goals.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(
        steps.clone().all(|step| step <= 20),
        "one tick may move it by 20 codes: {goals:?}"
    );
}
