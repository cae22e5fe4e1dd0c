//! What must happen when the link falls silent, and when the controller hangs.

use super::SimulatedCm5;
use handstand_shared::control_table::TORQUE_LIMIT;
use handstand_shared::message::{ArmLimits, Command, Mode, Refusal, Report, VERSION};
#[cfg(simavr)]
use handstand_shared::packed::{Positions, SERVOS};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Times after the last frame arrived, or after the hang, ms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    /// Until the torque limit began to fall.
    pub soft_ms: f64,
    /// Until torque was off in every servo.
    pub off_ms: f64,
}

/// The worst of many.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// How many were tried.
    pub tried: usize,
    /// How many never came to an end as they must.
    pub failed: usize,
    /// The worst times, ms.
    pub soft_ms: f64,
    /// The worst times, ms.
    pub off_ms: f64,
}

impl Worst {
    /// Counts one in.
    pub fn add(&mut self, loss: Option<Loss>) {
        self.tried += 1;
        match loss {
            Some(loss) => {
                self.soft_ms = self.soft_ms.max(loss.soft_ms);
                self.off_ms = self.off_ms.max(loss.off_ms);
            }
            None => self.failed += 1,
        }
    }
}

impl Worst {
    /// Both together.
    fn and(self, other: Worst) -> Worst {
        Worst {
            tried: self.tried + other.tried,
            failed: self.failed + other.failed,
            soft_ms: self.soft_ms.max(other.soft_ms),
            off_ms: self.off_ms.max(other.off_ms),
        }
    }
}

/// Tries `count` times, in parallel, ten times each on a bench of its own, and says on stderr how
/// far it is.
pub fn worst_of<B>(
    count: usize,
    seed: u64,
    new: impl Fn() -> B + Sync,
    one: impl Fn(&mut B, &mut ChaCha8Rng) -> Option<Loss> + Sync,
) -> Worst {
    const EACH: usize = 10;
    let done = AtomicUsize::new(0);
    let of_bench = |from: usize| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(from as u64);
        let mut bench = new();
        let mut worst = Worst::default();
        for _ in from..count.min(from + EACH) {
            worst.add(one(&mut bench, &mut rng));
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if done.is_multiple_of(50) {
                eprintln!("  {done} of {count}");
            }
        }
        worst
    };
    (0..count)
        .into_par_iter()
        .step_by(EACH)
        .map(of_bench)
        .reduce(Worst::default, Worst::and)
}

/// Greets, streams and arms; panics with the reason if refused.
pub fn arm(bench: &mut impl SimulatedCm5) {
    let outcome = try_arm(bench);
    assert_eq!(outcome, Ok(()), "arming");
}

pub(super) fn try_arm(bench: &mut impl SimulatedCm5) -> Result<(), Option<Refusal>> {
    // Until the controller has started.
    bench.run_ms(10.0);
    bench.clear();
    bench.send(&Command::Hello { version: VERSION });
    let token = awaited(bench, |report| match report {
        Report::Hello(hello) => Some(hello.token),
        _ => None,
    });
    let token = token.ok_or(None)?;
    bench.send(&Command::Mode(Mode::Stream));
    // Two rounds of the housekeeping, until the supply is known.
    for _ in 0..25 {
        bench.send(&Command::KeepAlive);
        bench.run_ms(10.0);
    }
    let sequence = bench.send(&Command::Arm {
        token,
        limits: ArmLimits::FULL,
    });
    let answer = awaited(bench, |report| match report {
        Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
        _ => None,
    });
    answer.ok_or(None)?.map_err(Some)
}

/// The first report of this kind; answers wait behind a report of every tick.
fn awaited<T>(bench: &mut impl SimulatedCm5, kind: impl Fn(Report) -> Option<T>) -> Option<T> {
    // Arming takes 30 ticks where a servo cannot be read.
    for _ in 0..60 {
        bench.run_ms(10.0);
        if let Some(found) = bench
            .reports()
            .into_iter()
            .find_map(|(_, report)| kind(report))
        {
            return Some(found);
        }
    }
    None
}

/// Cuts the link at a random moment, possibly inside a frame, and times what follows.
pub fn link_loss(bench: &mut impl SimulatedCm5, rng: &mut ChaCha8Rng) -> Option<Loss> {
    arm(bench);
    let frames = rng.random_range(1..20);
    for _ in 0..frames {
        bench.send(&Command::KeepAlive);
        bench.run_ms(10.0);
    }
    bench.run_ms(rng.random_range(0.0..10.0));
    bench.send(&Command::KeepAlive);
    // 7 bytes at 57600 baud.
    bench.run_ms(7.0 * 0.1736);
    // A frame that never ends must not count.
    bench.send_bytes(&[5, 1, 1][..rng.random_range(0..3)]);
    let started = bench.now_ms();
    let mut soft_ms = None;
    while bench.now_ms() - started < 1000.0 {
        bench.run_ms(1.0);
        let after = bench.now_ms() - started;
        let bus = bench.bus();
        if soft_ms.is_none()
            && bus
                .servos
                .iter()
                .all(|servo| servo.get(TORQUE_LIMIT) < 1023)
        {
            soft_ms = Some(after);
        }
        if !bus.any_torque() {
            bench.send_bytes(&[0]);
            return soft_ms.map(|soft_ms| Loss {
                soft_ms,
                off_ms: after,
            });
        }
    }
    None
}

/// Lets the controller hang at a random instruction, and times until torque is off on the wire. The
/// host goes on saying goals all the while: its bytes meet the boot loader, if there is one.
#[cfg(simavr)]
pub fn hang(rig: &mut handstand_simavr::ElfCm5, rng: &mut ChaCha8Rng) -> Option<Loss> {
    arm(rig);
    for _ in 0..3 {
        rig.send(&Command::KeepAlive);
        rig.run_ms(10.0);
    }
    rig.run_ms(rng.random_range(0.0..20.0));
    // The instruction that is next is replaced by a jump to itself.
    let at = rig.core.pc() as usize;
    let kept = [rig.core.flash()[at], rig.core.flash()[at + 1]];
    rig.core.flash()[at..at + 2].copy_from_slice(&[0xff, 0xcf]);
    let (resets, started) = (rig.seen.resets.len(), rig.now_ms());
    rig.bus.torque_offs.clear();
    let mut reset = false;
    let mut said_ms = started;
    while rig.now_ms() - started < 1000.0 {
        if rig.now_ms() >= said_ms + 10.0 {
            said_ms = rig.now_ms();
            let goals = [(); SERVOS].map(|()| rng.random_range(0..1024));
            rig.send(&Command::Goals(Positions::pack(goals)));
        }
        rig.run_ms(0.05);
        if !reset && rig.seen.resets.len() > resets {
            reset = true;
            rig.core.flash()[at..at + 2].copy_from_slice(&kept);
        }
        if reset && !rig.bus.any_torque() && !rig.bus.torque_offs.is_empty() {
            let off_ms = rig.now_ms() - started;
            // It must stay off, whatever the host goes on saying.
            for _ in 0..30 {
                rig.send(&Command::KeepAlive);
                rig.run_ms(10.0);
            }
            let stays = !rig.bus.any_torque();
            return stays.then_some(Loss {
                soft_ms: 0.0,
                off_ms,
            });
        }
    }
    None
}
