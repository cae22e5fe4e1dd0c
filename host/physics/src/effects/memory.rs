//! What effects remember: each names its own numbers, which are kept in cells of one size.

/// Room for what an effect remembers from one step of a simulation to the next. What its numbers
/// are, the effect says by a type of its own, with `remembered!`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(transparent)]
pub struct MemoryCell(pub(super) [f64; 2]);

impl MemoryCell {
    /// Of what remembers nothing.
    pub const EMPTY: MemoryCell = MemoryCell([0.0; 2]);
}

/// Has a type of one or two numbers kept in a [`MemoryCell`].
macro_rules! remembered {
    ($name:ident { $first:ident $(, $second:ident)? }) => {
        impl From<$crate::effects::MemoryCell> for $name {
            #[inline]
            fn from(cell: $crate::effects::MemoryCell) -> Self {
                let [$first, _second] = cell.0;
                $name { $first $(, $second: _second)? }
            }
        }

        impl From<$name> for $crate::effects::MemoryCell {
            #[inline]
            fn from(of: $name) -> Self {
                let cell = [of.$first, 0.0];
                $(let cell = [cell[0], of.$second];)?
                $crate::effects::MemoryCell(cell)
            }
        }
    };
}
pub(super) use remembered;

/// The input that a drive has come to obey; not a number before the first, which is obeyed at once.
pub(super) struct Obeyed {
    pub input: f64,
}
remembered!(Obeyed { input });

/// A body beside the links: the motor of a gear that gives, as seen at its joint and relative to
/// it, or a base that gives way, along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// rad, or m; not a number where nothing is known of it.
    pub place: f64,
    /// rad/s, or m/s.
    pub speed: f64,
}
remembered!(BodyState { place, speed });

impl BodyState {
    /// Nothing earlier is known of it.
    pub const UNKNOWN: BodyState = BodyState {
        place: f64::NAN,
        speed: f64::NAN,
    };

    /// Whether anything is known of it.
    pub fn is_known(self) -> bool {
        !self.place.is_nan()
    }
}

/// What a sensor remembers from one reading to the next. In rad, of a sensor of rates in rad/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SenseMemory {
    /// What was encoded.
    pub encoded: f64,
    /// What was read.
    pub reading: f64,
    /// How fast what is encoded draws away from the reading where the past decides, rad/s.
    pub draws_away_rad_s: f64,
    /// Speed of the sensor's own shaft, where it turns apart from the joint, rad/s.
    pub shaft_rad_s: Option<f64>,
}

impl SenseMemory {
    /// Of a sensor whose reading is all there is to remember.
    pub fn reads(reading: f64, encoded: f64) -> SenseMemory {
        SenseMemory {
            encoded,
            reading,
            ..SenseMemory::default()
        }
    }

    /// How far what is encoded is ahead of the reading, rad, and how fast it draws away, rad/s.
    pub fn ahead_rad(&self) -> [f64; 2] {
        [self.encoded - self.reading, self.draws_away_rad_s]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_gives_back_what_was_put_into_it() {
        #[derive(Debug, PartialEq, Clone, Copy)]
        struct One {
            number: f64,
        }
        remembered!(One { number });
        let one = One { number: -0.5 };
        assert_eq!(One::from(MemoryCell::from(one)), one);
        let two = BodyState {
            place: 0.25,
            speed: -3.0,
        };
        assert_eq!(BodyState::from(MemoryCell::from(two)), two);
        assert!(two.is_known());
        assert!(!BodyState::from(MemoryCell::from(BodyState::UNKNOWN)).is_known());
    }
}
