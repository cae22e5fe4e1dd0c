//! Whose inputs are that name no joint.

use super::columns::INPUTS;
use super::name::{NameGuess, Role};

/// Where the names tell of one joint's angle or speed, inputs that name no joint are that joint's;
/// so is the only input, whatever its name says: `shoulder_deg` with `motor_torque_nm` or `m1_tau`.
pub fn give_inputs(names: &mut [NameGuess]) {
    let is_input = |name: &NameGuess| INPUTS.iter().any(|(role, _)| name.role == Some(*role));
    let with = |role: Role| -> Vec<&String> {
        let mut joints: Vec<&String> = Vec::new();
        for name in names.iter().filter(|name| name.role == Some(role)) {
            if !joints.contains(&&name.joint) {
                joints.push(&name.joint);
            }
        }
        joints
    };
    let measured = match with(Role::Position) {
        angles if angles.is_empty() => with(Role::Velocity),
        angles => angles,
    };
    let [joint] = measured[..] else {
        return;
    };
    let joint = joint.clone();
    let only = names.iter().filter(|name| is_input(name)).count() == 1;
    for name in names.iter_mut().filter(|name| is_input(name)) {
        if only || name.joint.is_empty() {
            name.joint.clone_from(&joint);
        }
    }
}
