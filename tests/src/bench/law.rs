//! The law on the AVR against the law on the host.

use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_simavr::Law;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::path::Path;

/// What was compared and counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LawRun {
    /// States tried.
    pub states: usize,
    /// States on which the two disagree in any bit.
    pub different: usize,
    /// Fewest cycles at a shift of 16, marks included.
    pub least: u64,
    /// Most cycles at a shift of 16, marks included.
    pub most: u64,
    /// Most cycles at any other shift.
    pub most_other: u64,
}

/// Compares on random tables and states, small and extreme; a thousand states per table.
///
/// # Panics
/// The program cannot be loaded, or does not answer.
pub fn law(elf: &Path, states: usize, seed: u64) -> LawRun {
    let mut law = Law::load(elf).expect("the law's program loads");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = LawRun {
        states: 0,
        different: 0,
        least: u64::MAX,
        most: 0,
        most_other: 0,
    };
    while run.states < states {
        // Most tables have the shift that costs nothing.
        let shift = *[16, 16, 16, 8, 0, 13]
            .get(rng.random_range(0..6))
            .unwrap_or(&16);
        let table = random_table(shift, &mut rng);
        law.set(&table);
        for _ in 0..1000.min(states - run.states) {
            let x = random_state(&mut rng);
            let (u, cycles) = law.control(&x);
            run.states += 1;
            run.different += usize::from(u != control(&table, &x));
            if shift == 16 {
                run.least = run.least.min(cycles);
                run.most = run.most.max(cycles);
            } else {
                run.most_other = run.most_other.max(cycles);
            }
        }
    }
    run
}

fn random_table(shift: u8, rng: &mut ChaCha8Rng) -> GainTable<2, 6> {
    loop {
        let k = [(); 2].map(|()| [(); 6].map(|()| rng.random_range(-10_900..=10_900)));
        let bias = [(); 2].map(|()| rng.random_range(-(1 << 28)..1 << 28));
        let limits = [(); 2].map(|()| {
            let (a, b): (i16, i16) = (rng.random(), rng.random());
            [a.min(b), a.max(b)]
        });
        let x0 = [(); 6].map(|()| rng.random());
        let table = GainTable::new(k, bias, [shift; 2], limits, x0);
        if table.is_safe() {
            return table;
        }
    }
}

fn random_state(rng: &mut ChaCha8Rng) -> [i16; 6] {
    match rng.random_range(0..4) {
        0 => [(); 6].map(|()| rng.random_range(-100..=100)),
        1 => [(); 6].map(|()| {
            *[i16::MIN, -1, 0, 1, i16::MAX]
                .get(rng.random_range(0..5))
                .unwrap_or(&0)
        }),
        _ => [(); 6].map(|()| rng.random()),
    }
}
