//! Where within a step something crosses zero.

/// What crosses zero within a step, and where.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// Share of the step after which it does.
    pub share: f64,
    /// What it is at the beginning and at the end of the step.
    ends: [f64; 2],
}

impl Crossing {
    /// By a straight line between the ends; at the step's end where they are the same.
    pub fn between(ends: [f64; 2]) -> Crossing {
        let [before, after] = ends;
        let share = if before == after {
            1.0
        } else {
            (before / (before - after)).clamp(0.0, 1.0)
        };
        Crossing { share, ends }
    }

    /// By the parabola through the ends and what was found at the share so far.
    pub fn bent(self, found: f64) -> Crossing {
        let [before, after] = self.ends;
        let share = self.share;
        // before + slope s + bend s^2
        let bend = ((found - before) / share - (after - before)) / (share - 1.0);
        let slope = after - before - bend;
        let root = (slope * slope - 4.0 * bend * before).sqrt();
        let better = -2.0 * before / (slope + root.copysign(slope));
        if (0.0..=1.0).contains(&better) {
            Crossing {
                share: better,
                ..self
            }
        } else {
            self
        }
    }
}
