//! A base on a spring, under the truth's arm and robot.

use super::physics::GRAVITY_M_S2;

/// Laws of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// N/m, the same sideways and upward.
    pub spring: f64,
    /// What moves with the base, kg.
    pub mass: f64,
    /// N s/m.
    pub damper: f64,
}

/// What the links ask of the base.
#[derive(Debug, Clone, Copy)]
pub struct LinksOnBase<const N: usize> {
    /// Mass of all links, kg.
    pub mass: f64,
    /// Per joint, momentum of the links, sideways and upward, per rad/s: kg m.
    pub moment: [[f64; 2]; N],
    /// Force of the turning links on the base, N, beside their weight.
    pub thrown: [f64; 2],
}

impl<const N: usize> LinksOnBase<N> {
    /// None yet, of this mass, kg.
    pub fn of_mass(mass: f64) -> Self {
        LinksOnBase {
            mass,
            moment: [[0.0; 2]; N],
            thrown: [0.0; 2],
        }
    }

    /// Adds a mass `long` m from joint `k`, in the direction `at` rad from hanging, that turns
    /// about it by `turning` rad/s.
    pub fn add(&mut self, k: usize, [mass, long, at, turning]: [f64; 4]) {
        let (sin, cos) = at.sin_cos();
        self.moment[k][0] += mass * long * cos;
        self.moment[k][1] += mass * long * sin;
        self.thrown[0] += mass * long * turning * turning * sin;
        self.thrown[1] -= mass * long * turning * turning * cos;
    }
}

impl Base {
    /// What it takes from the inertia of joints `k` and `l` by giving way, kg m^2.
    pub fn yields<const N: usize>(&self, links: &LinksOnBase<N>, k: usize, l: usize) -> f64 {
        let [a, b] = [links.moment[k], links.moment[l]];
        (a[0] * b[0] + a[1] * b[1]) / (self.mass + links.mass)
    }

    /// What it takes from the torque on joint `k`, N m, while `force` N push it.
    pub fn pulls<const N: usize>(&self, links: &LinksOnBase<N>, k: usize, force: [f64; 2]) -> f64 {
        let [x, y] = links.moment[k];
        (x * force[0] + y * force[1]) / (self.mass + links.mass)
    }
}

/// Place, m, and speed, m/s, of a base, sideways and upward.
#[derive(Debug, Clone, Copy, Default)]
pub struct BaseState {
    pub at: [f64; 2],
    pub speed: [f64; 2],
}

impl BaseState {
    /// Sagged under links of this mass, gravity turned by `tilt` rad.
    pub fn sagged(base: Option<Base>, mass: f64, tilt: f64) -> BaseState {
        let down = |base: Base| mass * GRAVITY_M_S2 / base.spring;
        let sag = base.map_or(0.0, down);
        BaseState {
            at: [sag * tilt.sin(), -sag * tilt.cos()],
            speed: [0.0; 2],
        }
    }

    /// Force on base and links together, N.
    pub fn force<const N: usize>(&self, base: Base, links: &LinksOnBase<N>, tilt: f64) -> [f64; 2] {
        let weight = links.mass * GRAVITY_M_S2;
        let pull = [weight * tilt.sin(), -weight * tilt.cos()];
        std::array::from_fn(|k| {
            pull[k] + links.thrown[k] - base.spring * self.at[k] - base.damper * self.speed[k]
        })
    }

    /// Goes on for `h` s at its speed.
    pub fn drift(&mut self, h: f64) {
        for k in 0..2 {
            self.at[k] += h * self.speed[k];
        }
    }

    /// Speed after `force` N acted for `h` s while the joints sped up by `gained` rad/s.
    pub fn kicked<const N: usize>(
        &self,
        base: Base,
        links: &LinksOnBase<N>,
        (force, h): ([f64; 2], f64),
        gained: &[f64; N],
    ) -> BaseState {
        let speed = std::array::from_fn(|k| {
            let passed: f64 = (0..N).map(|j| links.moment[j][k] * gained[j]).sum();
            self.speed[k] + (h * force[k] - passed) / (base.mass + links.mass)
        });
        BaseState { speed, ..*self }
    }
}
