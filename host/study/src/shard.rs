//! A share of a study's chunks.

use crate::error::Problem;
use std::fmt;
use std::str::FromStr;

/// Shard `index` of `of`, counted from 1: every chunk whose number leaves `index - 1` when divided
/// by `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    pub index: usize,
    /// How many there are.
    pub of: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { index: 1, of: 1 };

    /// Whether this chunk belongs to it.
    pub fn holds(self, chunk: usize) -> bool {
        chunk % self.of == self.index - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Shard {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let wish = || {
            Problem::new(
                format!("`{text}` is no shard: write `2/5` for the second of five"),
                "the first of five is `1/5`, the last `5/5`",
            )
        };
        let (index, of) = text.split_once('/').ok_or_else(wish)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wish());
        let (index, of) = (number(index)?, number(of)?);
        if (1..=of).contains(&index) {
            Ok(Shard { index, of })
        } else {
            Err(wish())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn every_chunk_belongs_to_one_shard() {
        for of in 1..6 {
            for chunk in 0..20 {
                let holders = (1..=of).filter(|&index| Shard { index, of }.holds(chunk));
                assert_eq!(holders.count(), 1);
            }
        }
    }

    #[test]
    fn it_reads_what_it_writes_and_refuses_the_rest() {
        assert_eq!("2/5".parse(), Ok(Shard { index: 2, of: 5 }));
        assert_eq!(Shard { index: 2, of: 5 }.to_string(), "2/5");
        for wrong in ["", "2", "0/3", "4/3", "1/0", "a/b", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
