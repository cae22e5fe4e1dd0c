//! What counts as a sign of life, and how fast its absence tells.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS, Speeds};

#[test]
fn only_goals_attitude_and_keep_alive_are_life() {
    for command in [
        Command::Hello { version: VERSION },
        Command::Hello { version: 77 },
        Command::Ask(Subject::Telemetry),
        Command::PlanRead { offset: 0 },
        Command::ServoList(ServoList::default()),
        arm_with(0),
        Command::PlanChunk {
            offset: 0,
            bytes: [0; PLAN_CHUNK],
        },
    ] {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        say(&mut cm5, &Command::KeepAlive, 50);
        let (soft_ms, off_ms) = times_to_off(&mut cm5, Some(&command));
        assert!(
            soft_ms.is_some_and(|ms| ms <= 100.0),
            "{command:?}: {soft_ms:?}"
        );
        assert!(
            off_ms.is_some_and(|ms| ms <= 300.0),
            "{command:?}: {off_ms:?}"
        );
        let fault = Condition::Fault(Cause::LinkLost);
        assert_eq!(cm5.app.condition(), fault, "{command:?}");
    }
    for command in [
        Command::KeepAlive,
        UPRIGHT,
        Command::Goals(Positions::pack([512; SERVOS])),
        Command::Speeds(Speeds::pack([0; SERVOS])),
    ] {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        say(&mut cm5, &command, 500);
        assert_eq!(cm5.app.condition(), Condition::StreamArmed, "{command:?}");
    }
}

/// Noise makes every tick last for two periods; time is counted all the same.
#[test]
fn silence_is_counted_in_time_however_long_ticks_last() {
    let mut tried = 0;
    for phase in 0..20 {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        say(&mut cm5, &Command::KeepAlive, 10 * phase);
        let now_ns = cm5.board.now_ns();
        silence_most(&mut cm5);
        cm5.bus().set_noise(now_ns, Some(240_000));
        cm5.board.longest_unfed_ns = 0;
        say(&mut cm5, &Command::KeepAlive, 200);
        if cm5.app.condition() != Condition::StreamArmed {
            // The checksum of 8 bits lets an error through now and then.
            continue;
        }
        tried += 1;
        assert!(
            cm5.board.longest_unfed_ns > 10_500_000,
            "ticks are to be long"
        );
        cm5.run_ms(f64::from(phase));
        cm5.send(&Command::KeepAlive);
        // 7 bytes on the line.
        cm5.run_ms(1.3);
        let (soft_ms, off_ms) = times_to_off(&mut cm5, None);
        assert!(soft_ms.is_some_and(|ms| ms <= 100.0), "soft {soft_ms:?}");
        assert!(off_ms.is_some_and(|ms| ms <= 300.0), "off {off_ms:?}");
    }
    assert!(tried >= 10, "{tried}");
}

#[test]
fn the_longest_silence_is_told() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    say(&mut cm5, &Command::KeepAlive, 100);
    cm5.run_ms(40.0);
    say(&mut cm5, &Command::KeepAlive, 100);
    let told = telemetry(&mut cm5).longest_silence_ms;
    assert!((35..=60).contains(&told), "{told} ms");
}

/// A frame whose last byte was lost is completed by the zero before the next one, and counts from
/// when it came.
#[test]
fn life_counts_from_its_bytes_not_from_a_zero_that_comes_late() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    say(&mut cm5, &Command::KeepAlive, 50);
    let (mut frame, _) = cm5.pc_mut().frame(&Command::KeepAlive);
    frame.pop();
    cm5.send_bytes(&frame);
    cm5.run_ms(70.0);
    cm5.send_bytes(&[0]);
    cm5.run_ms(31.0);
    assert_eq!(cm5.app.condition(), Condition::Soft);
}
