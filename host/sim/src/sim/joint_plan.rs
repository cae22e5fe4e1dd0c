//! What acts on one joint, sorted by where it acts.

use crate::effects::{BodyState, Coupling, Effect, Gear, MemoryCell, Site, StartUnknown};
use crate::model::Drive;

/// Most values an effect has.
const MOST_VALUES: usize = 4;

/// An effect with its values, stored in place.
#[derive(Debug, Clone, Copy)]
pub(super) struct ActiveEffect {
    pub effect: Effect,
    values: [f64; MOST_VALUES],
    count: usize,
    /// Place of what it remembers, if it does.
    pub cell: Option<usize>,
}

impl ActiveEffect {
    #[inline]
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }

    /// What no reading tells of where it begins.
    pub fn start_unknown(&self) -> Option<StartUnknown> {
        self.effect.start_unknown(self.values())
    }

    /// What it remembers, among the cells of the plant.
    #[inline]
    pub fn recall(&self, cells: &[MemoryCell]) -> MemoryCell {
        self.cell.map_or(MemoryCell::EMPTY, |cell| cells[cell])
    }
}

/// What acts on one joint.
#[derive(Debug, Clone)]
pub(super) struct JointPlan {
    pub drive: Drive,
    pub full_torque_nm: f64,
    /// Whether the drive's torque follows from its input alone.
    pub follows_input: bool,
    pub delay_s: f64,
    /// Where what it does depends on the input before the log: whether it gets from that to its
    /// input slowly, not only late.
    pub depends_on_input_before: Option<bool>,
    pub command: Vec<ActiveEffect>,
    pub torque: Vec<ActiveEffect>,
    pub friction: Vec<ActiveEffect>,
    pub output: Vec<ActiveEffect>,
    pub gear: Gear,
    /// The motor and its gear, where they turn apart from the joint.
    pub coupling: Option<Coupling>,
    /// Place of how far the gear is wound up, where there is a coupling.
    pub gear_cell: Option<usize>,
    /// Longest step that follows the motor while it turns by itself between rigid flanks, s;
    /// infinite where it does not.
    pub motor_step_s: f64,
    pub encode: Vec<ActiveEffect>,
    pub sense: Vec<ActiveEffect>,
    /// By how much later than the sensor read it the log holds a reading, s.
    pub offset_s: f64,
    /// What a sensor of rates reads at rest, rad/s, and per rate beyond that.
    pub rate_bias_rad_s: f64,
    pub rate_scale: f64,
    /// What a rate is read through, with memory.
    pub rate_sense: Vec<ActiveEffect>,
}

impl JointPlan {
    pub fn ideal(drive: &Drive) -> JointPlan {
        JointPlan {
            drive: drive.clone(),
            full_torque_nm: drive.motor().map_or(1.0, |m| m.stall_torque_nm),
            follows_input: false,
            delay_s: 0.0,
            depends_on_input_before: None,
            command: Vec::new(),
            torque: Vec::new(),
            friction: Vec::new(),
            output: Vec::new(),
            gear: Gear::RIGID,
            coupling: None,
            gear_cell: None,
            motor_step_s: f64::INFINITY,
            encode: Vec::new(),
            sense: Vec::new(),
            offset_s: 0.0,
            rate_bias_rad_s: 0.0,
            rate_scale: 1.0,
            rate_sense: Vec::new(),
        }
    }

    /// Whether friction or a torque that follows angle and speed acts on the joint.
    pub fn has_joint_effects(&self) -> bool {
        !self.torque.is_empty() || !self.friction.is_empty()
    }

    /// Whether nothing but its input and the direction in which it slides changes its torque.
    pub fn torque_stays(&self) -> bool {
        let constant = |e: &ActiveEffect| e.effect.friction_is_constant();
        self.follows_input && self.torque.is_empty() && self.friction.iter().all(constant)
    }

    fn add_gear(&mut self, effect: Effect, values: &[f64]) {
        effect.gear(values, &mut self.gear);
        self.coupling = Coupling::of(&self.gear);
    }

