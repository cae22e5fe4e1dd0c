//! Vectors and matrices of three, each row in a register of four numbers: a link needs dozens of
//! products of them, and one instruction then serves a row.
//!
//! Rest on it in `cargo xtask peers`: the rows "forward dynamics in space".

use crate::dynamics::lanes::{Lane, Lanes, each};

/// Three numbers; the fourth means nothing.
pub type Vector = Lanes<4>;

/// Three rows.
#[derive(Debug, Clone, Copy, Default)]
pub struct Matrix(pub [Vector; 3]);

#[inline(always)]
pub fn vector([x, y, z]: [f64; 3]) -> Vector {
    Lanes([x, y, z, 0.0])
}

#[inline(always)]
pub fn dot(a: Vector, b: Vector) -> f64 {
    let [x, y, z, _] = (a * b).0;
    x + y + z
}

#[inline(always)]
pub fn scaled(a: Vector, by: f64) -> Vector {
    a * Lanes::splat(by)
}

/// y, z, x.
#[inline(always)]
fn turned_on(Lanes([x, y, z, rest]): Vector) -> Vector {
    Lanes([y, z, x, rest])
}

#[inline(always)]
pub fn cross(a: Vector, b: Vector) -> Vector {
    turned_on(a * turned_on(b) - turned_on(a) * b)
}

impl Matrix {
    /// The matrix of the cross product by a vector: what it is multiplied with stands on the right.
    #[inline(always)]
    pub fn crossing(Lanes([x, y, z, _]): Vector) -> Matrix {
        Matrix([
            vector([0.0, -z, y]),
            vector([z, 0.0, -x]),
            vector([-y, x, 0.0]),
        ])
    }

    #[inline(always)]
    pub fn diagonal(value: f64) -> Matrix {
        Matrix([
            vector([value, 0.0, 0.0]),
            vector([0.0, value, 0.0]),
            vector([0.0, 0.0, value]),
        ])
    }

    /// Rows as columns.
    #[inline(always)]
    pub fn transposed(&self) -> Matrix {
        let [x, y, z] = self.0;
        Matrix(each(|i| Lanes([x.0[i], y.0[i], z.0[i], x.0[i]])))
    }

    /// The rows, each as often as the vector says: the product of the transposed matrix; where the
    /// rows are a frame's axes, a vector of the frame as its parent has it; of a symmetric matrix
    /// the product.
    #[inline(always)]
    pub fn combined(&self, v: Vector) -> Vector {
        let [x, y, z] = self.0;
        scaled(x, v.0[0]) + scaled(y, v.0[1]) + scaled(z, v.0[2])
    }

    /// The product with a vector.
    #[inline(always)]
    pub fn times(&self, v: Vector) -> Vector {
        let [x, y, z] = Matrix(self.0.map(|row| row * v)).transposed().0;
        x + y + z
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Matrix) {
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            *own = *own + *other;
        }
    }

    /// Adds the products of a column and a row.
    #[inline(always)]
    pub fn add_product(&mut self, column: Vector, row: Vector) {
        for (own, entry) in self.0.iter_mut().zip(column.0) {
            *own = *own + scaled(row, entry);
        }
    }

    /// The cross product by a vector, times this one.
    #[inline(always)]
    pub fn crossed_by(&self, by: Vector) -> Matrix {
        let ([a, b, c], Lanes([x, y, z, _])) = (self.0, by);
        Matrix([
            scaled(c, y) - scaled(b, z),
            scaled(a, z) - scaled(c, x),
            scaled(b, x) - scaled(a, y),
        ])
    }
}
