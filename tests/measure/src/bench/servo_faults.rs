//! A servo that restarts under goals, and a gyro that breaks while it balances: how soon it is
//! noticed.

use super::balance::{Source, arm_balance};
use super::{SimulatedCm5, arm};
use handstand_shared::control_table::TORQUE_LIMIT;
use handstand_shared::message::Command;
use handstand_shared::packed::{Positions, SERVOS};

/// Longer than this it was not noticed, ms.
const LONGEST_MS: f64 = 500.0;

/// Streams goals, lets a servo lose its RAM so many ticks after arming, and times until the torque
/// of the others begins to fall, ms; none if it does not.
///
/// # Panics
/// The firmware does not arm, or no servo has this id.
pub fn restart(bench: &mut impl SimulatedCm5, id: u8, phase: u8) -> Option<f64> {
    let goals = Command::Goals(Positions::pack([540; SERVOS]));
    arm(bench);
    for _ in 0..10 + phase {
        bench.send(&goals);
        bench.run_ms(10.0);
    }
    bench.bus().servo(id).expect("18 servos").restart();
    until_it_falls(bench, &goals, id)
}

/// Balances by the gyro, upright and at rest, until the gyro says this code; times until torque
/// begins to fall, or is off, ms; none if it does not.
///
/// # Panics
/// The firmware does not arm.
pub fn gyro_at_rail(bench: &mut impl SimulatedCm5, code: u16) -> Option<f64> {
    let (_, plan) = Source::Gyro.plan();
    arm_balance(bench, &plan).expect("it arms");
    for _ in 0..20 {
        bench.send(&Command::KeepAlive);
        bench.run_ms(10.0);
    }
    bench.set_gyro(code);
    until_it_falls(bench, &Command::KeepAlive, 0)
}

/// Says it every 10 ms until all but this servo have less than all of their torque.
fn until_it_falls(bench: &mut impl SimulatedCm5, say: &Command, but: u8) -> Option<f64> {
    let began_ms = bench.now_ms();
    let mut said_ms = f64::NEG_INFINITY;
    loop {
        let now_ms = bench.now_ms();
        let mut others = bench.bus().servos.iter().filter(|servo| servo.id() != but);
        if others.all(|servo| servo.get(TORQUE_LIMIT) < 1023 || !servo.torque_is_on()) {
            return Some(now_ms - began_ms);
        }
        if now_ms - began_ms > LONGEST_MS {
            return None;
        }
        if now_ms >= said_ms + 10.0 {
            said_ms = now_ms;
            bench.send(say);
        }
        bench.run_ms(0.5);
    }
}
