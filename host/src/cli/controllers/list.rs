//! The controllers and the conditions there are.

use super::super::talk::Talk;
use super::super::{Outcome, show};
use handstand::Result;
use handstand::controllers::{CONDITIONS, DESIGNS, Speeds};
use serde_json::json;

/// Lists them.
pub fn run(talk: &Talk) -> Result<Outcome> {
    if talk.json {
        let cards = DESIGNS.iter().map(|design| {
            let card = design.card();
            json!({
                "controller": card.id,
                "title": card.title,
                "law": card.law,
                "speeds": speeds(card.speeds),
                "told_balance": card.told_balance,
                "reference": card.reference,
            })
        });
        talk.data(&cards.collect::<Vec<_>>())?;
        return Ok(Outcome::Done);
    }
    let mut table = show::table(["Controller", "What it is", "Speeds", "Told balance"]);
    for design in DESIGNS {
        let card = design.card();
        let told = if card.told_balance { "yes" } else { "" };
        let what = format!("{}\n{}", card.title, card.law);
        table.add_row([card.id, &what, speeds(card.speeds), told]);
    }
    let mut conditions = show::table(["Condition", "What it is"]);
    for condition in CONDITIONS {
        conditions.add_row([condition.id, condition.title]);
    }
    talk.print(&format!("{table}\n\n{conditions}"))?;
    talk.say("`handstand controllers MODEL` tries them");
    Ok(Outcome::Done)
}

fn speeds(speeds: Speeds) -> &'static str {
    match speeds {
        Speeds::True => "true",
        Speeds::Differenced => "differences",
        Speeds::Estimated => "estimated",
    }
}