    /// Gives the gear and each effect that remembers a cell from `next` on; the place behind the
    /// last.
    pub fn place_memory(&mut self, mut next: usize) -> usize {
        let lists = [&mut self.command, &mut self.output, &mut self.torque];
        for e in lists.into_iter().flatten().filter(|e| e.effect.remembers()) {
            e.cell = Some(next);
            next += 1;
        }
        if self.coupling.is_some() {
            self.gear_cell = Some(next);
            next += 1;
        }
        next
    }

    /// Effects that remember, with the places of their cells.
    pub fn remembering(&self) -> impl Iterator<Item = (&ActiveEffect, usize)> {
        let lists = [&self.command, &self.output, &self.torque];
        lists
            .into_iter()
            .flatten()
            .filter_map(|e| Some((e, e.cell?)))
    }

    /// Leaves those sensors that a rate is read through, where nothing else is read.
    pub fn keep_rate_sensors(&mut self) {
        self.sense
            .retain(|e| e.effect.trail_rad(e.values(), 1.0).is_some());
        self.sense.append(&mut self.rate_sense);
    }

    /// Its gear where flanks that do not give carry the motor along whenever they push.
    pub fn rigid_flanks(&self) -> Option<Coupling> {
        self.coupling.filter(|coupling| coupling.has_rigid_flanks)
    }

    /// Speed of the motor, rad/s, where the joint has this one.
    pub fn motor_speed_rad_s(&self, cells: &[MemoryCell], joint_rad_s: f64) -> f64 {
        let winding = |cell: usize| BodyState::from(cells[cell]).speed;
        let winding_rad_s = self.gear_cell.map_or(0.0, winding);
        let is_known = !winding_rad_s.is_nan();
        joint_rad_s + if is_known { winding_rad_s } else { 0.0 }
    }

    /// Change of the encoder's reading per change of the joint's angle.
    pub fn reading_slope(&self) -> f64 {
        if self.encode.is_empty() {
            return 1.0;
        }
        self.line(1.0) - self.line(0.0)
    }

    /// What the encoder reads at an angle: a straight line, so that two points tell all of it.
    pub fn line(&self, angle_rad: f64) -> f64 {
        let effects = self.encode.iter();
        effects.fold(angle_rad, |angle, e| e.effect.encode(e.values(), angle))
    }

    /// Adds an effect of the sensor where it is: a shaft may slip or have play, and what comes of
    /// it is filtered, whatever order a model names them in.
    fn add_sensor(&mut self, active: ActiveEffect) {
        let filters = |e: &ActiveEffect| e.effect.trail_rad(e.values(), 1.0).is_some();
        let before = if filters(&active) {
            None
        } else {
            self.sense.iter().position(filters)
        };
        self.sense
            .insert(before.unwrap_or(self.sense.len()), active);
    }

    pub fn add(&mut self, effect: Effect, values: &[f64]) {
        let mut active = ActiveEffect {
            effect,
            values: [0.0; MOST_VALUES],
            count: values.len(),
            cell: None,
        };
        active.values[..values.len()].copy_from_slice(values);
        if let Some(StartUnknown::Input { is_slow }) = effect.start_unknown(values) {
            let known = self.depends_on_input_before.unwrap_or(false);
            self.depends_on_input_before = Some(known || is_slow);
        }
        match effect.info().site {
            Site::Timing => self.delay_s += effect.delay_s(values),
            Site::Command => self.command.push(active),
            Site::Drive => self.output.push(active),
            Site::Gear => self.add_gear(effect, values),
            Site::Friction => self.friction.push(active),
            Site::Joint => self.torque.push(active),
            Site::Body => {}
            Site::Encoder => self.encode.push(active),
            Site::Sensor => match effect.reading_offset_s(values) {
                Some(offset_s) => self.offset_s += offset_s,
                None => self.add_sensor(active),
            },
            Site::Rate => {
                self.rate_bias_rad_s += effect.rate_bias_rad_s(values);
                self.rate_scale *= effect.rate_scale(values);
                if effect.trail_rad(values, 1.0).is_some() {
                    self.rate_sense.push(active);
                }
            }
        }
    }
}
