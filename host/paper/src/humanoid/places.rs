//! Where the humanoid's servos and joints are, from public descriptions of it.
//!
//! Distances between the axes, and where the servos sit beside them, are those of the Bioloid
//! Comprehensive humanoid by its CAD parts (`bioloid_compr_18_servos.xacro` of the public
//! `dxydas/ros-bioloid`), but for the two lengths that Table 1 prints: 143.6 mm from the bar to the
//! shoulder, and 115.8 mm from there to the hip, where the parts make 115.5. An AX-12 weighs
//! 53.5 g and is 32 x 50 x 38 mm without its horn (Robotis). Of the frames the shoulder's alone has
//! a public mass, 11.25 g (`bkop/BIOLOID_TYPE_A_DYN_MODEL_RTB`).

/// Height of the shoulders' axis over the bar in the handstand: Table 1, m.
pub(super) const SHOULDER_M: f64 = 0.1436;
/// From there to the hips' axis: Table 1, m.
pub(super) const HIP_M: f64 = 0.1158;
/// Mass of an AX-12, kg.
pub(super) const SERVO_KG: f64 = 0.0535;

/// Heights over the shoulders' axis, m.
const HIPS: f64 = HIP_M;
const KNEES: f64 = HIP_M + 0.075;
const ANKLES: f64 = HIP_M + 0.146;
/// From a servo's axis to its centre, m.
const BODY: f64 = 0.0135;

/// Sizes of a servo by what its horn points at, x from hand to hand, z up, m.
const HORN_ASIDE: [f64; 3] = [0.038, 0.032, 0.050];
const HORN_ASIDE_LYING: [f64; 3] = [0.038, 0.050, 0.032];
const HORN_FORWARD: [f64; 3] = [0.032, 0.038, 0.050];
const HORN_UP: [f64; 3] = [0.032, 0.050, 0.038];

/// A box of the robot's left half; the right one mirrors it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SidePart {
    /// Of a servo: its number on the right; the left one's is one more.
    pub servo: Option<u8>,
    /// The link it is fixed to: of this side, but for the torso.
    pub link: &'static str,
    /// Its centre: aside, forward, and over the shoulders' axis, m.
    pub at_m: [f64; 3],
    /// Its size, m.
    pub size_m: [f64; 3],
    /// Its mass, kg.
    pub mass_kg: f64,
}

const fn servo(right: u8, link: &'static str, at_m: [f64; 3], size_m: [f64; 3]) -> SidePart {
    SidePart {
        servo: Some(right),
        link,
        at_m,
        size_m,
        mass_kg: SERVO_KG,
    }
}

/// A frame between two servos whose axes cross.
const fn frame(link: &'static str, at_m: [f64; 3]) -> SidePart {
    SidePart {
        servo: None,
        link,
        at_m,
        size_m: [0.03; 3],
        mass_kg: 0.01125,
    }
}

/// Servos, and the frames without which a link would weigh nothing; the hip's is taken to weigh as
/// much as the shoulder's.
pub(super) const PARTS: [SidePart; 11] = [
    servo(1, "torso", [0.032, 0.0, BODY], HORN_ASIDE),
    servo(3, "upper_arm", [0.076, 0.0, -0.014 - BODY], HORN_FORWARD),
    servo(5, "lower_arm", [0.076, 0.0, -0.0815 - BODY], HORN_FORWARD),
    servo(7, "torso", [0.033, -0.0025, 0.0655], HORN_UP),
    servo(9, "pelvis", [0.033, -0.032, HIPS + BODY], HORN_FORWARD),
    servo(11, "pelvis", [0.033, 0.0, HIPS + BODY], HORN_ASIDE),
    servo(13, "shank", [0.033, -0.001, KNEES], HORN_ASIDE_LYING),
    servo(15, "ankle", [0.033, 0.0, ANKLES - BODY], HORN_ASIDE),
    servo(17, "ankle", [0.033, -0.032, ANKLES - BODY], HORN_FORWARD),
    frame("shoulder", [0.070, 0.0, -0.006]),
    frame("hip", [0.033, -0.016, 0.1065]),
];

