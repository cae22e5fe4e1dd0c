//! Noise on the servos' bus: no tick lasts for ever, and nothing starves the watchdog.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::message::*;

/// The watchdog's shortest period, ns: see docs/firmware.md.
const WATCHDOG_NS: u64 = 24_000_000;

#[test]
fn noise_holds_no_tick() {
    for every_us in [10, 50, 200, 240, 249, 260, 500] {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        let now_ns = cm5.board.now_ns();
        silence_most(&mut cm5);
        cm5.bus().set_noise(now_ns, Some(every_us * 1000));
        cm5.board.longest_unfed_ns = 0;
        say(&mut cm5, &Command::KeepAlive, 500);
        let longest_ns = cm5.board.longest_unfed_ns;
        assert!(
            longest_ns < WATCHDOG_NS,
            "noise every {every_us} us: {longest_ns} ns without feeding"
        );
        let now_ns = cm5.board.now_ns();
        cm5.bus().set_noise(now_ns, None);
        say(&mut cm5, &Command::KeepAlive, 100);
        assert!(telemetry(&mut cm5).tick_us < 8000, "it recovers");
    }
}

#[test]
fn noise_ends_balancing() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    let now_ns = cm5.board.now_ns();
    cm5.bus().set_noise(now_ns, Some(200_000));
    say(&mut cm5, &UPRIGHT, 150);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::ServoLost));
    assert!(!cm5.bus().any_torque());
}

#[test]
fn only_ticks_feed_the_watchdog() {
    let mut cm5 = VirtualCm5::new();
    cm5.run_ms(255.0);
    for mode in [Mode::Bridge, Mode::Stream, Mode::Balance] {
        greet(&mut cm5);
        ask(&mut cm5, &Command::Mode(mode));
        let (before, began_ms) = (cm5.board.feeds, cm5.now_ms());
        // In steps: each is a turn of the main loop at least.
        while cm5.now_ms() < began_ms + 1000.0 {
            cm5.run_ms(0.2);
        }
        let feeds = cm5.board.feeds - before;
        // When each begins, and when it ends.
        assert!(
            (198..=202).contains(&feeds),
            "{mode:?}: {feeds} in a second"
        );
    }
}
