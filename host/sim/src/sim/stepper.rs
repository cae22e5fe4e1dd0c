//! One integration step with friction that truly sticks.
//!
//! Between events every joint is free, sliding in a known direction, or held; the equations are
//! then smooth and classical Runge-Kutta of fourth order integrates them. A sliding joint whose
//! speed crosses zero ends the step there, and so does a held joint where the torque that holds it
//! exceeds the breakaway torque; it then slides. So do flanks of a gear that meet or part.

use super::auxiliary::Auxiliary;
use super::drive::DriveInput;
use super::forces::{Forces, StateView};
use super::memory::EffectMemory;
use super::plant::Plant;
use super::rows::Rows;
use crate::dynamics::RungeKutta;
use crate::effects::MemoryCell;
use crossing::Crossing;

/// Chatter between contacts can't go on for ever: after so many events the rest of a step is taken
/// as it comes.
const MOST_EVENTS: usize = 8;
/// No time at all, s.
const NO_SPAN_S: f64 = 1e-12;

/// Into how many steps of what length, s, a span is cut by the longest step.
#[inline]
pub(super) fn steps(span_s: f64, longest_s: f64) -> (usize, f64) {
    let steps = (span_s / longest_s - 1e-6).ceil().max(1.0);
    (steps as usize, span_s / steps)
}

/// How friction acts on a joint until the next event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Contact {
    /// No friction at all.
    Free,
    /// Sliding in this direction, +1 or -1.
    Sliding(f64),
    /// At rest, held.
    Held,
}

/// A change of contact within a step.
#[derive(Debug, Clone, Copy)]
struct Event {
    joint: usize,
    /// Of the joint's speed, or of how much it is pushed beyond its breakaway torque.
    crossing: Crossing,
    /// What the contact is from then on.
    contact: Contact,
}

impl Event {
    fn between(joint: usize, ends: [f64; 2], contact: Contact) -> Event {
        Event {
            joint,
            crossing: Crossing::between(ends),
            contact,
        }
    }

    fn by_share(a: &Event, b: &Event) -> std::cmp::Ordering {
        a.crossing.share.total_cmp(&b.crossing.share)
    }
}

/// State of a simulation; `R` says how its rows of one number per joint are kept.
#[derive(Debug, Clone)]
pub(super) struct Stepper<R: Rows> {
    pub angle: R::Of<f64>,
    pub speed: R::Of<f64>,
    contact: R::Of<Contact>,
    forces: Forces<R>,
    runge_kutta: RungeKutta<R::Of<f64>>,
    /// The same for joints and the bodies beside the links together, and their places, speeds and
    /// accelerations.
    with_auxiliary: RungeKutta<Vec<f64>>,
    together: [Vec<f64>; 3],
    start_angle: R::Of<f64>,
    start_speed: R::Of<f64>,
    start_auxiliary: Auxiliary,
    /// By how much each gear's flanks were pressed where the step began.
    start_pressed: R::Of<f64>,
    /// Accelerations, and for held joints the torque that holds them.
    slope: R::Of<f64>,
    /// Whether those, and the excess, are of the present state, contacts and inputs.
    slope_is_known: bool,
    /// By how much held joints are pushed beyond their breakaway torque, N m, when last looked at.
    excess: R::Of<f64>,
    /// The same where the step began.
    start_excess: R::Of<f64>,
    /// Inputs as the drives follow them, where effects remember.
    obeyed: Vec<DriveInput>,
    /// The inputs last followed.
    followed: Vec<DriveInput>,
}

impl<R: Rows> Stepper<R> {
    /// At these relative angles and speeds; joints at speed 0 begin held if anything holds them.
    pub fn new(plant: &Plant, angle: &[f64], speed: &[f64]) -> Self {
        let n = plant.len();
        let zeros = || R::filled(0.0, n);
        let together = vec![0.0; n + plant.auxiliary_bodies()];
        let mut stepper: Self = Stepper {
            angle: zeros(),
            speed: zeros(),
            contact: R::filled(Contact::Free, n),
            forces: Forces::new(plant),
            runge_kutta: RungeKutta::new(zeros()),
            with_auxiliary: RungeKutta::new(together.clone()),
            together: std::array::from_fn(|_| together.clone()),
            start_angle: zeros(),
            start_speed: zeros(),
            start_auxiliary: Auxiliary::new(plant),
            start_pressed: zeros(),
            slope: zeros(),
            slope_is_known: false,
            excess: zeros(),
            start_excess: zeros(),
            obeyed: Vec::new(),
            followed: Vec::new(),
        };
        stepper.forces.memory = EffectMemory::beginning(plant, angle, speed);
        stepper.forces.find_kicks(plant, angle);
        for (joint, plan) in plant.joints.iter().enumerate() {
            stepper.angle[joint] = angle[joint];
            stepper.speed[joint] = speed[joint];
            stepper.contact[joint] = match (plan.friction.is_empty(), speed[joint]) {
                (true, _) => Contact::Free,
                (false, 0.0) => Contact::Held,
                (false, speed) => Contact::Sliding(speed.signum()),
            };
        }
        stepper
    }

