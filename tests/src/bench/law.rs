//! The laws on the AVR against the laws on the host.

use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::observer::{Memory, Observer};
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
    /// Most cycles at a shift of 8, the other one that the generator chooses.
    pub most_at_8: u64,
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
        most_at_8: 0,
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
            let x = random_words(&mut rng);
            let (u, cycles) = law.control(&x);
            run.states += 1;
            run.different += usize::from(u != control(&table, &x));
            if shift == 16 {
                run.least = run.least.min(cycles);
                run.most = run.most.max(cycles);
            } else if shift == 8 {
                run.most_at_8 = run.most_at_8.max(cycles);
            } else {
                run.most_other = run.most_other.max(cycles);
            }
        }
    }
    run
}

/// An observer on the AVR against the host's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObserverRun {
    /// Memories and readings tried.
    pub states: usize,
    /// How many differ in any bit of wish or memory.
    pub different: usize,
    /// Most cycles from readings to wish, marks included.
    pub wish: u64,
    /// Most cycles of the update, marks included.
    pub learn: u64,
}

/// Compares this observer, then random ones, on random memories, small and extreme; a thousand per observer.
///
/// # Panics
/// As [`law`].
pub fn observer_law(elf: &Path, first: &Observer, states: usize, seed: u64) -> ObserverRun {
    let mut law = Law::load(elf).expect("the law's program loads");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = ObserverRun {
        states: 0,
        different: 0,
        wish: 0,
        learn: 0,
    };
    let mut observer = *first;
    while run.states < states {
        law.set_observer(&observer);
        for _ in 0..1000.min(states - run.states) {
            let mut memory = Memory::of(random_words(&mut rng));
            let (readings, given) = (random_words(&mut rng), random_words(&mut rng));
            let tick = law.tick(&memory, &readings, &given);
            let wish = observer.wish(&mut memory, &readings);
            observer.learn(&mut memory, given);
            run.states += 1;
            run.different += usize::from((wish, memory) != (tick.wish, tick.memory));
            run.wish = run.wish.max(tick.wish_cycles);
            run.learn = run.learn.max(tick.learn_cycles);
        }
        observer = random_observer(first, &mut rng);
    }
    run
}

/// One with other numbers than `like`, and sums as safe.
fn random_observer(like: &Observer, rng: &mut ChaCha8Rng) -> Observer {
    let mut other = *like;
    shuffle(&mut other.expect, rng);
    shuffle(&mut other.feedback, rng);
    shuffle(&mut other.update, rng);
    assert!(other.is_safe(), "rows only change places and signs");
    other
}

fn shuffle<const M: usize, const N: usize>(table: &mut GainTable<M, N>, rng: &mut ChaCha8Rng) {
    for row in &mut table.rows {
        for at in 0..N {
            row.k.swap(at, rng.random_range(0..N));
            row.k[at] = if rng.random() {
                row.k[at]
            } else {
                row.k[at].saturating_neg()
            };
        }
        row.shift = rng.random_range(0..=16);
    }
    table.x0 = random_words(rng);
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

fn random_words<const N: usize>(rng: &mut ChaCha8Rng) -> [i16; N] {
    let extremes = [i16::MIN, -1, 0, 1, i16::MAX];
    match rng.random_range(0..4) {
        0 => [(); N].map(|()| rng.random_range(-100..=100)),
        1 => [(); N].map(|()| *extremes.get(rng.random_range(0..5)).unwrap_or(&0)),
        _ => [(); N].map(|()| rng.random()),
    }
}
