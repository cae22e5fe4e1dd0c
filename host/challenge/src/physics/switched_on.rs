//! Which law each effect of the library is here.

use super::Physics;
use crate::moving_base::Base;

/// How hard the flanks of a gear with play are: natural frequency of the motor against them, rad/s,
/// and damping ratio. Knocks last some milliseconds, as those of steel on plastic do.
const FLANKS: (f64, f64) = (800.0, 1.0);

impl Physics {
    /// Switches on the effect `kind` with `values` in the order of its parameters; false if there
    /// is no such effect or it has another number of values.
    pub fn switch_on(&mut self, kind: &str, values: &[f64]) -> bool {
        match (kind, values) {
            ("viscous", &[b]) => self.viscous += b,
            ("air_drag", &[c]) => self.drag += c,
            ("coulomb", &[f]) => self.coulomb += f,
            ("stribeck", &[excess, speed]) => (self.excess, self.stribeck_speed) = (excess, speed),
            ("load_friction", &[factor]) => self.load_factor = factor,
            ("drive_asymmetry", &[motor, outside]) => self.gear_factors = [motor, outside],
            ("direction_asymmetry", &[half]) => self.half_difference = half,
            ("dead_zone", &[width, punch]) => (self.dead_width, self.dead_punch) = (width, punch),
            ("delay", &[delay]) => self.delay_s = delay,
            ("supply_sensitivity", &[sensitivity]) => self.sensitivity = sensitivity,
            ("supply_sag", &[share]) => self.sag = share,
            ("torque_scale", &[factor]) => self.torque_factor = factor,
            ("speed_limit", &[speed]) => self.no_load_speed = speed,
            ("torque_saturation", &[limit]) => self.torque_limit = limit,
            ("com_angle", &[angle]) => self.com_angle = angle,
            ("mass", &[added]) => {
                self.inertia_kg_m2 *= 1.0 + added / self.mass_kg;
                self.mass_kg += added;
            }
            ("armature", &[inertia]) => self.armature = inertia,
            ("cable_spring", &[stiffness, rest]) => {
                (self.stiffness, self.rest_angle) = (stiffness, rest)
            }
            ("base_tilt", &[angle]) => self.tilt = angle,
            ("cogging", &[amplitude, periods, phase]) => {
                (self.ripple, self.ripple_periods, self.ripple_phase) = (amplitude, periods, phase);
            }
            ("encoder_scale", &[factor]) => self.encoder_factor = factor,
            ("encoder_zero", &[offset]) => self.encoder_offset = offset,
            ("backlash", &[gap]) => self.gap = gap,
            ("sensor_lag", &[constant]) => self.lag_s = constant,
            ("time_offset", &[offset]) => self.logged_late_s = offset,
            ("rate_bias", &[bias]) => self.gyro.get_or_insert_default().bias_rad_s = bias,
            ("rate_scale", &[factor]) => self.gyro.get_or_insert_default().scale = factor,
            ("rate_lag", &[constant]) => self.gyro.get_or_insert_default().lag_s = constant,
            ("slew_limit", &[rate]) => self.duty_per_s = rate,
            ("drive_lag", &[constant]) => self.command_lag_s = constant,
            ("thermal_drift", &[rise, time]) => (self.warming, self.warming_s) = (rise, time),
            ("fold_back", &[share, level, after]) => {
                (self.fold_share, self.fold_level, self.fold_after_s) = (share, level, after);
            }
            ("pre_sliding", &[friction, stiffness]) => {
                (self.bristle_nm, self.bristle_nm_rad) = (friction, stiffness);
            }
            ("gear_compliance", &[inertia, stiffness, damping]) => {
                self.motor_inertia = inertia;
                self.gear_nm_rad = stiffness;
                self.gear_damping = 2.0 * damping * (stiffness * inertia).sqrt();
            }
            ("gear_backlash", &[inertia, gap]) => {
                self.motor_inertia = inertia;
                self.gear_nm_rad = inertia * FLANKS.0.powi(2);
                self.gear_damping = 2.0 * FLANKS.1 * FLANKS.0 * inertia;
                self.gear_gap = gap;
            }
            ("base_compliance", &[spring, mass, damping]) => {
                let damper = 2.0 * damping * (spring * mass).sqrt();
                self.base = Some(Base {
                    spring,
                    mass,
                    damper,
                });
            }
            ("grip_slip", &[acceleration]) => self.grip_rad_s2 = acceleration,
            ("torque_offset", &[torque]) => self.constant_nm = torque,
            ("position_friction", &[below, above, span]) => {
                (self.side_friction, self.side_span) = ([below, above], span);
            }
            _ => return false,
        }
        true
    }
}
