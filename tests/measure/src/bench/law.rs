//! The laws on the AVR against the laws on the host.

use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::observer::{Memory, Observer};
use handstand_simavr::Law;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::path::Path;

/// Shifts that a safe table can have.
pub const SHIFTS: u8 = 31;
/// The shifts that `handstand gains` chooses itself; with `--input-step` it may come to any.
pub const CHOSEN: [u8; 3] = [0, 8, 16];

/// States are shared out to so many controllers, whatever the number of cores, so that a seed
/// always tries the same ones.
const CONTROLLERS: usize = 16;
/// States per table: short of it, a small run would not meet every shift.
const PER_TABLE: usize = 50;

/// Fewest and most cycles, marks included; none where nothing ran.
pub type Cycles = Option<(u64, u64)>;

/// What was compared and counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LawRun {
    /// States tried.
    pub states: usize,
    /// States on which the two disagree in any bit.
    pub different: usize,
    /// Cycles where both inputs have this shift.
    pub cycles: [Cycles; SHIFTS as usize],
    /// Cycles where they have different ones.
    pub mixed: Cycles,
}

impl LawRun {
    const NOTHING: LawRun = LawRun {
        states: 0,
        different: 0,
        cycles: [None; SHIFTS as usize],
        mixed: None,
    };

    /// Cycles over these shifts, if all of them ran.
    pub fn over(&self, shifts: impl IntoIterator<Item = u8>) -> Cycles {
        let each = shifts
            .into_iter()
            .map(|shift| self.cycles[usize::from(shift)]);
        each.reduce(|a, b| union(a.filter(|_| b.is_some()), b.filter(|_| a.is_some())))
            .flatten()
    }

    fn with(self, other: LawRun) -> LawRun {
        LawRun {
            states: self.states + other.states,
            different: self.different + other.different,
            cycles: std::array::from_fn(|at| union(self.cycles[at], other.cycles[at])),
            mixed: union(self.mixed, other.mixed),
        }
    }
}

fn union(one: Cycles, other: Cycles) -> Cycles {
    match (one, other) {
        (Some(one), Some(other)) => Some((one.0.min(other.0), one.1.max(other.1))),
        (one, other) => one.or(other),
    }
}

/// Numbers of states for each controller, with the seeds of their chance.
fn shares(states: usize, seed: u64) -> Vec<(usize, u64)> {
    let share = |at: usize| (states * (at + 1) / CONTROLLERS) - states * at / CONTROLLERS;
    let seeds = (0..).map(|at| seed.wrapping_mul(CONTROLLERS as u64).wrapping_add(at));
    (0..CONTROLLERS).map(share).zip(seeds).collect()
}

/// Compares on random tables and states, small and extreme. Every shift has its turn in both inputs
/// at once, then every one beside a random one.
///
/// # Panics
/// The program cannot be loaded, or does not answer.
pub fn law(elf: &Path, states: usize, seed: u64) -> LawRun {
    let runs = shares(states, seed).into_par_iter().enumerate();
    runs.map(|(at, (states, seed))| law_share(elf, states, seed, at))
        .reduce(|| LawRun::NOTHING, LawRun::with)
}

fn law_share(elf: &Path, states: usize, seed: u64, first: usize) -> LawRun {
    let mut law = Law::load(elf).expect("the law's program loads");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = LawRun::NOTHING;
    // One controller begins where the one before it would in a small run.
    let mut turn = first * states.div_ceil(PER_TABLE);
    while run.states < states {
        let shift = (turn % usize::from(SHIFTS)) as u8;
        let other = match turn / usize::from(SHIFTS) % 2 {
            0 => shift,
            _ => rng.random_range(0..SHIFTS),
        };
        turn += 1;
        let table = random_table([shift, other], &mut rng);
        law.set(&table);
        for _ in 0..PER_TABLE.min(states - run.states) {
            let x = random_state(&table, &mut rng);
            let (u, cycles) = law.control(&x);
            run.states += 1;
            run.different += usize::from(u != control(&table, &x));
            let place = if shift == other {
                &mut run.cycles[usize::from(shift)]
            } else {
                &mut run.mixed
            };
            *place = union(*place, Some((cycles, cycles)));
        }
    }
    run
}

