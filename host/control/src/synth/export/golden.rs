//! States with the inputs that a right law must give, to check any implementation by.

use crate::synth::FixedLaw;

/// How many vectors there are.
const COUNT: usize = 32;

/// States and the inputs for them, in steps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Golden {
    /// States.
    pub x: Vec<i64>,
    /// Inputs.
    pub u: Vec<i64>,
}

/// The corners of all words, the operating point, and seeded states near and far: the same for the
/// same law.
pub fn golden(law: &FixedLaw) -> Vec<Golden> {
    let most = 1_i64 << (law.bits - 1);
    let mut random = SplitMix(u64::from(law.fingerprint()));
    let n = law.x0.len();
    let mut states = vec![
        law.x0.clone(),
        vec![-most; n],
        vec![most - 1; n],
        vec![0; n],
    ];
    while states.len() < COUNT {
        // From full words down to departures of a few steps.
        let reach = most >> (states.len() % law.bits as usize);
        let near = states.len() % 3 != 0;
        let state = |x0: &i64| {
            let off = random.next().cast_signed() % reach.max(2);
            (if near { x0 + off } else { off }).clamp(-most, most - 1)
        };
        states.push(law.x0.iter().map(state).collect());
    }
    let vector = |x: Vec<i64>| Golden { u: law.raw(&x), x };
    states.into_iter().map(vector).collect()
}

/// Steele, Lea, Flood, OOPSLA 2014.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}
