//! The laws of the bench arm, written down a second time on purpose: the truth owes nothing to the
//! code that is to find it out.

mod switched_on;

use super::gyro::GyroLaw;
use super::moving_base::{Base, BaseState, LinksOnBase};
use super::unknown_law::UnknownLaw;

/// Gravity, m/s^2.
pub const GRAVITY_M_S2: f64 = 9.81;
/// Where a payload is bolted on, m from the joint.
pub const PAYLOAD_AT_M: f64 = 0.15;

/// Everything that acts on the arm; [`Physics::ideal`] has no effect switched on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Physics {
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Mass of the link, kg.
    pub mass_kg: f64,
    /// Inertia of the link about its centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
    /// Torque at full duty, N m.
    pub stall_nm: f64,
    /// Supply at which the stall torque holds, V.
    pub nominal_supply_v: f64,
    /// Viscous friction, N m s/rad.
    pub viscous: f64,
    drag: f64,
    coulomb: f64,
    excess: f64,
    stribeck_speed: f64,
    load_factor: f64,
    gear_factors: [f64; 2],
    half_difference: f64,
    dead_width: f64,
    dead_punch: f64,
    /// Seconds by which a command arrives late.
    pub delay_s: f64,
    sensitivity: f64,
    sag: f64,
    torque_factor: f64,
    no_load_speed: f64,
    torque_limit: f64,
    /// Angle by which the centre of mass is turned about the joint, rad.
    pub com_angle: f64,
    /// Inertia of the rotor at the joint, kg m^2.
    pub armature: f64,
    stiffness: f64,
    rest_angle: f64,
    /// Tilt of the base, rad.
    pub tilt: f64,
    ripple: f64,
    ripple_periods: f64,
    ripple_phase: f64,
    encoder_factor: f64,
    encoder_offset: f64,
    /// Free play before the encoder, flank to flank, rad.
    pub gap: f64,
    /// Time constant of the encoder's filter, s.
    pub lag_s: f64,
    /// By how much later than the encoder read it the log holds a reading, s.
    pub logged_late_s: f64,
    /// Fastest change of the duty, 1/s.
    pub duty_per_s: f64,
    /// Time constant with which the duty follows the command, s.
    pub command_lag_s: f64,
    /// Relative rise of the winding's resistance, warm from full duty, and how long that takes, s.
    pub warming: f64,
    /// See `warming`.
    pub warming_s: f64,
    /// Share of the torque that is left once the duty was above `fold_level` for `fold_after_s`.
    pub fold_share: f64,
    /// See `fold_share`.
    pub fold_level: f64,
    /// See `fold_share`; 0 means never.
    pub fold_after_s: f64,
    /// Dry friction of bristles, N m, and their stiffness, N m/rad.
    pub bristle_nm: f64,
    /// See `bristle_nm`.
    pub bristle_nm_rad: f64,
    /// Inertia of a motor behind a gear that gives, kg m^2; 0: the gear is rigid.
    pub motor_inertia: f64,
    gear_nm_rad: f64,
    gear_damping: f64,
    gear_gap: f64,
    /// What the rig stands on, where it gives way.
    pub base: Option<Base>,
    /// Largest acceleration that the encoder's shaft follows, rad/s^2.
    pub grip_rad_s2: f64,
    /// The gyro on the link, where there is one.
    pub gyro: Option<GyroLaw>,
    /// A law that the library lacks.
    pub unknown: Option<UnknownLaw>,
    constant_nm: f64,
    side_friction: [f64; 2],
    side_span: f64,
}

/// Conditions of one motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mount {
    /// Mass bolted on, kg.
    pub payload_kg: f64,
    /// Whether the rig is turned by 180 degrees about the vertical.
    pub turned: bool,
}

/// What drives the arm at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveCommand {
    /// Commanded duty, -1 to 1, already delayed.
    pub duty: f64,
    /// Supply, V.
    pub supply_v: f64,
    /// Whether the motor is energised.
    pub torque_on: bool,
}

impl Physics {
    /// A rigid arm without friction, with an ideal drive and encoder.
    pub fn ideal(
        com_m: f64,
        mass_kg: f64,
        inertia_kg_m2: f64,
        stall_nm: f64,
        nominal_supply_v: f64,
    ) -> Self {
        Physics {
            com_m,
            mass_kg,
            inertia_kg_m2,
            stall_nm,
            nominal_supply_v,
            stribeck_speed: 1.0,
            torque_factor: 1.0,
            no_load_speed: f64::INFINITY,
            torque_limit: f64::INFINITY,
            ripple_periods: 1.0,
            encoder_factor: 1.0,
            duty_per_s: f64::INFINITY,
            grip_rad_s2: f64::INFINITY,
            fold_share: 1.0,
            side_span: 1.0,
            ..Physics::default()
        }
    }

