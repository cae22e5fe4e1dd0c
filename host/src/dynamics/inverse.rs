//! Inverse dynamics by recursive Newton-Euler, in the plane.

use super::chain::Chain;

impl Chain {
    /// Joint torques, N m, into `out`, that give the chain these accelerations.
    ///
    /// `gravity_turn_rad` turns gravity counter-clockwise. All slices have the chain's length.
    pub fn inverse(
        &self,
        gravity_turn_rad: f64,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        acceleration_rad_s2: &[f64],
        out: &mut [f64],
    ) {
        let base = self.base_m_s2(gravity_turn_rad);
        self.inverse_from(
            0,
            [0.0; 3],
            base,
            [angle_rad, speed_rad_s, acceleration_rad_s2],
            out,
        );
    }

    /// Torque at joint `i` into `out[i]`, and the force and moment link `i` asks of its joint.
    fn inverse_from(
        &self,
        i: usize,
        [angle, speed, acceleration]: [f64; 3],
        linear: [f64; 2],
        joints: [&[f64]; 3],
        out: &mut [f64],
    ) -> (f64, [f64; 2]) {
        let Some(link) = self.links.get(i) else {
            return (0.0, [0.0; 2]);
        };
        let angle = angle + joints[0][i];
        let speed = speed + joints[1][i];
        let acceleration = acceleration + joints[2][i];
        let point = |radius: f64, at: f64| {
            let (sin, cos) = at.sin_cos();
            let (left, back) = (acceleration * radius, speed * speed * radius);
            let arm = [radius * sin, -radius * cos];
            let point_acceleration = [
                linear[0] + left * cos - back * sin,
                linear[1] + left * sin + back * cos,
            ];
            (arm, point_acceleration)
        };
        let cross = |arm: [f64; 2], force: [f64; 2]| arm[0] * force[1] - arm[1] * force[0];
        let (end_arm, end_acceleration) = point(link.length_m, angle);
        let (com_arm, com_acceleration) = point(link.com_m, angle + link.com_angle_rad);
        let (child_moment, child_force) = self.inverse_from(
            i + 1,
            [angle, speed, acceleration],
            end_acceleration,
            joints,
            out,
        );
        let own_force = [
            link.mass_kg * com_acceleration[0],
            link.mass_kg * com_acceleration[1],
        ];
        let moment = child_moment
            + cross(end_arm, child_force)
            + link.inertia_kg_m2 * acceleration
            + cross(com_arm, own_force);
        out[i] = moment + link.armature_kg_m2 * joints[2][i];
        (
            moment,
            [own_force[0] + child_force[0], own_force[1] + child_force[1]],
        )
    }

    /// Force each joint's bearing carries, N, into `out`, at these accelerations.
    pub fn bearing_forces(
        &self,
        gravity_turn_rad: f64,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        acceleration_rad_s2: &[f64],
        out: &mut [f64],
    ) {
        let mut linear = self.base_m_s2(gravity_turn_rad);
        let (mut angle, mut speed, mut acceleration) = (0.0, 0.0, 0.0);
        let mut sum = [0.0, 0.0];
        // Forces of the links add up from the tip; keep the running sum from the base and subtract.
        let mut before = vec![[0.0, 0.0]; self.len()];
        for (i, link) in self.links.iter().enumerate() {
            angle += angle_rad[i];
            speed += speed_rad_s[i];
            acceleration += acceleration_rad_s2[i];
            before[i] = sum;
            let at = |radius: f64, angle: f64, linear: [f64; 2]| {
                let (sin, cos) = angle.sin_cos();
                [
                    linear[0] + radius * (acceleration * cos - speed * speed * sin),
                    linear[1] + radius * (acceleration * sin + speed * speed * cos),
                ]
            };
            let com = at(link.com_m, angle + link.com_angle_rad, linear);
            sum = [
                sum[0] + link.mass_kg * com[0],
                sum[1] + link.mass_kg * com[1],
            ];
            linear = at(link.length_m, angle, linear);
        }
        for (force, before) in out.iter_mut().zip(&before) {
            *force = (sum[0] - before[0]).hypot(sum[1] - before[1]);
        }
    }
}
