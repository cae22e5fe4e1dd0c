//! Forward dynamics: planar chains, and robots in space.

use super::{Bench, Rows, number};
use handstand_measure::peers::{ROBOTS, farthest_off, forward_seconds};
use serde_json::Value;

/// How many times faster robots in space are to be than each peer.
const IN_SPACE: [(&str, f64); 2] = [("mujoco", 5.0), ("pinocchio", 1.3)];

impl Bench {
    /// Chains of links, in closed form and by recursion.
    pub(super) fn dynamics(&self, rounds: usize, table: &mut Rows) -> Result<(), String> {
        let file = self.folder.join("accelerations.json");
        let sizes = [
            ("mujoco", 3_usize, 10.0),
            ("pinocchio", 3, 5.0),
            ("pinocchio", 100, 5.0),
        ];
        let mut pairs = vec![Vec::new(); sizes.len()];
        for _ in 0..rounds {
            let ours = sizes.map(|(_, n, _)| forward_seconds(n));
            let words = [
                "--links",
                "3",
                "100",
                "--accelerations",
                "accelerations.json",
            ];
            let theirs = self.script("dynamics.py", &words)?;
            for ((pairs, (peer, n, _)), ours) in pairs.iter_mut().zip(sizes).zip(ours) {
                pairs.push((ours, 1e-6 * number(&theirs, &[peer, &n.to_string()])));
            }
        }
        for (pairs, (peer, n, target)) in pairs.iter().zip(sizes) {
            let form = if n == 3 { "closed form" } else { "recursion" };
            let row = format!("forward dynamics, n = {n}, {form}: {peer}");
            table.faster(&row, pairs, target);
        }
        let text = std::fs::read_to_string(&file).map_err(|error| error.to_string())?;
        let states: Value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
        for n in [3, 30] {
            let peers = ["mujoco", "pinocchio"];
            let off = peers.map(|peer| farthest_off(&states, n, peer).unwrap_or(f64::NAN));
            let off = off[0].max(off[1]);
            let name = format!("accelerations, n = {n}: farthest off both, relative");
            table.add(
                &name,
                ["", "", &format!("{off:.1e}"), "<= 1e-9"],
                off <= 1e-9,
            );
        }
        Ok(())
    }

    /// Forward dynamics of robots in space, out of the same files.
    pub(super) fn trees(&self, rounds: usize, table: &mut Rows) -> Result<(), String> {
        for robot in ROBOTS {
            let file = robot.file();
            let written = std::fs::write(self.folder.join(&file), robot.urdf());
            written.map_err(|error| format!("cannot write {file}: {error}"))?;
            let mut pairs = IN_SPACE.map(|_| Vec::new());
            for _ in 0..rounds {
                let ours = robot.forward_seconds();
                let theirs = self.script("dynamics.py", &["--robot", &file])?;
                for (pairs, (peer, _)) in pairs.iter_mut().zip(IN_SPACE) {
                    pairs.push((ours, 1e-6 * number(&theirs, &[peer, robot.name])));
                }
            }
            for (pairs, (peer, target)) in pairs.iter().zip(IN_SPACE) {
                let (name, joints) = (robot.name, robot.joints());
                let row = format!("forward dynamics in space, {name} of {joints} joints: {peer}");
                table.faster(&row, pairs, target);
            }
        }
        Ok(())
    }
}
