//! A bench behind a serial port, in real time.

use super::SimulatedCm5;
use handstand::link::Pty;
use std::time::{Duration, Instant};

/// Further behind than this, simulated time stands still for a moment: a program at the port waits
/// some 30 ms for an answer.
const LATE_MS: f64 = 10.0;
/// How often slowness is said, s.
const SAY_EVERY_S: f64 = 5.0;

/// Keeps real time, as far as the machine is fast enough, while `goes_on`; says on stderr when it
/// is not.
///
/// # Errors
/// The port fails.
pub fn serve(
    bench: &mut impl SimulatedCm5,
    pty: &Pty,
    goes_on: impl Fn() -> bool,
) -> Result<(), String> {
    let failed = |error: handstand::Error| error.to_string();
    let began = Instant::now();
    let mut offset_ms = bench.now_ms();
    let mut bytes = [0; 512];
    let (mut skipped_ms, mut said_s) = (0.0, 0.0);
    while goes_on() {
        let behind_ms = began.elapsed().as_secs_f64() * 1e3 + offset_ms - bench.now_ms();
        if behind_ms > LATE_MS {
            offset_ms -= behind_ms - LATE_MS;
            skipped_ms += behind_ms - LATE_MS;
        }
        let now_s = began.elapsed().as_secs_f64();
        if now_s - said_s > SAY_EVERY_S {
            let share = skipped_ms * 1e-3 / (now_s - said_s);
            if share > 0.01 {
                eprintln!(
                    "this machine is too slow: simulated time runs at {:.0} %",
                    100.0 * (1.0 - share)
                );
            }
            (skipped_ms, said_s) = (0.0, now_s);
        }
        let wait = if behind_ms < 1.0 {
            Duration::from_millis(1)
        } else {
            Duration::ZERO
        };
        let count = pty.receive(&mut bytes, wait).map_err(failed)?;
        // A program at another speed understands nothing, nor is it understood.
        let is_heard = (56_000..59_000).contains(&pty.baud());
        if is_heard {
            bench.send_bytes(&bytes[..count]);
        }
        bench.run_ms(behind_ms.clamp(0.1, 5.0));
        if is_heard && !bench.raw().is_empty() {
            pty.send(bench.raw()).map_err(failed)?;
        }
        bench.clear();
    }
    Ok(())
}
