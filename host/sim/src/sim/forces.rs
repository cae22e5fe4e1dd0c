//! Accelerations of a plant at a state: drives, joint torques and friction on the chain.

mod joined;
mod kicks;

use super::auxiliary::Auxiliary;
use super::drive::DriveInput;
use super::memory::EffectMemory;
use super::plant::Plant;
use super::rows::Rows;
use super::stepper::Contact;
use crate::dynamics::{Chain, FreeBase, SpatialWorkspace, Workspace};
use crate::effects::{BaseSpring, BodyState, Flank, FrictionState, JointState, MemoryCell};
use crate::model::Drive;
use joined::Joined;

/// A state: relative angles, rad, and speeds, rad/s, and how friction acts on each joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct StateView<'a> {
    pub angle: &'a [f64],
    pub speed: &'a [f64],
    pub contact: &'a [Contact],
}

/// Scratch memory; `R` says how its rows of one number per joint are kept.
#[derive(Debug, Clone)]
pub(super) struct Forces<R: Rows> {
    work: Workspace,
    spatial: SpatialWorkspace,
    closed: R::Closed,
    held: R::Of<bool>,
    torque: R::Of<f64>,
    drive_torque: R::Of<f64>,
    loads: R::Of<f64>,
    bearing: R::Of<f64>,
    zeros: R::Of<f64>,
    /// Half of the integration step, s.
    pub half_step_s: f64,
    /// By how much the jump of a command changes a regulated joint's acceleration, rad/s^2.
    kicks: R::Of<f64>,
    /// What effects remember; it stays through a step.
    pub memory: EffectMemory,
    /// Motors behind gears that give, and a base that gives way.
    pub auxiliary: Auxiliary,
    /// The bodies with the motors that move with their joints, where any may.
    joined: Option<Box<Joined>>,
}

impl<R: Rows> Forces<R> {
    /// For the joints of `plant`.
    pub fn new(plant: &Plant) -> Self {
        let n = plant.len();
        let zeros = || R::filled(0.0, n);
        Forces {
            work: Workspace::new(n),
            spatial: SpatialWorkspace::default(),
            closed: R::closed(plant, &plant.rig.chain),
            held: R::filled(false, n),
            torque: zeros(),
            drive_torque: zeros(),
            loads: zeros(),
            bearing: zeros(),
            zeros: zeros(),
            half_step_s: 0.0,
            kicks: zeros(),
            memory: EffectMemory::default(),
            auxiliary: Auxiliary::new(plant),
            joined: Joined::new(plant),
        }
    }