/// An observer on the AVR against the host's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObserverRun {
    /// Memories and readings tried.
    pub states: usize,
    /// How many differ in any bit of raw command or memory.
    pub different: usize,
    /// Most cycles from readings to raw command, marks included.
    pub raw_command: u64,
    /// Most cycles of the update, marks included.
    pub update: u64,
}

impl ObserverRun {
    const NOTHING: ObserverRun = ObserverRun {
        states: 0,
        different: 0,
        raw_command: 0,
        update: 0,
    };

    fn with(self, other: ObserverRun) -> ObserverRun {
        ObserverRun {
            states: self.states + other.states,
            different: self.different + other.different,
            raw_command: self.raw_command.max(other.raw_command),
            update: self.update.max(other.update),
        }
    }
}

/// Compares this observer, then random ones, on random memories, small and extreme; at most a
/// thousand per observer.
///
/// # Panics
/// As [`law`].
pub fn observer_law(elf: &Path, first: &Observer, states: usize, seed: u64) -> ObserverRun {
    shares(states, seed)
        .into_par_iter()
        .map(|(states, seed)| observer_share(elf, first, states, seed))
        .reduce(|| ObserverRun::NOTHING, ObserverRun::with)
}

fn observer_share(elf: &Path, first: &Observer, states: usize, seed: u64) -> ObserverRun {
    let mut law = Law::load(elf).expect("the law's program loads");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = ObserverRun::NOTHING;
    let mut observer = *first;
    // Half of a small run is left for a second one.
    let each = states.div_ceil(2).clamp(1, 1000);
    while run.states < states {
        law.set_observer(&observer);
        for _ in 0..each.min(states - run.states) {
            let mut memory = Memory::of(random_words(&mut rng));
            let (readings, applied) = (random_words(&mut rng), random_words(&mut rng));
            let tick = law.tick(&memory, &readings, &applied);
            let raw_command = observer.raw_command(&mut memory, &readings);
            observer.update(&mut memory, applied);
            run.states += 1;
            let here = (raw_command, memory.all());
            run.different += usize::from(here != (tick.raw_command, tick.memory.all()));
            run.raw_command = run.raw_command.max(tick.command_cycles);
            run.update = run.update.max(tick.update_cycles);
        }
        observer = random_observer(first, &mut rng);
    }
    run
}

/// One with other numbers than `like`, and sums as safe.
fn random_observer(like: &Observer, rng: &mut ChaCha8Rng) -> Observer {
    let mut other = *like;
    shuffle(&mut other.predict, rng);
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
        row.shift = rng.random_range(0..SHIFTS);
    }
    table.x0 = random_words(rng);
}

fn random_table(shift: [u8; 2], rng: &mut ChaCha8Rng) -> GainTable<2, 6> {
    loop {
        // Small gains too, whose sums need no limits at short shifts.
        let small = rng.random_range(0..15);
        let k = [(); 2].map(|()| [(); 6].map(|()| rng.random_range(-10_900..=10_900) >> small));
        let bias = [(); 2].map(|()| rng.random_range(-(1 << 28)..1 << 28) >> small);
        let limits = [(); 2].map(|()| {
            let (a, b): (i16, i16) = (rng.random(), rng.random());
            // A longer shift leaves smaller inputs.
            let room = rng.random_range(0..15);
            [a.min(b) >> room, a.max(b) >> room]
        });
        let table = GainTable::new(k, bias, shift, limits, random_words(rng));
        if table.is_safe() {
            return table;
        }
    }
}

/// Now and then one whose departures all overflow, where `x0` lets them.
fn random_state(table: &GainTable<2, 6>, rng: &mut ChaCha8Rng) -> [i16; 6] {
    match rng.random_range(0..4) {
        0 => table.x0.map(|x0| if x0 < 0 { i16::MAX } else { i16::MIN }),
        _ => random_words(rng),
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