    /// Inertia about the joint, kg m^2.
    pub fn inertia_at_joint(&self, mount: Mount) -> f64 {
        self.inertia_kg_m2
            + self.mass_kg * self.com_m.powi(2)
            + mount.payload_kg * PAYLOAD_AT_M.powi(2)
            + self.armature
    }

    /// Torque that holds the arm against gravity at `angle`, N m.
    pub fn holding(&self, mount: Mount, angle: f64) -> f64 {
        let from_down = angle - self.gravity_turn(mount);
        let link = self.mass_kg * self.com_m * (from_down + self.com_angle).sin();
        let payload = mount.payload_kg * PAYLOAD_AT_M * from_down.sin();
        GRAVITY_M_S2 * (link + payload)
    }

    /// What arm and payload ask of a base, the arm at `angle` and turning by `speed`.
    pub fn on_base(&self, mount: Mount, angle: f64, speed: f64) -> LinksOnBase<1> {
        let mut links = LinksOnBase::of_mass(self.mass_kg + mount.payload_kg);
        links.add(0, [self.mass_kg, self.com_m, angle + self.com_angle, speed]);
        links.add(0, [mount.payload_kg, PAYLOAD_AT_M, angle, speed]);
        links
    }

    /// The base under arm and payload at rest.
    pub fn sagged(&self, mount: Mount) -> BaseState {
        BaseState::sagged(
            self.base,
            self.mass_kg + mount.payload_kg,
            self.gravity_turn(mount),
        )
    }

    /// Angle by which gravity is turned, rad.
    pub fn gravity_turn(&self, mount: Mount) -> f64 {
        if mount.turned { -self.tilt } else { self.tilt }
    }

    /// Duty that the dead zone lets through.
    pub fn applied(&self, duty: f64) -> f64 {
        if duty.abs() <= self.dead_width {
            return 0.0;
        }
        let through = (duty.abs() + self.dead_punch).clamp(0.0, 1.0);
        through.copysign(duty)
    }

    /// Torque of the motor at the joint, N m.
    pub fn drive(&self, push: DriveCommand, speed: f64) -> f64 {
        if !push.torque_on {
            return 0.0;
        }
        let duty = self.applied(push.duty);
        let mut torque = self.stall_nm * duty;
        torque *= 1.0 + self.sensitivity * (push.supply_v / self.nominal_supply_v - 1.0);
        torque *= 1.0 - self.sag * duty.abs();
        torque *= self.torque_factor;
        torque -= self.stall_nm * speed / self.no_load_speed;
        torque.clamp(-self.torque_limit, self.torque_limit)
    }

    /// Torque that a gear that gives passes on to the joint, N m, its motor being `ahead` rad of
    /// the joint and drawing away by `away` rad/s.
    pub fn through_gear(&self, ahead: f64, away: f64) -> f64 {
        let play = 0.5 * self.gear_gap;
        let bent = ahead - ahead.clamp(-play, play);
        if bent == 0.0 && play > 0.0 {
            return 0.0;
        }
        let torque = self.gear_nm_rad * bent + self.gear_damping * away;
        // A flank pushes one way only.
        if play > 0.0 && torque * bent < 0.0 {
            0.0
        } else {
            torque
        }
    }

    /// Torques on the joint that are neither motor, gravity nor dry friction, N m.
    pub fn smooth(&self, angle: f64, speed: f64) -> f64 {
        let mut torque = -self.viscous * speed - self.drag * speed * speed.abs();
        torque -= self.stiffness * (angle - self.rest_angle);
        torque += self.constant_nm;
        if self.ripple != 0.0 {
            torque += self.ripple * (self.ripple_periods * angle + self.ripple_phase).sin();
        }
        torque
    }

    /// Magnitude of dry friction, N m, at an angle and speed, against `direction`; the motor gives
    /// `drive` N m, and `holding` N m would hold the joint against the load.
    pub fn friction(
        &self,
        [angle, speed]: [f64; 2],
        direction: f64,
        drive: f64,
        holding: f64,
    ) -> f64 {
        let gear_load = (drive + holding).abs();
        let mut magnitude =
            self.coulomb + self.load_factor * gear_load + self.half_difference * direction;
        let side = self.side_friction[usize::from(angle > 0.0)];
        magnitude += side * (angle.abs() / self.side_span).min(1.0);
        let [motor, outside] = self.gear_factors;
        magnitude += (motor * drive + outside * holding).abs();
        if self.excess != 0.0 {
            magnitude += self.excess * (-speed.abs() / self.stribeck_speed).exp();
        }
        if let Some(law) = &self.unknown {
            magnitude += law.friction_nm(angle, direction * speed.abs(), drive);
        }
        magnitude.max(0.0)
    }

    /// What a perfect counter of the encoder's axis would read, rad.
    pub fn encoded(&self, angle: f64) -> f64 {
        self.encoder_factor * angle + self.encoder_offset
    }
}