/// A joint of the robot's left half; the right one mirrors its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct SideJoint {
    pub name: &'static str,
    /// The links it joins: nearer to the torso, and farther.
    pub links: [&'static str; 2],
    /// As of a [`SidePart`], m.
    pub at_m: [f64; 3],
    /// Its axis in the handstand.
    pub axis: [f64; 3],
}

const fn joint(
    name: &'static str,
    links: [&'static str; 2],
    at_m: [f64; 3],
    axis: [f64; 3],
) -> SideJoint {
    SideJoint {
        name,
        links,
        at_m,
        axis,
    }
}

const ASIDE: [f64; 3] = [1.0, 0.0, 0.0];
const FORWARD: [f64; 3] = [0.0, 1.0, 0.0];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// From the torso to a hand.
pub(super) const ARM: [SideJoint; 3] = [
    joint(
        "shoulder_pitch",
        ["torso", "shoulder"],
        [0.032, 0.0, 0.0],
        ASIDE,
    ),
    joint(
        "shoulder_roll",
        ["shoulder", "upper_arm"],
        [0.076, 0.0, -0.014],
        FORWARD,
    ),
    joint(
        "elbow",
        ["upper_arm", "lower_arm"],
        [0.076, 0.0, -0.0815],
        FORWARD,
    ),
];

/// From the torso to a foot.
pub(super) const LEG: [SideJoint; 6] = [
    joint("hip_yaw", ["torso", "hip"], [0.033, -0.016, 0.0655], UP),
    joint(
        "hip_roll",
        ["hip", "pelvis"],
        [0.033, -0.032, HIPS],
        FORWARD,
    ),
    joint("hip_pitch", ["pelvis", "thigh"], [0.033, 0.0, HIPS], ASIDE),
    joint("knee", ["thigh", "shank"], [0.033, -0.0145, KNEES], ASIDE),
    joint(
        "ankle_pitch",
        ["shank", "ankle"],
        [0.033, 0.0, ANKLES],
        ASIDE,
    ),
    joint(
        "ankle_roll",
        ["ankle", "foot"],
        [0.033, -0.032, ANKLES],
        FORWARD,
    ),
];

/// One of the three links of Table 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockPlace {
    pub name: &'static str,
    /// The links it consists of.
    pub links: &'static [&'static str],
    /// From where to where it reaches over the shoulders' axis, m.
    pub reach_m: [f64; 2],
    /// The links that carry the lower and the upper half of the rest, and how far aside, m; in the
    /// middle they are not halved.
    pub carried_by: [(&'static str, f64); 2],
    /// Edge of these two parts, m.
    pub edge_m: f64,
}

/// Arms to the fingers' tips, torso from the head to the servos of the hips, legs to the soles.
pub(super) const BLOCKS: [BlockPlace; 3] = [
    BlockPlace {
        name: "arms",
        links: &["shoulder", "upper_arm", "lower_arm"],
        reach_m: [-0.180, 0.0],
        carried_by: [("lower_arm", 0.076), ("upper_arm", 0.076)],
        edge_m: 0.03,
    },
    BlockPlace {
        name: "torso",
        links: &["torso", "hip", "pelvis"],
        reach_m: [-0.057, 0.1545],
        carried_by: [("torso", 0.0), ("torso", 0.0)],
        edge_m: 0.06,
    },
    BlockPlace {
        name: "legs",
        links: &["thigh", "shank", "ankle", "foot"],
        reach_m: [HIP_M, HIP_M + 0.184],
        carried_by: [("thigh", 0.033), ("foot", 0.033)],
        edge_m: 0.03,
    },
];

impl BlockPlace {
    /// What is known of its left half.
    pub fn parts(&self) -> impl Iterator<Item = &'static SidePart> + use<> {
        let links = self.links;
        PARTS.iter().filter(move |part| links.contains(&part.link))
    }
}
