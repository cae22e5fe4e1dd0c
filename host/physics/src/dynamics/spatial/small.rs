//! Vectors and matrices of three, in place, entry by entry: nalgebra's products and the closures of
//! arrays are calls where the compiler does not see through them, and a link needs dozens.

/// Three numbers.
pub type Vector = [f64; 3];
/// Three rows.
pub type Matrix = [[f64; 3]; 3];

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
#[derive(Debug, Clone, Copy, Default)]
pub struct Symmetric(pub [f64; 6]);

impl Symmetric {
    pub fn diagonal(value: f64) -> Self {
        Symmetric([value, 0.0, 0.0, value, 0.0, value])
    }

    /// Of a matrix that is symmetric: the entries above its diagonal.
    #[inline(always)]
    pub fn of(full: &Matrix) -> Self {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = *full;
        Symmetric([xx, xy, xz, yy, yz, zz])
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
        let [xx, xy, xz, yy, yz, zz] = other.0;
        let own = &mut self.0;
        own[0] += xx;
        own[1] += xy;
        own[2] += xz;
        own[3] += yy;
        own[4] += yz;
        own[5] += zz;
    }

    /// Less `share` times the matrix v v'.
    #[inline(always)]
    pub fn subtract_square(&mut self, v: &Vector, share: f64) {
        let [x, y, z] = *v;
        let (sx, sy, sz) = (x * share, y * share, z * share);
        let own = &mut self.0;
        own[0] -= x * sx;
        own[1] -= x * sy;
        own[2] -= x * sz;
        own[3] -= y * sy;
        own[4] -= y * sz;
        own[5] -= z * sz;
    }

    /// The same in the frame in which its own has these axes.
    #[inline(always)]
    pub fn seen(&self, axes: &Matrix) -> Symmetric {
        let [x, y, z] = product(axes, &self.full());
        let [a, b, c] = axes;
        Symmetric([
            dot(&x, a),
            dot(&x, b),
            dot(&x, c),
            dot(&y, b),
            dot(&y, c),
            dot(&z, c),
        ])
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
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub fn scaled(a: &Vector, by: f64) -> Vector {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// Adds `share` times `b`.
#[inline(always)]
pub fn add(a: &mut Vector, b: &Vector, share: f64) {
    a[0] += b[0] * share;
    a[1] += b[1] * share;
    a[2] += b[2] * share;
}

/// A product; of a frame's axes as columns, a vector of the frame as its parent has it.
#[inline(always)]
pub fn times(a: &Matrix, v: &Vector) -> Vector {
    [dot(&a[0], v), dot(&a[1], v), dot(&a[2], v)]
}

/// The product of the transposed matrix; of a frame's axes, a vector of the parent as the frame has
/// it.
#[inline(always)]
pub fn times_transposed(a: &Matrix, v: &Vector) -> Vector {
    let [x, y, z] = a;
    [
        x[0] * v[0] + y[0] * v[1] + z[0] * v[2],
        x[1] * v[0] + y[1] * v[1] + z[1] * v[2],
        x[2] * v[0] + y[2] * v[1] + z[2] * v[2],
    ]
}

#[inline(always)]
pub fn transposed(a: &Matrix) -> Matrix {
    let [x, y, z] = a;
    [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]
}

#[inline(always)]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [
        times_transposed(b, &a[0]),
        times_transposed(b, &a[1]),
        times_transposed(b, &a[2]),
    ]
}

/// The product with the transposed second matrix.
#[inline(always)]
pub fn product_transposed(a: &Matrix, b: &Matrix) -> Matrix {
    [times(b, &a[0]), times(b, &a[1]), times(b, &a[2])]
}
