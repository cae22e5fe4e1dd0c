//! Forward dynamics of a chain whose base can move.

use super::{Subtree, Workspace};
use crate::dynamics::Chain;

/// A base that moves without turning.
#[derive(Debug, Clone, Copy)]
pub struct FreeBase {
    /// Its own mass, kg; above 0.
    pub mass_kg: f64,
    /// Force on it that is not the chain's, N: (x, y).
    pub force_n: [f64; 2],
}

impl Chain {
    /// What [`Chain::forward`] gives for a chain on this base; returns the base's own acceleration,
    /// m/s^2. Gravity, which `base_m_s2` stands for, pulls at the chain alone.
    #[allow(clippy::too_many_arguments)]
    pub fn forward_on(
        &self,
        base: FreeBase,
        work: &mut Workspace,
        base_m_s2: [f64; 2],
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        torque_nm: &[f64],
        held: &[bool],
        out: &mut [f64],
    ) -> [f64; 2] {
        let scratch = &mut work.links[..self.links.len()];
        self.find_motions(scratch, angle_rad, speed_rad_s);
        let asked = self.gather(scratch, torque_nm, held);
        let own_m_s2 = base.acceleration_m_s2(&asked, base_m_s2);
        let base_m_s2 = [0, 1].map(|k| base_m_s2[k] + own_m_s2[k]);
        self.spread(scratch, base_m_s2, held, out);
        own_m_s2
    }
}

impl FreeBase {
    /// From the base's own equations, m a + M (g + a) + f = F with the chain's apparent mass M.
    fn acceleration_m_s2(&self, chain: &Subtree, gravity_m_s2: [f64; 2]) -> [f64; 2] {
        let [xx, xy, yy] = chain.mass;
        let [x, y] = gravity_m_s2;
        let left = [
            self.force_n[0] - chain.force[0] - (xx * x + xy * y),
            self.force_n[1] - chain.force[1] - (xy * x + yy * y),
        ];
        let (xx, yy) = (xx + self.mass_kg, yy + self.mass_kg);
        let inverse = 1.0 / (xx * yy - xy * xy);
        [
            inverse * (yy * left[0] - xy * left[1]),
            inverse * (xx * left[1] - xy * left[0]),
        ]
    }
}
