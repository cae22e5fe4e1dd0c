//! What model files and fits take from the tables: keys, units and numbers, on both axes.

use super::*;
use std::fmt::Write;

#[test]
fn keys_units_and_numbers_on_both_axes() {
    let mut lines = String::new();
    for effect in EFFECTS.iter().chain(CONTROLS) {
        for axis in [Axis::Hinge, Axis::Slide] {
            let Some(own) = effect.on(axis) else {
                let id = effect.info().id;
                writeln!(lines, "{id} {axis:?}: cannot act").unwrap();
                continue;
            };
            let info = own.info();
            let (id, law) = (info.id, info.law);
            writeln!(lines, "{id} {axis:?}: {law}").unwrap();
            for p in info.parameters {
                let Parameter { key, unit, off, .. } = p;
                let (typical, bounds, starts) = (p.typical, p.bounds, p.starts);
                let meaning = p.meaning;
                let numbers = format!("{off:?} {typical:?} {bounds:?} {starts:?}");
                writeln!(lines, "  {key} [{unit}] {numbers} {meaning}").unwrap();
            }
        }
    }
    insta::assert_snapshot!(lines);
}
