//! Rounds with a hidden effect: the one that is open, the score, the history.

use super::{frame, in_mrad};
use crate::challenge::score_rows;
use crate::report::table::page_matrix;
use crate::session::{LabSession, Round, RoundResult, SessionStore};
use maud::{Markup, html};

/// The page.
pub fn page(session: &LabSession, store: &SessionStore) -> Markup {
    let saved = session.view();
    let evaluation = session.known_evaluation(&saved);
    let rounds: Vec<(u32, Round)> = store
        .all()
        .into_iter()
        .filter_map(|session| Some((session.number, session.saved().round?)))
        .collect();
    let body = html! {
        section {
            h1 { "Find the hidden effect" }
            p.lead { "A virtual servo arm has an effect that its model lacks, or once in twelve \
                      nothing. Look at the curves, add what you think is missing, hand the model \
                      in." }
            @match &saved.round {
                Some(Round { seed, result: None }) => (open(session.number, *seed)),
                Some(Round { seed, result: Some(result) }) => (scored(*seed, result)),
                None => {}
            }
            form.row data-send="round" {
                label { "Seed" input type="number" name="seed" min="0" max="4294967295" data-number
                    placeholder="random"; }
                button.main { "Begin a round" }
            }
            p.note { "A round begins in a session of its own; this one stays as it is." }
        }
        @if !rounds.is_empty() { section { h2 { "Rounds so far" } (history(&rounds)) } }
    };
    frame::page(
        session,
        &saved,
        "challenge",
        evaluation.as_deref(),
        "lab.js",
        &body,
    )
}

fn open(number: u32, seed: u64) -> Markup {
    html! {
        div.box {
            h2 { "The round with seed " (seed) " is open" }
            p { a href={ "/s/" (number) "/compare" } { "See where the model fails" }
                ", try effects under "
                a href={ "/s/" (number) "/what-if" } { "What if" } ", or let it be diagnosed under "
                a href={ "/s/" (number) "/learn" } { "Learn" } "." }
            form.row data-send="hand-in" { button.main #hand-in { "Hand in the model in force" } }
        }
    }
}

fn scored(seed: u64, result: &RoundResult) -> Markup {
    let values = result.values.iter();
    let values = values.map(|(key, truth, estimate)| (key.as_str(), *truth, *estimate));
    let errors = [result.true_error_rad, result.error_rad];
    let rows = score_rows(result.hidden.as_deref(), &result.added, values, errors);
    html! {
        div.box #score data-solved=(result.solved) {
            h2 { "The round with seed " (seed) " is over" }
            @if result.solved { p.solved { "Solved: the model names what was hidden." } }
            @else { p.unsolved { "Not solved: the model does not name what was hidden." } }
            (page_matrix(&rows))
        }
    }
}

fn or_nothing(name: Option<&str>) -> &str {
    name.filter(|name| !name.is_empty()).unwrap_or("nothing")
}

fn history(rounds: &[(u32, Round)]) -> Markup {
    let over = || rounds.iter().filter_map(|(_, round)| round.result.as_ref());
    let solved = over().filter(|result| result.solved).count();
    html! {
        p { b { (solved) } " of " (over().count()) " solved." }
        div.scroll tabindex="0" { table {
            thead { tr { th { "Session" } th { "Seed" } th { "Hidden" } th { "Handed in" } th {
                "Result" } th.number { "Error" } th.number { "of the truth" } } }
            tbody { @for (number, round) in rounds { tr {
                td { a href={ "/s/" (number) "/challenge" } { (number) } }
                td { (round.seed) }
                @match &round.result {
                    None => { td { "sealed" } td {} td { "open" } td {} td {} }
                    Some(result) => {
                        td { (or_nothing(result.hidden.as_deref())) }
                        td { (or_nothing(Some(&result.added.join(", ")))) }
                        td { @if result.solved { span.good { "solved" } } @else { span.bad {
                            "not solved" } } }
                        td.number { (in_mrad(Some(result.error_rad))) }
                        td.number { (in_mrad(Some(result.true_error_rad))) }
                    }
                }
            } } }
        } }
    }
}
