//! Base compliance: the bar, or the mount, gives way.

use super::gear::HIGHEST_RAD_S;
use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Rig, Scope, Site, StartUnknown};

/// m x'' + c x' + k x = -F in both directions of the rig's plane, F being what the chain asks of
/// its base; c by the damping ratio c / (2 sqrt(k m)).
#[derive(Debug)]
pub struct BaseCompliance;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "base_compliance",
    title: "compliance of the base or bar",
    aliases: &[
        "base flexibility",
        "base elasticity",
        "mount flexibility",
        "moving base",
        "wobble",
        "compliance",
        "flexibility",
        "elasticity",
        "spring",
    ],
    site: Site::Body,
    scope: Scope::WholeRig,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "mass_kg * x'' + c * x' + stiffness_n_m * x = force of the chain, c = 2 * damping_ratio * \
     sqrt(stiffness_n_m * mass_kg); likewise upward",
    parameters: &[
        Parameter::of(
            "stiffness_n_m",
            "force per displacement, the same sideways and upward",
        )
        .off(f64::INFINITY)
        .typical(50.0, 20_000.0)
        .bounds(5.0, 1e7)
        .starts(&[100.0, 400.0, 1600.0]),
        Parameter::of("mass_kg", "what moves along with the base")
            .typical(0.1, 5.0)
            .bounds(0.05, 100.0)
            .starts(&[0.5]),
        Parameter::of(
            "damping_ratio",
            "damping, as a share of what lets the empty base settle without ringing",
        )
        .typical(0.02, 0.3)
        .bounds(0.0, 1.0)
        .starts(&[0.1]),
    ],
    looks_like: "a slow swing that all joints share and that no drive makes; fast motions are \
     wrong, slow ones right",
    confused_with: &[
        "armature: both change how fast the arm swings, not how it hangs; a base that gives swings \
         on by itself, in all joints at once",
        "gear_compliance: both ring; a gear rings at its own joint, a base at all of them, with \
         torque off as well",
    ],
    experiment: "hold the robot still, strike the bar and watch all joints ring at one frequency; \
     then clamp the bar",
    reference: "Lew, Moon, IEEE/ASME Transactions on Mechatronics 6 (2001) 305",
};

/// A base that gives way: a mass on a spring with a damper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseSpring {
    /// What moves with the base, kg.
    pub mass_kg: f64,
    /// Force per displacement, N/m.
    pub stiffness_n_m: f64,
    damping_n_s_m: f64,
}

impl BaseSpring {
    /// Of this mass, kg, stiffness, N/m, and damping ratio; none where it is rigid. A stiffer one
    /// than logs can hold anything of is as stiff as that.
    pub fn new(mass_kg: f64, stiffness_n_m: f64, damping_ratio: f64) -> Option<BaseSpring> {
        let natural_rad_s = (stiffness_n_m / mass_kg).sqrt().min(HIGHEST_RAD_S);
        stiffness_n_m.is_finite().then_some(BaseSpring {
            mass_kg,
            stiffness_n_m: mass_kg * natural_rad_s.powi(2),
            damping_n_s_m: 2.0 * damping_ratio * mass_kg * natural_rad_s,
        })
    }

    /// Natural frequency of the empty base, rad/s: the highest that it has with any chain on it.
    pub fn natural_rad_s(&self) -> f64 {
        (self.stiffness_n_m / self.mass_kg).sqrt()
    }

    /// Force that drives it back, N, from a displacement, m, at a speed, m/s.
    pub fn force_n(&self, displaced_m: f64, speed_m_s: f64) -> f64 {
        -self.stiffness_n_m * displaced_m - self.damping_n_s_m * speed_m_s
    }
}

impl Law for BaseCompliance {
    fn acts_in_space(&self) -> bool {
        false
    }

    /// Where the base is.
    /// Anywhere, and moving anyhow, a soft base would take the place of whatever is missing.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Nothing)
    }

    fn body(&self, values: &[f64], _joint: usize, rig: &mut Rig) {
        rig.base_spring = BaseSpring::new(values[1], values[0], values[2]);
    }
}
