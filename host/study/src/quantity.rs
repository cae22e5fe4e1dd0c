//! Everything of a case that can be varied, level by level, or drawn for every run.

use super::case::Case;
use super::quantities::QUANTITIES;
use crate::sim::closed_loop::{normal, stream};
use rand::Rng as _;

/// Something of a case that can be varied.
#[derive(Debug)]
pub struct Quantity {
    /// Name on the command line and in study files.
    pub id: &'static str,
    /// Name for people, lower case.
    pub title: &'static str,
    /// What it is, in a sentence.
    pub meaning: &'static str,
    /// How a sweep varies it.
    pub levels: Option<Levels>,
    /// How it is uncertain.
    pub spread: Option<Spread>,
}

/// The levels of a sweep.
#[derive(Debug)]
pub struct Levels {
    /// Unit; empty for none.
    pub unit: &'static str,
    /// Tried if no others are asked for.
    pub values: &'static [f64],
    /// Lowest and highest level there can be.
    pub bounds: (f64, f64),
    /// Sets a level.
    pub set: fn(&mut Case, f64),
    /// A level as people read it.
    pub label: fn(f64) -> String,
}

/// How an uncertain quantity is drawn.
#[derive(Debug)]
pub struct Spread {
    /// Unit of its size.
    pub unit: &'static str,
    /// What is drawn.
    pub drawn: &'static str,
    /// What has it.
    pub place: SpreadOver,
    pub(super) apply: fn(&mut Case, usize, f64),
}

/// What has a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpreadOver {
    /// Every link, or the joint before it, its own.
    Link,
    /// The robot.
    Whole,
}

/// The quantity of this id; `_` and `-` are the same.
pub fn quantity(id: &str) -> Option<&'static Quantity> {
    let plain = |id: &str| id.replace('_', "-");
    QUANTITIES.iter().find(|q| plain(q.id) == plain(id))
}

/// Quantities that a sweep varies, with their levels.
pub fn sweeps() -> impl Iterator<Item = (&'static Quantity, &'static Levels)> {
    QUANTITIES
        .iter()
        .filter_map(|quantity| Some((quantity, quantity.levels.as_ref()?)))
}

/// How a value is distributed about nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// Evenly within the size to either side.
    Uniform,
    /// Normal, the size being the standard deviation.
    Normal,
}

/// One quantity, drawn for every run.
#[derive(Debug, Clone, Copy)]
pub struct Uncertain {
    /// What.
    pub quantity: &'static Quantity,
    /// How it is applied.
    pub spread: &'static Spread,
    /// Of which link, from 0.
    pub link: Option<usize>,
    /// How it is distributed.
    pub distribution: Distribution,
    /// How widely, in the spread's unit.
    pub size: f64,
}

impl Uncertain {
    /// A quantity, uniform within `size`, on each link of `links` that has it of its own.
    pub fn uniform(id: &str, size: f64, links: usize) -> Vec<Uncertain> {
        let Some((quantity, spread)) = quantity(id).and_then(|q| Some((q, q.spread.as_ref()?)))
        else {
            return Vec::new();
        };
        let one = |link: Option<usize>| Uncertain {
            quantity,
            spread,
            link,
            distribution: Distribution::Uniform,
            size,
        };
        match spread.place {
            SpreadOver::Whole => vec![one(None)],
            SpreadOver::Link => (0..links).map(|link| one(Some(link))).collect(),
        }
    }

    /// Its column: `mass:1`, `supply:all`.
    pub fn column(&self) -> String {
        match self.link {
            Some(link) => format!("{}:{}", self.quantity.id, link + 1),
            None => format!("{}:all", self.quantity.id),
        }
    }

    /// The value of run `run`. It depends on the column alone, so that runs of other studies with
    /// the same seed meet the same value.
    pub fn draw(&self, seed: u64, run: u64) -> f64 {
        // FNV-1a of the column tells the streams apart.
        let hash = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let own = self.column().bytes().fold(0xcbf2_9ce4_8422_2325, hash);
        let mut rng = stream(seed ^ own, run);
        self.size
            * match self.distribution {
                Distribution::Uniform => rng.random_range(-1.0..=1.0),
                Distribution::Normal => normal(&mut rng),
            }
    }

    /// Gives the case this value.
    pub fn apply(&self, case: &mut Case, value: f64) {
        (self.spread.apply)(case, self.link.unwrap_or(0), value);
    }
}
