//! What lies between a motor and its joint.

/// A gear as the effects at a joint make it: the motor's own inertia turns at its far end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gear {
    /// Inertia of the motor as seen at the joint, kg m^2; without any, the gear passes on what the
    /// motor gives.
    pub inertia_kg_m2: f64,
    /// Torque per angle by which the gear is wound up, N m/rad; infinite where nothing says so.
    pub stiffness_nm_rad: f64,
    /// Damping of the wound gear as a share of what lets the motor settle without ringing.
    pub damping_ratio: f64,
    /// Free play, from flank to flank, rad.
    pub gap_rad: f64,
}

/// Highest natural frequency of the motor against a standing joint, rad/s. Stiffer gears are
/// simulated as this stiff: logs at 100 Hz hold nothing of a faster ringing, and it would cost
/// steps. Flanks as stiff as that do not give at all.
pub(super) const HIGHEST_RAD_S: f64 = 400.0;

impl Gear {
    /// Rigid, and without inertia of the motor.
    pub const RIGID: Gear = Gear {
        inertia_kg_m2: 0.0,
        stiffness_nm_rad: f64::INFINITY,
        damping_ratio: 1.0,
        gap_rad: 0.0,
    };
}

/// Which of a gap's flanks pushes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Flank {
    /// Neither.
    #[default]
    None,
    /// The one that turns the joint in this direction, +1 or -1.
    Of(f64),
}

/// A motor with inertia, and the spring or the flanks through which it turns its joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// Inertia of the motor as seen at the joint, kg m^2; above 0.
    pub inertia_kg_m2: f64,
    /// Natural frequency of the motor against a standing joint, rad/s.
    pub natural_rad_s: f64,
    /// Whether it has a gap between flanks that do not give: motor and joint that meet move on
    /// together.
    pub has_rigid_flanks: bool,
    stiffness_nm_rad: f64,
    damping_nm_s_rad: f64,
    half_gap_rad: f64,
}

impl Coupling {
    /// None where the motor has no inertia: the joint then gets what the motor gives.
    pub fn of(gear: &Gear) -> Option<Coupling> {
        let inertia_kg_m2 = gear.inertia_kg_m2;
        let natural_rad_s = (gear.stiffness_nm_rad / inertia_kg_m2).sqrt();
        let has_rigid_flanks = gear.gap_rad > 0.0 && natural_rad_s >= HIGHEST_RAD_S;
        let natural_rad_s = natural_rad_s.min(HIGHEST_RAD_S);
        let (stiffness_nm_rad, damping_nm_s_rad) = if has_rigid_flanks {
            (f64::INFINITY, 0.0)
        } else {
            let damping = 2.0 * gear.damping_ratio * inertia_kg_m2 * natural_rad_s;
            (inertia_kg_m2 * natural_rad_s.powi(2), damping)
        };
        (inertia_kg_m2 > 0.0).then_some(Coupling {
            inertia_kg_m2,
            natural_rad_s,
            has_rigid_flanks,
            stiffness_nm_rad,
            damping_nm_s_rad,
            half_gap_rad: 0.5 * gear.gap_rad,
        })
    }

    /// Torque that the gear transmits to the joint, N m, where the motor is `wound_rad` ahead of it
    /// and winds it up further by `winding_rad_s`. Flanks push and never pull.
    pub fn torque_nm(&self, wound_rad: f64, winding_rad_s: f64) -> f64 {
        let flank = self.flank(wound_rad, winding_rad_s);
        self.torque_on_nm(flank, wound_rad, winding_rad_s)
    }

    /// The same while this flank pushes; a smooth law, which pulls where it no longer does.
    pub fn torque_on_nm(&self, flank: Flank, wound_rad: f64, winding_rad_s: f64) -> f64 {
        let within_rad = match flank {
            Flank::None if self.has_gap() => return 0.0,
            Flank::None => wound_rad,
            Flank::Of(direction) => wound_rad - direction * self.half_gap_rad,
        };
        self.stiffness_nm_rad * within_rad + self.damping_nm_s_rad * winding_rad_s
    }

    /// The flank that pushes: none within the gap, or where flanks part faster than they spring
    /// back.
    pub fn flank(&self, wound_rad: f64, winding_rad_s: f64) -> Flank {
        if self.has_gap() && self.pressed_rad(Flank::None, wound_rad, winding_rad_s) > 0.0 {
            Flank::Of(wound_rad.signum())
        } else {
            Flank::None
        }
    }