    /// Takes the torques that follow from the inputs alone, which must then stay.
    #[inline]
    pub fn command(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            if plan.follows_input {
                self.drive_torque[joint] =
                    plan.drive_torque_nm(inputs[joint], 0.0.into(), 0.0, &self.memory.0);
            }
        }
    }

    /// Accelerations into `out`, rad/s^2; for held joints the torque that holds them, N m.
    #[inline]
    pub fn accelerate(
        &mut self,
        plant: &Plant,
        inputs: &[DriveInput],
        at: StateView<'_>,
        out: &mut [f64],
    ) {
        self.find_torques(plant, inputs, at, out);
        self.solve(plant, at, out);
        self.carry_motors(at.contact, out);
    }

    /// One step of `h` s from these angles and speeds, in place, where the torques stay as they
    /// are through it and the equations have a closed form; else nothing, and false. `first` are
    /// the accelerations at its beginning where they are known already.
    #[inline]
    pub fn step(
        &mut self,
        plant: &Plant,
        inputs: &[DriveInput],
        contact: &[Contact],
        (angle, speed): (&mut R::Of<f64>, &mut R::Of<f64>),
        h: f64,
        first: Option<&R::Of<f64>>,
    ) -> bool {
        if !plant.torques_stay {
            return false;
        }
        let at = StateView {
            angle: angle.as_ref(),
            speed: speed.as_ref(),
            contact,
        };
        self.find_torques(plant, inputs, at, &mut []);
        R::step(
            &self.closed,
            angle,
            speed,
            &self.torque,
            &self.held,
            h,
            first,
        )
    }

    /// Torques at the joints, and which of them are held. `out` is scratch.
    #[inline]
    fn find_torques(
        &mut self,
        plant: &Plant,
        inputs: &[DriveInput],
        at: StateView<'_>,
        out: &mut [f64],
    ) {
        let n = self.torque.as_ref().len();
        for (joint, &input) in inputs[..n].iter().enumerate() {
            let plan = &plant.joints[joint];
            let speed = at.speed[joint];
            self.held[joint] = at.contact[joint] == Contact::Held;
            let motor_speed = match plan.coupling {
                Some(_) => self.auxiliary.speed[joint],
                None => speed,
            };
            let mut drive = match plan.drive {
                _ if plan.follows_input => self.drive_torque[joint],
                Drive::Position { .. } => {
                    let reading = self.own_reading(plant, joint, at);
                    plan.drive_torque_nm(input, reading, motor_speed, &self.memory.0)
                }
                _ => plan.drive_torque_nm(input, 0.0.into(), motor_speed, &self.memory.0),
            };
            if let Some(coupling) = plan.coupling {
                let auxiliary = &self.auxiliary;
                let flank = auxiliary.flank[joint];
                let passed_on = if coupling.has_rigid_flanks && flank != Flank::None {
                    drive
                } else {
                    let [wound, winding] = auxiliary.wound(joint, [at.angle[joint], speed]);
                    coupling.torque_on_nm(flank, wound, winding)
                };
                self.auxiliary.slope[joint] = (drive - passed_on) / coupling.inertia_kg_m2;
                drive = passed_on;
            }
            let mut state = JointState {
                angle_rad: at.angle[joint] - plant.zeros_rad[joint],
                speed_rad_s: speed,
                drive_nm: drive,
                signals: input.into(),
                shuffled_rad_s: input.shuffled_rad_s,
                memory: MemoryCell::EMPTY,
            };
            self.drive_torque[joint] = drive;
            self.torque[joint] = plan
                .torque
                .iter()
                .fold(drive + input.disturbance_nm, |sum, e| {
                    state.memory = e.recall(&self.memory.0);
                    sum + e.effect.torque(e.values(), &state)
                });
        }
        if plant.needs_gear_load {
            self.find_gear_loads(plant, at);
        }
        if plant.needs_bearing_load {
            self.find_bearing_loads(plant, at, out);
        }
        for (joint, &input) in inputs[..n].iter().enumerate() {
            if let Contact::Sliding(direction) = at.contact[joint] {
                let speed = (direction * at.speed[joint]).max(0.0);
                let friction =
                    self.friction_nm((plant, joint), input, [at.angle[joint], speed], direction);
                self.torque[joint] -= direction * friction;
            }
        }
    }

    /// Friction of a joint at this relative angle and speed and the loads found last, N m; at speed
    /// 0 the breakaway torque.
    pub fn friction_nm(
        &self,
        (plant, joint): (&Plant, usize),
        input: DriveInput,
        [angle_rad, speed_rad_s]: [f64; 2],
        direction: f64,
    ) -> f64 {
        let slide = FrictionState {
            angle_rad: angle_rad - plant.zeros_rad[joint],
            speed_rad_s,
            direction,
            gear_load_nm: (self.loads[joint] + self.drive_torque[joint]).abs(),
            motor_nm: self.drive_torque[joint],
            outside_nm: -self.loads[joint],
            bearing_load_n: self.bearing[joint],
            signals: input.into(),
        };
        plant.joints[joint]
            .friction
            .iter()
            .map(|e| e.effect.friction(e.values(), &slide))
            .sum::<f64>()
            .max(0.0)
    }

    #[inline]
    fn solve(&mut self, plant: &Plant, at: StateView<'_>, out: &mut [f64]) {
        let (angle, speed) = (at.angle, at.speed);
        if let Some((base, _)) = plant.base {
            return self.solve_on(base, plant, at, out);
        }
        if let Some(found) = R::forward(&self.closed, angle, speed, &self.torque, &self.held) {
            out.copy_from_slice(found.as_ref());
            return;
        }
        let joined = self.joined.as_deref();
        if let Some(tree) = joined.map_or(&plant.tree, |joined| &joined.tree) {
            let joints = [angle, speed, self.torque.as_ref()];
            return tree.forward(&mut self.spatial, joints, self.held.as_ref(), out);
        }
        chain(joined, plant).forward(
            &mut self.work,
            plant.base_m_s2,
            at.angle,
            at.speed,
            self.torque.as_ref(),
            self.held.as_ref(),
            out,
        );
    }

    /// The same where the base gives way; says how it does.
    fn solve_on(&mut self, base: BaseSpring, plant: &Plant, at: StateView<'_>, out: &mut [f64]) {
        let [place, speed] = self.auxiliary.base();
        let free = FreeBase {
            mass_kg: base.mass_kg,
            force_n: [0, 1].map(|k| base.force_n(place[k], speed[k])),
        };
        let acceleration_m_s2 = chain(self.joined.as_deref(), plant).forward_on(
            free,
            &mut self.work,
            plant.base_m_s2,
            at.angle,
            at.speed,
            self.torque.as_ref(),
            self.held.as_ref(),
            out,
        );
        self.auxiliary.speed_up_base(acceleration_m_s2);
    }

    /// Puts motors behind gears that give, and a base that gives way, where they are remembered to
    /// be.
    pub fn recall_auxiliary(
        &mut self,
        plant: &Plant,
        inputs: &[DriveInput],
        (angle, speed): (&[f64], &[f64]),
    ) {
        let mut cells = plant.joints.iter().filter_map(|plan| plan.gear_cell);
        if cells.any(|cell| !BodyState::from(self.memory.0[cell]).is_known()) {
            let contact = &[];
            let at = StateView {
                angle,
                speed,
                contact,
            };
            self.find_gear_loads(plant, at);
        }
        let (loads, memory) = (&self.loads, &self.memory);
        let holding_nm = |joint: usize| {
            if inputs[joint].energised {
                loads[joint]
            } else {
                0.0
            }
        };
        (self.auxiliary).recall(plant, memory, (angle, speed), holding_nm);
        self.auxiliary.find_flanks(plant, (angle, speed));
        self.join_motors(plant);
    }

    /// Torques that hold the chain against gravity and velocity coupling at zero acceleration: the
    /// outside torques with the other sign.
    fn find_gear_loads(&mut self, plant: &Plant, at: StateView<'_>) {
        if let Some(tree) = &plant.tree {
            let joints = [at.angle, at.speed, self.zeros.as_ref()];
            return tree.inverse(&mut self.spatial, joints, self.loads.as_mut(), |_, _| {});
        }
        plant.rig.chain.inverse(
            plant.rig.gravity_turn_rad,
            at.angle,
            at.speed,
            self.zeros.as_ref(),
            self.loads.as_mut(),
        );
    }

    /// Force in the bearings at the accelerations the chain has without friction.
    fn find_bearing_loads(&mut self, plant: &Plant, at: StateView<'_>, out: &mut [f64]) {
        self.solve(plant, at, out);
        for (slope, contact) in out.iter_mut().zip(at.contact) {
            if *contact == Contact::Held {
                *slope = 0.0;
            }
        }
        let bearing = &mut self.bearing;
        if let Some(tree) = &plant.tree {
            let joints = [at.angle, at.speed, &*out];
            let told = |joint, force_n| bearing[joint] = force_n;
            return tree.inverse(&mut self.spatial, joints, self.loads.as_mut(), told);
        }
        let (rig, joints) = (&plant.rig, [at.angle, at.speed, out]);
        let mut each = |joint, _, force: [f64; 2]| bearing[joint] = force[0].hypot(force[1]);
        rig.chain
            .newton_euler(rig.gravity_turn_rad, joints, &mut each);
    }
}

/// The planar chain as it is at present.
fn chain<'a>(joined: Option<&'a Joined>, plant: &'a Plant) -> &'a Chain {
    joined.map_or(&plant.rig.chain, |joined| &joined.chain)
}