    /// Number of joints.
    #[inline]
    fn len(&self) -> usize {
        self.angle.as_ref().len()
    }

    /// Angles and speeds.
    #[inline]
    pub fn state(&self) -> (&[f64], &[f64]) {
        (self.angle.as_ref(), self.speed.as_ref())
    }

    /// What the effects remember.
    pub fn memory(&mut self) -> &mut EffectMemory {
        &mut self.forces.memory
    }

    /// The cells of the effects that remember.
    pub fn remembered(&self) -> &[MemoryCell] {
        &self.forces.memory.0
    }

    /// Advances by `step_s` under constant inputs.
    #[inline]
    pub fn advance(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64) {
        if plant.remembers == 0 {
            return self.advance_bodies(plant, inputs, step_s);
        }
        let mut obeyed = std::mem::take(&mut self.obeyed);
        obeyed.clear();
        obeyed.extend_from_slice(inputs);
        self.forces.memory.obey(plant, &mut obeyed, step_s);
        let state = (self.angle.as_ref(), self.speed.as_ref());
        self.forces.recall_auxiliary(plant, &obeyed, state);
        // Short enough for motors and base, so that knocks are not stepped over.
        let (steps, h) = steps(step_s, plant.auxiliary_step_s);
        for _ in 0..steps {
            self.advance_bodies(plant, &obeyed, h);
        }
        self.obeyed = obeyed;
        let state = (self.angle.as_ref(), self.speed.as_ref());
        let Forces {
            auxiliary, memory, ..
        } = &mut self.forces;
        auxiliary.remember(plant, memory, state);
        memory.remember(plant, inputs, state, step_s);
    }

    /// Advances by `step_s` under inputs that the drives follow at once.
    fn advance_bodies(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64) {
        let mut left = step_s;
        self.follow(plant, inputs);
        let mut events = 0;
        // Where the state is lost what is left is no number, and this ends, too.
        while left > NO_SPAN_S && events < MOST_EVENTS {
            self.part_pulled(plant, inputs);
            self.release(plant, inputs);
            self.start_angle.clone_from(&self.angle);
            self.start_speed.clone_from(&self.speed);
            self.start_auxiliary.copy_motion(&self.forces.auxiliary);
            self.start_excess.clone_from(&self.excess);
            let taken = self.step_to_knock(plant, inputs, left);
            left -= taken.span_s;
            if let Some(event) = self.first_event(plant, inputs) {
                left += self.go_to(plant, inputs, event, taken.span_s);
                events += 1;
            } else if let Some(joint) = taken.knock {
                self.meet_or_part(plant, joint);
                events += 1;
            }
        }
        if events < MOST_EVENTS || left <= NO_SPAN_S {
            return;
        }
        self.part_pulled(plant, inputs);
        self.release(plant, inputs);
        while left > NO_SPAN_S {
            let h = left.min(self.motors_step_s(plant));
            self.step(plant, inputs, h);
            left -= h;
        }
        for joint in 0..self.len() {
            if self.stopped(joint) {
                self.stop(joint);
            }
        }
        self.slope_is_known = false;
    }

    /// Goes back to the event in a step of `span_s` s, and on with what it makes of the contact;
    /// how much of the step is left, s.
    fn go_to(&mut self, plant: &Plant, inputs: &[DriveInput], event: Event, span_s: f64) -> f64 {
        self.step_again(plant, inputs, event.crossing.share * span_s);
        let crossing = (event.crossing).bent(self.crossed(plant, inputs, event));
        self.step_again(plant, inputs, crossing.share * span_s);
        if event.contact == Contact::Held {
            self.stop(event.joint);
        }
        self.contact[event.joint] = event.contact;
        span_s * (1.0 - crossing.share)
    }

    /// Takes another step from where the last one began.
    fn step_again(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64) {
        // What is known is of the step's end.
        self.slope_is_known = false;
        self.angle.clone_from(&self.start_angle);
        self.speed.clone_from(&self.start_speed);
        self.forces.auxiliary.copy_motion(&self.start_auxiliary);
        self.step(plant, inputs, step_s);
    }

