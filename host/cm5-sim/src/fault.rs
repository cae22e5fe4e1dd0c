//! Faults of a simulated servo's replies.

use rand::Rng as _;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// Faults of one servo; probabilities are per reply, 0 to 1.
#[derive(Debug, Clone)]
pub struct Faults {
    /// The servo is absent.
    pub dead: bool,
    /// A reply is lost.
    pub drop: f64,
    /// One bit of a reply is flipped.
    pub flip: f64,
    /// A reply is late ...
    pub late: f64,
    /// ... by this much, ns.
    pub late_ns: u64,
    /// A reply carries another servo's id.
    pub wrong_id: f64,
    /// A request reaches it corrupted: it does nothing and reports a checksum error.
    pub corrupt_request: f64,
    /// It answers and obeys no write.
    pub ignore_writes: bool,
    /// Time it needs for a write, ns: one that begins before is ignored.
    pub write_ns: u64,
    /// A byte that no servo sent comes before a reply, as from a line that turns round.
    pub stray: f64,
    /// The wiring sends the controller's own bytes back.
    pub echo: bool,
    rng: ChaCha8Rng,
}

impl Faults {
    /// No faults; `seed` draws those that are switched on later.
    pub fn none(seed: u64) -> Self {
        Faults {
            dead: false,
            drop: 0.0,
            flip: 0.0,
            late: 0.0,
            late_ns: 1_000_000,
            wrong_id: 0.0,
            corrupt_request: 0.0,
            ignore_writes: false,
            write_ns: 0,
            stray: 0.0,
            echo: false,
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// Apply the faults to a reply: its bytes and extra delay, ns; `None` when it is lost.
    pub fn pass(&mut self, answer: Vec<u8>) -> Option<(Vec<u8>, u64)> {
        self.pass_as(answer, |answer| {
            answer[2] = answer[2].wrapping_add(1) % 254;
            let last = answer.len() - 1;
            let sum = answer[2..last]
                .iter()
                .fold(0u8, |sum, byte| sum.wrapping_add(*byte));
            answer[last] = !sum;
        })
    }

    /// The same with `another`, which gives the reply another servo's id: a sound packet, whose
    /// check fits.
    pub(super) fn pass_as(
        &mut self,
        mut answer: Vec<u8>,
        another: impl Fn(&mut Vec<u8>),
    ) -> Option<(Vec<u8>, u64)> {
        if self.dead || self.happens(self.drop) {
            return None;
        }
        if self.happens(self.wrong_id) {
            another(&mut answer);
        }
        if self.happens(self.flip) {
            let bit = self.rng.random_range(0..answer.len() * 8);
            answer[bit / 8] ^= 1 << (bit % 8);
        }
        if self.happens(self.stray) {
            answer.insert(0, self.rng.random());
        }
        let late_ns = if self.happens(self.late) {
            self.late_ns
        } else {
            0
        };
        Some((answer, late_ns))
    }

    /// Whether the next request arrives corrupted.
    pub(super) fn corrupts_request(&mut self) -> bool {
        self.happens(self.corrupt_request)
    }

    fn happens(&mut self, probability: f64) -> bool {
        probability > 0.0 && self.rng.random_bool(probability.min(1.0))
    }
}
