//! Vectors and matrices of three, in place: nalgebra's products are calls, and a link needs dozens.

/// Three numbers.
pub type Vector = [f64; 3];
/// Three rows.
pub type Matrix = [[f64; 3]; 3];

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
#[derive(Debug, Clone, Copy, Default)]
pub struct Symmetric([f64; 6]);

/// The symmetric matrix of these entries.
#[inline(always)]
pub fn symmetric_of(entry: impl Fn(usize, usize) -> f64) -> Symmetric {
    Symmetric([
        entry(0, 0),
        entry(0, 1),
        entry(0, 2),
        entry(1, 1),
        entry(1, 2),
        entry(2, 2),
    ])
}

impl Symmetric {
    pub fn diagonal(value: f64) -> Self {
        Symmetric([value, 0.0, 0.0, value, 0.0, value])
    }

    #[inline(always)]
    pub fn full(&self) -> Matrix {
        let [xx, xy, xz, yy, yz, zz] = self.0;
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    }

    #[inline(always)]
    pub fn column_2(&self) -> Vector {
        let [_, _, xz, _, yz, zz] = self.0;
        [xz, yz, zz]
    }

    #[inline(always)]
    pub fn times(&self, v: &Vector) -> Vector {
        times(&self.full(), v)
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Symmetric) {
        for (entry, other) in self.0.iter_mut().zip(other.0) {
            *entry += other;
        }
    }

    /// Less `share` times the matrix v v'.
    #[inline(always)]
    pub fn subtract_square(&mut self, v: &Vector, share: f64) {
        let [x, y, z] = *v;
        let [sx, sy, sz] = v.map(|k| k * share);
        let square = [x * sx, x * sy, x * sz, y * sy, y * sz, z * sz];
        for (entry, square) in self.0.iter_mut().zip(square) {
            *entry -= square;
        }
    }

    /// The same in the frame in which its own has these axes.
    #[inline(always)]
    pub fn seen(&self, axes: &Matrix) -> Symmetric {
        let half = product(axes, &self.full());
        symmetric_of(|i, k| dot(&half[i], &axes[k]))
    }
}

#[inline(always)]
pub fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
pub fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] + b[k])
}

/// Adds `share` times `b`.
#[inline(always)]
pub fn add(a: &mut Vector, b: &Vector, share: f64) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b * share;
    }
}

#[inline(always)]
pub fn times(a: &Matrix, v: &Vector) -> Vector {
    a.map(|row| dot(&row, v))
}

#[inline(always)]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|[x, y, z]| std::array::from_fn(|k| x * b[0][k] + y * b[1][k] + z * b[2][k]))
}

/// A vector of a frame with these axes, as its parent has it.
#[inline(always)]
pub fn turned(axes: &Matrix, v: &Vector) -> Vector {
    times(axes, v)
}

/// A vector of the parent, as a frame with these axes has it.
#[inline(always)]
pub fn turned_back(axes: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|k| axes[0][k] * v[0] + axes[1][k] * v[1] + axes[2][k] * v[2])
}
