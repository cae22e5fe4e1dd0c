//! A law that was read, and its value.

use super::super::{FrictionState, JointState, Signals};
use super::syntax::LawFunction;

/// What a law sees of its joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    angle_rad: f64,
    speed_rad_s: f64,
    direction: f64,
    drive_nm: f64,
    signals: Signals,
}

impl From<&JointState> for Sight {
    fn from(at: &JointState) -> Sight {
        let speed_rad_s = at.speed_rad_s;
        Sight {
            angle_rad: at.angle_rad,
            speed_rad_s,
            direction: if speed_rad_s == 0.0 {
                0.0
            } else {
                speed_rad_s.signum()
            },
            drive_nm: at.drive_nm,
            signals: at.signals,
        }
    }
}

impl From<&FrictionState> for Sight {
    fn from(at: &FrictionState) -> Sight {
        Sight {
            angle_rad: at.angle_rad,
            speed_rad_s: at.direction * at.speed_rad_s,
            direction: at.direction,
            drive_nm: at.motor_nm,
            signals: at.signals,
        }
    }
}

/// What joins two parts.
pub(super) type LawOperator = fn(f64, f64) -> f64;

/// What a name of a law stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Slot {
    Angle,
    Speed,
    Direction,
    Drive,
    Input,
    Supply,
    Time,
    Value(usize),
}

/// A part of a law; others are named by their place, which is before its own.
#[derive(Debug, Clone, Copy)]
pub(super) enum Node {
    Number(f64),
    Slot(Slot),
    Call(LawFunction, usize),
    Join(LawOperator, usize, usize),
}

/// A law as its parts. The last one is its value.
#[derive(Debug, Clone, Default)]
pub(super) struct Program {
    nodes: Vec<Node>,
}

impl Program {
    /// Adds a part; its place.
    pub fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Whether a name occurs.
    pub fn has(&self, slot: Slot) -> bool {
        let is = |node: &Node| matches!(node, Node::Slot(own) if *own == slot);
        self.nodes.iter().any(is)
    }

    /// The torque, N m; not a number where the law has no value.
    pub fn value(&self, values: &[f64], at: &Sight) -> f64 {
        self.nodes
            .len()
            .checked_sub(1)
            .map_or(f64::NAN, |last| self.part(last, values, at))
    }

    fn part(&self, place: usize, values: &[f64], at: &Sight) -> f64 {
        match self.nodes[place] {
            Node::Number(value) => value,
            Node::Slot(Slot::Angle) => at.angle_rad,
            Node::Slot(Slot::Speed) => at.speed_rad_s,
            Node::Slot(Slot::Direction) => at.direction,
            Node::Slot(Slot::Drive) => at.drive_nm,
            Node::Slot(Slot::Input) => at.signals.input,
            Node::Slot(Slot::Supply) => at.signals.supply_ratio,
            Node::Slot(Slot::Time) => at.signals.time_s,
            Node::Slot(Slot::Value(index)) => values.get(index).copied().unwrap_or(f64::NAN),
            Node::Call(function, argument) => function(self.part(argument, values, at)),
            Node::Join(apply, left, right) => {
                apply(self.part(left, values, at), self.part(right, values, at))
            }
        }
    }
}
