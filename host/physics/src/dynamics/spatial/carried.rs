//! Motions and forces of a link, and the inertia of what its joint carries.

use super::small::{Matrix, Vector, cross, dot, scaled};

/// What turns and what shifts: an acceleration, or a moment and a force.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spatial {
    pub turning: Vector,
    pub shifting: Vector,
}

/// Inertia of what a joint carries: moment = turning * angular + mixed * linear, force = mixed' *
/// angular + shifting * linear, with symmetric `turning` and `shifting`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Carried {
    pub turning: Matrix,
    pub mixed: Matrix,
    pub shifting: Matrix,
}

impl Spatial {
    #[inline(always)]
    pub fn dot(&self, other: &Spatial) -> f64 {
        dot(self.turning, other.turning) + dot(self.shifting, other.shifting)
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Spatial, share: f64) {
        self.turning = self.turning + scaled(other.turning, share);
        self.shifting = self.shifting + scaled(other.shifting, share);
    }

    /// The part along an axis that a joint moves.
    #[inline(always)]
    pub fn along(&self, axis: Vector, slides: bool) -> f64 {
        dot(axis, if slides { self.shifting } else { self.turning })
    }

    /// Adds what a joint moves along its axis.
    #[inline(always)]
    pub fn add_along(&mut self, axis: Vector, slides: bool, by: f64) {
        let part = if slides {
            &mut self.shifting
        } else {
            &mut self.turning
        };
        *part = *part + scaled(axis, by);
    }

    /// An acceleration of a frame, at a point of it that lies `arm` from its origin.
    #[inline(always)]
    pub fn carried_on(&self, arm: Vector) -> Spatial {
        Spatial {
            turning: self.turning,
            shifting: self.shifting + cross(self.turning, arm),
        }
    }

    /// A moment and a force, about a point from which their own lies `arm`.
    #[inline(always)]
    pub fn handed_down(&self, arm: Vector) -> Spatial {
        Spatial {
            turning: self.turning + cross(arm, self.shifting),
            shifting: self.shifting,
        }
    }
}

impl Carried {
    /// Moment and force at an acceleration.
    #[inline(always)]
    pub fn times(&self, a: &Spatial) -> Spatial {
        Spatial {
            turning: self.turning.combined(a.turning) + self.mixed.times(a.shifting),
            shifting: self.mixed.combined(a.turning) + self.shifting.combined(a.shifting),
        }
    }

    /// Moment and force at an acceleration of 1 along an axis, that of a joint.
    #[inline(always)]
    pub fn pull(&self, axis: Vector, slides: bool) -> Spatial {
        if slides {
            Spatial {
                turning: self.mixed.times(axis),
                shifting: self.shifting.combined(axis),
            }
        } else {
            Spatial {
                turning: self.turning.combined(axis),
                shifting: self.mixed.combined(axis),
            }
        }
    }

    /// Takes away what a joint with this pull gives way to.
    #[inline(always)]
    pub fn give_way(&mut self, pull: &Spatial, inverse: f64) {
        let shifting = scaled(pull.shifting, -inverse);
        self.turning
            .add_product(pull.turning, scaled(pull.turning, -inverse));
        self.mixed.add_product(pull.turning, shifting);
        self.shifting.add_product(pull.shifting, shifting);
    }

    /// Adds an inertia whose origin lies `arm` from this one's.
    ///
    /// With [p] the matrix of the cross product by the arm, the shifted one has mixed + [p]
    /// shifting, and turning - z - z', where z = (mixed + [p] shifting / 2) [p].
    #[inline(always)]
    pub fn add_seen(&mut self, own: &Carried, arm: Vector) {
        let reach = own.shifting.crossed_by(arm);
        let mut half = own.mixed;
        for (row, reach) in half.0.iter_mut().zip(&reach.0) {
            *row = cross(arm, *row + scaled(*reach, 0.5));
        }
        self.turning.add(&own.turning);
        self.turning.add(&half);
        self.turning.add(&half.transposed());
        self.mixed.add(&own.mixed);
        self.mixed.add(&reach);
        self.shifting.add(&own.shifting);
    }
}
