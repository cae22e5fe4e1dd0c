//! The humanoid as a URDF file: hands on the bar, stretched upwards.

use super::block::Block;
use super::places::{ARM, LEG, PARTS, SHOULDER_M, SideJoint};
use std::collections::HashMap;
use std::fmt::Write;

/// Between which angles an AX-12 turns, rad; its stall torque, N m, and fastest speed, rad/s.
const LIMITS: &str = r#"<limit lower="-2.618" upper="2.618" effort="1.5" velocity="6.18"/>"#;

const HEAD: &str = r#"<?xml version="1.0"?>
<!-- The Bioloid humanoid with its 18 servos, hands on the bar, stretched upwards. `handstand paper`
     says how it becomes the three links of the paper's Table 1, and what of it is estimated: the
     parts named _low and _high are all whose weight is not public, where Table 1 leaves them. -->
<robot name="humanoid">
"#;

/// From the right hand to the left: their signs aside.
const SIDES: [(&str, f64); 2] = [("right", -1.0), ("left", 1.0)];

/// A joint of the whole robot, in the handstand's frame.
struct WholeJoint {
    name: String,
    links: [String; 2],
    at_m: [f64; 3],
    axis: [f64; 3],
}

/// A link's name on a side; there is one torso.
fn on_side(side: &str, link: &str) -> String {
    match link {
        "torso" => link.to_string(),
        _ => format!("{side}_{link}"),
    }
}

/// A place over the shoulders' axis, mirrored to a side, up from the bar.
fn placed(sign: f64, [aside, forward, height]: [f64; 3]) -> [f64; 3] {
    [sign * aside, forward, SHOULDER_M + height]
}

/// All joints, each behind the one that carries it: from the bar by the right arm to the torso, and
/// from there to the other limbs. The right arm's are passed from the hand.
fn joints() -> Vec<WholeJoint> {
    let on = |(side, sign): (&str, f64), joint: &SideJoint| WholeJoint {
        name: format!("{side}_{}", joint.name),
        links: joint.links.map(|link| on_side(side, link)),
        at_m: placed(sign, joint.at_m),
        axis: joint.axis,
    };
    let [right, left] = SIDES;
    let mut all: Vec<WholeJoint> = ARM.iter().rev().map(|joint| on(right, joint)).collect();
    all.iter_mut().for_each(|joint| joint.links.reverse());
    all.extend(ARM.iter().map(|joint| on(left, joint)));
    for side in SIDES {
        all.extend(LEG.iter().map(|joint| on(side, joint)));
    }
    all
}

/// The file. A servo, or a part of what is none, is a body of its own, fixed to a link. The left
/// hand closes no loop: it stands beside the bar.
pub(super) fn urdf(blocks: &[Block]) -> String {
    let mut out = HEAD.to_string();
    let hand = "right_lower_arm".to_string();
    out += "  <link name=\"bar\"/>\n";
    out += "  <joint name=\"bar\" type=\"continuous\">\n";
    let _ = writeln!(out, "    <parent link=\"bar\"/><child link=\"{hand}\"/>");
    out += "    <axis xyz=\"1 0 0\"/>\n  </joint>\n";
    let _ = writeln!(out, "  <link name=\"{hand}\"/>");
    let mut frames = HashMap::from([(hand, [0.0; 3])]);
    for joint in joints() {
        let [parent, child] = &joint.links;
        let name = &joint.name;
        let at = from(frames.get(parent), joint.at_m);
        let _ = writeln!(out, "  <joint name=\"{name}\" type=\"revolute\">");
        let _ = writeln!(
            out,
            "    <parent link=\"{parent}\"/><child link=\"{child}\"/>"
        );
        let axis = joint.axis.map(|along| along.to_string()).join(" ");
        let _ = writeln!(out, "    <origin xyz=\"{at}\"/><axis xyz=\"{axis}\"/>");
        let _ = writeln!(out, "    {LIMITS}\n  </joint>\n  <link name=\"{child}\"/>");
        frames.insert(child.clone(), joint.at_m);
    }
    for body in bodies(blocks) {
        body.write(frames.get(&body.link), &mut out);
    }
    out + "</robot>\n"
}

/// A place, m, seen from a link's frame.
fn from(frame_m: Option<&[f64; 3]>, at_m: [f64; 3]) -> String {
    let frame_m = frame_m.copied().unwrap_or_default();
    let seen = [0, 1, 2].map(|axis| number(at_m[axis] - frame_m[axis]));
    seen.join(" ")
}

/// To a hundredth of a micrometre, without zeros behind.
fn number(value: f64) -> String {
    let text = format!("{value:.8}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_string()
}

/// A box that is fixed to a link, its centre in the handstand's frame.
struct Body {
    name: String,
    link: String,
    at_m: [f64; 3],
    size_m: [f64; 3],
    mass_kg: f64,
}

impl Body {
    /// Writes it as a link of its own, seen from the frame of the one that carries it.
    fn write(&self, frame_m: Option<&[f64; 3]>, out: &mut String) {
        let Body { name, link, .. } = self;
        let mass = number(self.mass_kg);
        let [x, y, z] = self.size_m;
        let about = |a: f64, b: f64| format!("{:.6e}", self.mass_kg * (a * a + b * b) / 12.0);
        let (xx, yy, zz) = (about(y, z), about(x, z), about(x, y));
        let size = self.size_m.map(number).join(" ");
        let at = from(frame_m, self.at_m);
        let _ = write!(
            out,
            r#"  <link name="{name}">
    <inertial><mass value="{mass}"/>
      <inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="{size}"/></geometry></visual>
  </link>
  <joint name="{name}" type="fixed">
    <parent link="{link}"/><child link="{name}"/><origin xyz="{at}"/>
  </joint>
"#
        );
    }
}

/// All that weighs something.
fn bodies(blocks: &[Block]) -> Vec<Body> {
    let mut all = Vec::new();
    for (side, sign) in SIDES {
        all.extend(PARTS.iter().map(|part| {
            let link = on_side(side, part.link);
            Body {
                name: match part.servo {
                    Some(right) => format!("servo_{}", right + u8::from(sign > 0.0)),
                    None => format!("{link}_frame"),
                },
                link,
                at_m: placed(sign, part.at_m),
                size_m: part.size_m,
                mass_kg: part.mass_kg,
            }
        }));
    }
    all.extend(blocks.iter().flat_map(rest));
    all
}

/// The rest of a block: two parts, halved between the sides.
fn rest(block: &Block) -> Vec<Body> {
    let forward = block.rest.com_m[0];
    let mut all = Vec::new();
    let parts = block.place.carried_by.iter().zip(["low", "high"]);
    for (((link, aside_m), which), height) in parts.zip(block.rest_at_m()) {
        let sides = if *aside_m == 0.0 { &SIDES[..1] } else { &SIDES };
        all.extend(sides.iter().map(|(side, sign)| {
            let link = on_side(side, link);
            Body {
                name: format!("{link}_{which}"),
                link,
                at_m: [sign * aside_m, forward, height],
                size_m: [block.place.edge_m; 3],
                mass_kg: 0.5 * block.rest.mass_kg / sides.len() as f64,
            }
        }));
    }
    all
}
