//! The controllers and the conditions there are.

use crate::cli::{Console, ExitStatus, show};
use handstand::Result;
use handstand::study::CONDITIONS;
use handstand::synth::controllers::{DESIGNS, Speeds};
use serde_json::json;

/// Lists them.
pub fn run(console: &Console) -> Result<ExitStatus> {
    let infos = DESIGNS.iter().map(|design| {
        let info = design.info();
        json!({
            "controller": info.id,
            "title": info.title,
            "law": info.law,
            "speeds": speeds(info.speeds),
            "known_equilibrium": info.known_equilibrium,
            "reference": info.reference,
        })
    });
    console.result(&infos.collect::<Vec<_>>(), text)?;
    if !console.json {
        console.say("`handstand controllers MODEL` tries them");
    }
    Ok(ExitStatus::Done)
}

fn text() -> String {
    let mut table = show::table(["Controller", "What it is", "Speeds", "Known equilibrium"]);
    for design in DESIGNS {
        let info = design.info();
        let known = if info.known_equilibrium { "yes" } else { "" };
        let what = format!("{}\n{}", info.title, info.law);
        table.add_row([info.id, &what, speeds(info.speeds), known]);
    }
    let mut conditions = show::table(["Condition", "What it is"]);
    for condition in CONDITIONS {
        conditions.add_row([condition.id, condition.title]);
    }
    format!("{table}\n\n{conditions}")
}

fn speeds(speeds: Speeds) -> &'static str {
    match speeds {
        Speeds::True => "true",
        Speeds::Differenced => "differences",
        Speeds::Estimated => "estimated",
    }
}