    /// What an event's zero is of, at the present state.
    fn crossed(&mut self, plant: &Plant, inputs: &[DriveInput], event: Event) -> f64 {
        match event.contact {
            Contact::Held => self.speed[event.joint],
            Contact::Free | Contact::Sliding(_) => {
                self.find_excess(plant, inputs);
                self.excess[event.joint]
            }
        }
    }

    /// Takes what follows from the inputs alone; the same inputs leave all as it is.
    #[inline]
    fn follow(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        if plant.remembers == 0 && self.followed == inputs {
            return;
        }
        self.forces.command(plant, inputs);
        self.slope_is_known = false;
        self.followed.clear();
        self.followed.extend_from_slice(inputs);
    }

    /// Whether friction holds every joint.
    #[inline]
    fn rests(&self) -> bool {
        let mut contacts = self.contact.as_ref().iter();
        contacts.all(|contact| *contact == Contact::Held)
    }

    fn stopped(&self, joint: usize) -> bool {
        let speed = self.speed[joint];
        matches!(self.contact[joint], Contact::Sliding(direction) if direction * speed < 0.0)
    }

    /// What first changes a contact in the step just taken.
    #[inline]
    fn first_event(&mut self, plant: &Plant, inputs: &[DriveInput]) -> Option<Event> {
        let stop = self.first_stop();
        let release = self.first_release(plant, inputs);
        match (stop, release) {
            (Some(stop), Some(release)) if release.crossing.share < stop.crossing.share => {
                Some(release)
            }
            (stop, release) => stop.or(release),
        }
    }

    /// The joint whose speed first crosses zero.
    fn first_stop(&self) -> Option<Event> {
        (0..self.len())
            .filter(|&joint| self.stopped(joint))
            .map(|joint| {
                let ends = [self.start_speed[joint], self.speed[joint]];
                Event::between(joint, ends, Contact::Held)
            })
            .min_by(Event::by_share)
    }

    /// The held joint that the motion of others, its own gear that is wound up, or the base first
    /// pushes beyond its breakaway torque.
    fn first_release(&mut self, plant: &Plant, inputs: &[DriveInput]) -> Option<Event> {
        let is_held = |contact: &Contact| *contact == Contact::Held;
        let moves = !self.rests() || plant.has_auxiliary();
        if !moves || !self.contact.as_ref().iter().any(is_held) {
            return None;
        }
        if !self.slope_is_known {
            self.find_excess(plant, inputs);
        }
        (0..self.len())
            .filter(|&joint| is_held(&self.contact[joint]) && self.excess[joint] > 0.0)
            .map(|joint| {
                let ends = [self.start_excess[joint], self.excess[joint]];
                Event::between(joint, ends, Contact::Sliding(self.push_direction(joint)))
            })
            .min_by(Event::by_share)
    }

    /// Lets go of held joints that are pushed beyond their breakaway torque, the most pushed first.
    fn release(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        while self.contact.as_ref().contains(&Contact::Held) {
            if !self.slope_is_known {
                self.find_excess(plant, inputs);
            }
            let pushed = (0..self.len())
                .filter(|&joint| self.contact[joint] == Contact::Held)
                .max_by(|a, b| self.excess[*a].total_cmp(&self.excess[*b]));
            match pushed {
                Some(joint) if self.excess[joint] > 0.0 => {
                    self.contact[joint] = Contact::Sliding(self.push_direction(joint));
                    self.slope_is_known = false;
                }
                _ => return,
            }
        }
    }

    /// By how much held joints are pushed beyond their breakaway torque at the present state, and
    /// all accelerations there.
    fn find_excess(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        let (angle, speed) = (self.angle.as_ref(), self.speed.as_ref());
        let contact = self.contact.as_ref();
        let at = StateView {
            angle,
            speed,
            contact,
        };
        self.forces
            .accelerate(plant, inputs, at, self.slope.as_mut());
        for joint in 0..angle.len() {
            if contact[joint] == Contact::Held {
                let push = -self.slope[joint];
                let at_rest = [angle[joint], 0.0];
                let (place, input) = ((plant, joint), inputs[joint]);
                let breakaway = (self.forces).friction_nm(place, input, at_rest, push.signum());
                self.excess[joint] = push.abs() - breakaway;
            }
        }
        self.slope_is_known = true;
    }

    /// Where a held joint is pushed, +1 or -1.
    fn push_direction(&self, joint: usize) -> f64 {
        (-self.slope[joint]).signum()
    }
}

mod crossing;
mod integration;
mod knocks;
#[cfg(test)]
mod tests;
