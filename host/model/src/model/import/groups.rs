//! Which joints of a robot make a planar chain: those in a row with parallel axes.

use super::choice::hinged;
use super::frame::PARALLEL_RAD;
use super::planar::chain_of;
use super::tree::RobotTree;
use nalgebra::Vector3;
use std::collections::HashSet;

/// Longer chains are not looked for.
const LONGEST: usize = 32;
/// Most groups that are tried.
const TRIED: usize = 60;
/// Most groups that are printed.
const SHOWN: usize = 8;

/// What to write after `--joints`: groups of joints that turn about parallel axes, the longest
/// first. Only such as make a model are named.
pub(super) fn ready_to_paste(tree: &RobotTree, file: &str) -> Option<String> {
    let works = |group: &Vec<usize>| chain_of(tree, group, file).is_ok();
    let mut groups: Vec<Vec<usize>> = parallel(tree).into_iter().take(TRIED).collect();
    groups.retain(works);
    let most = groups.first()?.len();
    if most > 1 {
        groups.retain(|group| group.len() > 1);
    }
    let named = |group: &Vec<usize>| {
        let names = group.iter().map(|&body| &tree.bodies[body].joints[0].name);
        let words: Vec<String> = names.map(|name| word(name)).collect();
        format!("--joints {}", words.join(" "))
    };
    let mut texts: Vec<String> = groups.iter().take(SHOWN).map(named).collect();
    if let Some(more) = groups.len().checked_sub(SHOWN).filter(|more| *more > 0) {
        texts.push(format!("{more} more"));
    }
    Some(texts.join(", or "))
}

/// A name as a shell takes it.
fn word(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./:+@".contains(c);
    if !name.is_empty() && name.chars().all(is_plain) {
        name.to_string()
    } else {
        format!("'{}'", name.replace('\'', "'\\''"))
    }
}

/// Of each hinge the hinges before it that turn about parallel axes, and it; without those that
/// are the beginning of another.
fn parallel(tree: &RobotTree) -> Vec<Vec<usize>> {
    let poses = tree.world_poses();
    let axis = |body: usize| -> Vector3<f64> { poses[body] * tree.bodies[body].joints[0].axis };
    let mut begun = HashSet::new();
    let mut groups = Vec::new();
    for tip in (0..tree.bodies.len()).rev().filter(|&b| hinged(tree, b)) {
        let along = axis(tip);
        let before = std::iter::successors(Some(tip), |&body| tree.bodies[body].parent);
        let same = before.filter(|&body| hinged(tree, body));
        let same = same.filter(|&body| axis(body).cross(&along).norm() < PARALLEL_RAD);
        let mut group: Vec<usize> = same.take(LONGEST).collect();
        if let Some(&before) = group.get(1) {
            begun.insert(before);
        }
        group.reverse();
        if !begun.contains(&tip) {
            groups.push(group);
        }
    }
    groups.reverse();
    groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
    groups
}
