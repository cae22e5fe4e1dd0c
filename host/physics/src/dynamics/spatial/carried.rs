//! Motions and forces of a link, and the inertia of what its joint carries.

use super::small::{
    Matrix, Symmetric, Vector, add, cross, dot, plus, product, product_transposed, scaled, times,
    times_transposed, transposed,
};

/// What turns and what shifts: a speed, an acceleration, or a moment and a force.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spatial {
    pub turning: Vector,
    pub shifting: Vector,
}

/// Inertia of what a joint carries: moment = turning * angular + mixed * linear, force = mixed' *
/// angular + shifting * linear.
#[derive(Debug, Clone, Copy, Default)]
pub struct Carried {
    pub turning: Symmetric,
    pub mixed: Matrix,
    pub shifting: Symmetric,
}

impl Spatial {
    #[inline(always)]
    pub fn dot(&self, other: &Spatial) -> f64 {
        dot(&self.turning, &other.turning) + dot(&self.shifting, &other.shifting)
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Spatial, share: f64) {
        add(&mut self.turning, &other.turning, share);
        add(&mut self.shifting, &other.shifting, share);
    }

    /// The part that a joint moves.
    #[inline(always)]
    pub fn along(&mut self, slides: bool) -> &mut f64 {
        if slides {
            &mut self.shifting[2]
        } else {
            &mut self.turning[2]
        }
    }
}

impl Carried {
    #[inline(always)]
    pub fn times(&self, a: &Spatial) -> Spatial {
        Spatial {
            turning: plus(
                self.turning.times(&a.turning),
                times(&self.mixed, &a.shifting),
            ),
            shifting: plus(
                times_transposed(&self.mixed, &a.turning),
                self.shifting.times(&a.shifting),
            ),
        }
    }

    /// Takes away what the joint gives way to.
    #[inline(always)]
    pub fn give_way(&mut self, pull: &Spatial, inverse: f64) {
        self.turning.subtract_square(&pull.turning, inverse);
        self.shifting.subtract_square(&pull.shifting, inverse);
        let [x, y, z] = &mut self.mixed;
        let given = scaled(&pull.shifting, -inverse);
        add(x, &given, pull.turning[0]);
        add(y, &given, pull.turning[1]);
        add(z, &given, pull.turning[2]);
    }

    /// Adds the inertia of a link with these axes and this origin.
    #[inline(always)]
    pub fn add_seen(&mut self, own: &Carried, axes: &Matrix, p: &Vector) {
        let turning = own.turning.seen(axes);
        let mixed = product_transposed(&product(axes, &own.mixed), axes);
        let shifting = own.shifting.seen(axes);
        // With [p] the matrix of the cross product by the origin: [p] a crosses a's columns, which
        // are the rows of a symmetric one, and a [p] crosses a's rows with p.
        let [x, y, z] = shifting.full();
        let reach = transposed(&[cross(p, &x), cross(p, &y), cross(p, &z)]);
        let crossed = [
            cross(&mixed[0], p),
            cross(&mixed[1], p),
            cross(&mixed[2], p),
        ];
        let reached = [
            cross(&reach[0], p),
            cross(&reach[1], p),
            cross(&reach[2], p),
        ];
        self.turning.add(&turning);
        self.turning.add(&Symmetric([
            -2.0 * crossed[0][0] - reached[0][0],
            -(crossed[0][1] + crossed[1][0]) - reached[0][1],
            -(crossed[0][2] + crossed[2][0]) - reached[0][2],
            -2.0 * crossed[1][1] - reached[1][1],
            -(crossed[1][2] + crossed[2][1]) - reached[1][2],
            -2.0 * crossed[2][2] - reached[2][2],
        ]));
        let [a, b, c] = &mut self.mixed;
        add(a, &plus(mixed[0], reach[0]), 1.0);
        add(b, &plus(mixed[1], reach[1]), 1.0);
        add(c, &plus(mixed[2], reach[2]), 1.0);
        self.shifting.add(&shifting);
    }
}
