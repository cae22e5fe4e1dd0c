//! The constants of a planar chain.

use super::slide_axis::SlideAxis;

/// A planar chain on a fixed base. Angles are relative, joint 1's from hanging, counter-clockwise.
///
/// Where a joint slides, its place among the angles, rad, is a displacement, m, that among the
/// speeds, rad/s, one in m/s, and that among the torques, N m, a force, N.
#[derive(Debug, Clone)]
pub struct Chain {
    /// Links from the base outwards; link i follows joint i.
    pub links: Vec<ChainLink>,
    /// Gravity, m/s^2.
    pub gravity_m_s2: f64,
}

/// One link and the joint that carries it.
#[derive(Debug, Clone)]
pub struct ChainLink {
    /// Joint to next joint, m.
    pub length_m: f64,
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Angle of the centre of mass off the link's line, rad, counter-clockwise.
    pub com_angle_rad: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
    /// Rotor's inertia reflected through the gear, kg m^2: counts in the joint's own acceleration
    /// only.
    pub armature_kg_m2: f64,
    /// Along what its joint slides; none of a hinge. The rotor's inertia above is then one in kg.
    pub slide: Option<SlideAxis>,
}

impl Chain {
    /// Number of links.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Whether there is no link.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Whether any joint slides.
    pub fn slides(&self) -> bool {
        self.links.iter().any(|link| link.slide.is_some())
    }

    /// Acceleration of the base, m/s^2, that acts on the chain as gravity does when turned
    /// counter-clockwise by `turn_rad`: against its pull.
    pub fn base_m_s2(&self, turn_rad: f64) -> [f64; 2] {
        let (sin, cos) = turn_rad.sin_cos();
        [-self.gravity_m_s2 * sin, self.gravity_m_s2 * cos]
    }

    /// Adds a point mass to the last link, `at_m` from its joint on the link's line.
    pub fn bolt_on(&mut self, mass_kg: f64, at_m: f64) {
        let Some(link) = self.links.last_mut() else {
            return;
        };
        let (sin, cos) = link.com_angle_rad.sin_cos();
        let total_kg = link.mass_kg + mass_kg;
        let along_m = (link.mass_kg * link.com_m * cos + mass_kg * at_m) / total_kg;
        let across_m = link.mass_kg * link.com_m * sin / total_kg;
        let about_joint =
            link.inertia_kg_m2 + link.mass_kg * link.com_m.powi(2) + mass_kg * at_m * at_m;
        link.com_m = along_m.hypot(across_m);
        link.com_angle_rad = across_m.atan2(along_m);
        link.mass_kg = total_kg;
        link.inertia_kg_m2 = about_joint - total_kg * link.com_m.powi(2);
    }

    /// Kinetic and potential energy, J; the potential is zero with every link level with the base.
    pub fn energy_j(&self, angle_rad: &[f64], speed_rad_s: &[f64]) -> (f64, f64) {
        let (mut angle, mut speed) = (0.0, 0.0);
        let (mut height, mut velocity) = (0.0, [0.0, 0.0]);
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (i, link) in self.links.iter().enumerate() {
            match &link.slide {
                None => {
                    angle += angle_rad[i];
                    speed += speed_rad_s[i];
                }
                Some(slide) => {
                    let (q, rate) = (angle_rad[i], speed_rad_s[i]);
                    let (sin, cos) = (angle + slide.direction_rad).sin_cos();
                    velocity[0] += rate * sin + speed * q * cos;
                    velocity[1] += speed * q * sin - rate * cos;
                    height -= q * cos;
                    angle += slide.link_rad;
                }
            }
            let (com_sin, com_cos) = (angle + link.com_angle_rad).sin_cos();
            let com_speed = [
                velocity[0] + speed * link.com_m * com_cos,
                velocity[1] + speed * link.com_m * com_sin,
            ];
            kinetic += 0.5 * link.mass_kg * (com_speed[0].powi(2) + com_speed[1].powi(2))
                + 0.5 * link.inertia_kg_m2 * speed * speed
                + 0.5 * link.armature_kg_m2 * speed_rad_s[i].powi(2);
            potential += link.mass_kg * self.gravity_m_s2 * (height - link.com_m * com_cos);
            let (sin, cos) = angle.sin_cos();
            velocity[0] += speed * link.length_m * cos;
            velocity[1] += speed * link.length_m * sin;
            height -= link.length_m * cos;
        }
        (kinetic, potential)
    }
}
