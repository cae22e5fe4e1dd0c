//! Bodies beside the links: motors behind gears that give, and a base that gives way.
//!
//! They are integrated along with the joints, and remembered from step to step.

use super::memory::EffectMemory;
use super::plant::Plant;
use crate::effects::{BodyState, Coupling, Flank};

/// Share of a motor's torque below which friction may leave it anywhere between the flanks.
const LIGHT_SHARE: f64 = 0.01;

/// Share of its gap within which a motor is at a flank, and speed, rad/s, below which it stays
/// there: what rounding leaves of motors that move with their joints.
const AT_FLANK: f64 = 1e-9;
const AT_REST_RAD_S: f64 = 1e-9;

/// Whether a motor that is so far ahead of its joint, and so fast, moves along with it.
fn is_at_rest_on_flank(coupling: &Coupling, wound_rad: f64, winding_rad_s: f64) -> bool {
    let least_rad = (1.0 - AT_FLANK) * coupling.half_gap_rad();
    wound_rad.abs() >= least_rad && winding_rad_s.abs() < AT_REST_RAD_S
}

/// State of the motors, one a joint, idle where it is rigid, and of a base that gives way, sideways
/// and upward; empty where all are rigid.
#[derive(Debug, Clone, Default)]
pub(super) struct Auxiliary {
    /// Angles of motors as seen at their joints, rad; displacement of the base, m.
    pub place: Vec<f64>,
    /// Its change, rad/s and m/s.
    pub speed: Vec<f64>,
    /// The change of that, found with the accelerations of the joints.
    pub slope: Vec<f64>,
    /// Which flank of each motor's gear pushes.
    pub flank: Vec<Flank>,
}

impl Auxiliary {
    /// Idle ones for `plant`.
    pub fn new(plant: &Plant) -> Auxiliary {
        let bodies = plant.auxiliary_bodies();
        Auxiliary {
            place: vec![0.0; bodies],
            speed: vec![0.0; bodies],
            slope: vec![0.0; bodies],
            flank: vec![Flank::None; bodies],
        }
    }

    /// Takes over where those are and how fast they move.
    pub fn copy_motion(&mut self, from: &Auxiliary) {
        self.place.copy_from_slice(&from.place);
        self.speed.copy_from_slice(&from.speed);
        self.flank.copy_from_slice(&from.flank);
    }

    /// How far and how fast a motor is ahead of its joint at this angle and speed, rad and rad/s.
    pub fn wound(&self, joint: usize, [angle, speed]: [f64; 2]) -> [f64; 2] {
        [self.place[joint] - angle, self.speed[joint] - speed]
    }

    /// Says which flanks push where the joints are at these angles and speeds; rigid ones that
    /// meet only now do not yet.
    pub fn find_flanks(&mut self, plant: &Plant, (angle, speed): (&[f64], &[f64])) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            if let Some(coupling) = plan.coupling {
                let [wound, winding] = self.wound(joint, [angle[joint], speed[joint]]);
                self.flank[joint] = if !coupling.has_rigid_flanks {
                    coupling.flank(wound, winding)
                } else if is_at_rest_on_flank(&coupling, wound, winding) {
                    Flank::Of(wound.signum())
                } else {
                    Flank::None
                };
            }
        }
    }

    /// Where the base is and how fast it moves, m and m/s.
    pub fn base(&self) -> [[f64; 2]; 2] {
        let motors = self.place.len() - 2;
        [&self.place, &self.speed].map(|of| [of[motors], of[motors + 1]])
    }

    /// Says how the base speeds up, m/s^2.
    pub fn speed_up_base(&mut self, by_m_s2: [f64; 2]) {
        let motors = self.slope.len() - 2;
        self.slope[motors..].copy_from_slice(&by_m_s2);
    }

    /// Puts them where they are remembered to be, the joints being at these angles and speeds. A
    /// motor of which nothing is remembered turns as its joint does, its gear carrying what holds
    /// the joint, N m; such a base carries the chain's weight at rest.
    pub fn recall(
        &mut self,
        plant: &Plant,
        memory: &EffectMemory,
        (angle, speed): (&[f64], &[f64]),
        holding_nm: impl Fn(usize) -> f64,
    ) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            let (Some(coupling), Some(cell)) = (plan.coupling, plan.gear_cell) else {
                continue;
            };
            let mut wound = BodyState::from(memory.0[cell]);
            if !wound.is_known() {
                let light_nm = LIGHT_SHARE * plan.full_torque_nm;
                wound = BodyState {
                    place: coupling.wound_rad(holding_nm(joint), light_nm),
                    speed: 0.0,
                };
            }
            if coupling.has_rigid_flanks {
                let most = coupling.half_gap_rad();
                wound.place = wound.place.clamp(-most, most);
            }
            self.place[joint] = angle[joint] + wound.place;
            self.speed[joint] = speed[joint] + wound.speed;
        }
        if let Some((base, cell)) = plant.base {
            let mass_kg = plant.rig.chain.links.iter().map(|l| l.mass_kg).sum::<f64>();
            for k in 0..2 {
                let mut at = BodyState::from(memory.0[cell + k]);
                if !at.is_known() {
                    at = BodyState {
                        place: -mass_kg * plant.base_m_s2[k] / base.stiffness_n_m,
                        speed: 0.0,
                    };
                }
                let body = plant.len() + k;
                (self.place[body], self.speed[body]) = (at.place, at.speed);
            }
        }
    }

    /// Remembers where they are, motors by how far they are ahead of their joints: a joint that is
    /// put elsewhere, as where a window begins, takes its motor along.
    pub fn remember(
        &self,
        plant: &Plant,
        memory: &mut EffectMemory,
        (angle, speed): (&[f64], &[f64]),
    ) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            if let Some(cell) = plan.gear_cell {
                let wound = BodyState {
                    place: self.place[joint] - angle[joint],
                    speed: self.speed[joint] - speed[joint],
                };
                memory.0[cell] = wound.into();
            }
        }
        if let Some((_, cell)) = plant.base {
            for k in 0..2 {
                let body = plant.len() + k;
                let at = BodyState {
                    place: self.place[body],
                    speed: self.speed[body],
                };
                memory.0[cell + k] = at.into();
            }
        }
    }
}