    /// By how much the flank that pushes is pressed, or the nearer one of two that do not, rad; at
    /// 0 they part or meet.
    pub fn pressed_rad(&self, flank: Flank, wound_rad: f64, winding_rad_s: f64) -> f64 {
        let damping_rad = self.damping_nm_s_rad / self.stiffness_nm_rad * winding_rad_s;
        match flank {
            Flank::Of(direction) => direction * (wound_rad + damping_rad) - self.half_gap_rad,
            Flank::None => {
                let inward_rad = (wound_rad.signum() * damping_rad).min(0.0);
                wound_rad.abs() - self.half_gap_rad + inward_rad
            }
        }
    }

    /// How far ahead of its joint the motor is at most, where its flanks are rigid, rad.
    pub fn half_gap_rad(&self) -> f64 {
        self.half_gap_rad
    }

    /// Whether it has a gap, whose flanks meet and part.
    pub fn has_gap(&self) -> bool {
        self.half_gap_rad > 0.0
    }

    /// By how much it is wound up at most by torques up to this, N m, and where its flanks meet,
    /// rad.
    pub fn reach_rad(&self, torque_nm: f64) -> (f64, f64) {
        let pressed_rad = torque_nm.abs() / self.stiffness_nm_rad;
        (self.half_gap_rad + pressed_rad, self.half_gap_rad)
    }

    /// By how much it is wound up while it transmits this torque at rest, rad; where that is less
    /// than `light_nm`, hardly at a flank.
    pub fn wound_rad(&self, torque_nm: f64, light_nm: f64) -> f64 {
        let flank = torque_nm / (torque_nm.abs() + light_nm);
        torque_nm / self.stiffness_nm_rad + self.half_gap_rad * flank
    }
}

#[cfg(test)]
mod tests {
    use super::{Coupling, Gear};

    const SPRING: Gear = Gear {
        inertia_kg_m2: 2e-3,
        stiffness_nm_rad: 0.8,
        damping_ratio: 0.25,
        ..Gear::RIGID
    };

    fn near(left: f64, right: f64) {
        assert!((left - right).abs() < 1e-15, "{left} is not {right}");
    }

    #[test]
    fn a_spring_with_a_damper_gives_torque_by_both() {
        let spring = Coupling::of(&SPRING).unwrap();
        near(spring.natural_rad_s, 20.0);
        // 0.8 * 0.1 + 2 * 0.25 * 2e-3 * 20 * 3
        near(spring.torque_nm(0.1, 3.0), 0.14);
        near(spring.wound_rad(-0.08, 0.01), -0.1);
    }

    #[test]
    fn flanks_push_beyond_the_gap_and_never_pull() {
        let gear = Gear {
            gap_rad: 0.1,
            ..SPRING
        };
        let play = Coupling::of(&gear).unwrap();
        assert_eq!(play.torque_nm(0.05, 9.0), 0.0);
        near(play.torque_nm(0.15, 0.0), 0.08);
        near(play.torque_nm(-0.15, 0.0), -0.08);
        // Pressed together faster: more; drawn apart: less, and nothing before they would pull.
        near(play.torque_nm(-0.15, -1.0), -0.1);
        near(play.torque_nm(0.15, -1.0), 0.06);
        assert_eq!(play.torque_nm(0.06, -9.0), 0.0);
        for torque_nm in [-0.2, 0.2] {
            let wound_rad = play.wound_rad(torque_nm, 0.0);
            near(play.torque_nm(wound_rad, 0.0), torque_nm);
        }
        near(play.wound_rad(0.01, 0.01), 0.0125 + 0.025);
        assert_eq!(play.wound_rad(0.0, 0.01), 0.0);
    }

    #[test]
    fn flanks_of_which_nothing_says_how_stiff_they_are_do_not_give() {
        let gear = Gear {
            inertia_kg_m2: 2e-3,
            gap_rad: 0.1,
            ..Gear::RIGID
        };
        let play = Coupling::of(&gear).unwrap();
        assert!(play.has_rigid_flanks);
        assert_eq!(play.torque_nm(0.05, 9.0), 0.0);
        assert_eq!(play.torque_nm(-0.051, 0.0), f64::NEG_INFINITY);
        assert_eq!(play.reach_rad(0.3), (0.05, 0.05));
        near(play.wound_rad(0.03, 0.01), 0.75 * 0.05);
        let given = Gear {
            gap_rad: 0.1,
            ..SPRING
        };
        assert!(!Coupling::of(&given).unwrap().has_rigid_flanks);
    }

    #[test]
    fn what_is_too_stiff_rings_at_the_highest_frequency() {
        let inertia_kg_m2 = 1e-3;
        let stiff = Coupling::of(&Gear {
            inertia_kg_m2,
            ..Gear::RIGID
        });
        let stiff = stiff.unwrap();
        near(stiff.natural_rad_s, 400.0);
        near(stiff.torque_nm(0.01, 0.0), 1.6);
    }

    #[test]
    fn a_motor_without_inertia_gives_what_it_gives() {
        assert_eq!(Coupling::of(&Gear::RIGID), None);
    }
}
