//! The explanations that were tried, with the evidence for and against each.

use super::page::Section;
use super::table::{Columns, columns_of, page_table_with};
use super::text::and_more;
use super::words::{in_columns, in_milli, set_name, sorted};
use super::{AFTER, BEFORE, Report};
use crate::diagnose::words::{SHOWN as RIVALS, explained_by};
use crate::diagnose::{Alternative, Diagnosis, RuledOut};
use crate::model::{JointNames, MeasuredSignal};
use crate::output::number::{NONE, mrad, short};
use crate::plot::{Bar, largest};
use maud::{Markup, html};

/// Rows that are in sight from the start.
const OPEN: usize = 8;

pub(super) fn section(report: &Report) -> Option<Section> {
    let diagnosis = report.diagnosis.as_ref()?;
    if diagnosis.ruled_out.is_empty() && diagnosis.alternatives.is_empty() {
        return None;
    }
    let body = html! {
        @if !diagnosis.alternatives.is_empty() {
            h3 { "These do as well: the data do not rule them out" }
            ul { @for line in alternatives(diagnosis) { li { (line) } } }
        }
        @if !diagnosis.ruled_out.is_empty() { (tried(diagnosis)) }
    };
    Some(Section {
        id: "candidates",
        title: "What else was tried",
        lead: "Every candidate was fitted on the same motions; the promising ones then had to \
               predict motions they had not seen. A wrong candidate may fit well and yet predict \
               badly. BIC weighs the gain against the number of added parameters: the more \
               negative, the better.",
        body,
    })
}

/// The explanations that do as well, a line each.
pub(crate) fn alternatives(diagnosis: &Diagnosis) -> Vec<String> {
    let all = &diagnosis.alternatives;
    let line = |alternative: &Alternative| {
        let effects = alternative.effects.iter();
        let values = effects.flat_map(|effect| &effect.parameters);
        let wrong = alternative.wrong_values.iter().map(|wrong| &wrong.fitted);
        let values = values.chain(wrong);
        let values = values.map(|fitted| format!("{} = {fitted}", fitted.key));
        format!(
            "{}: {}; {}",
            explained_by(&alternative.effects, &alternative.wrong_values),
            in_milli(alternative.error_rad, diagnosis.error.quantity),
            values.collect::<Vec<_>>().join(", ")
        )
    };
    let lines = all.iter().take(RIVALS).map(line);
    lines.chain(and_more(all.len(), RIVALS)).collect()
}

fn error(tried: &RuledOut) -> f64 {
    tried.held_out_error_rad.unwrap_or(tried.training_error_rad)
}

/// What was tried and not chosen: what does as well, then what does worse.
fn tried(diagnosis: &Diagnosis) -> Markup {
    let errors = diagnosis.ruled_out.iter().map(error);
    let full = largest(errors.chain([diagnosis.error.after_rad]));
    let as_good = sorted(diagnosis, true);
    let worse = sorted(diagnosis, false);
    html! {
        @if !as_good.is_empty() {
            h3 { "As good, not needed" }
            p.note {
                "These motions do not tell them from the explanation that was chosen: they are not "
                "ruled out, but the chosen one is simpler."
            }
            (folded(diagnosis, &as_good, full))
        }
        @if !worse.is_empty() {
            h3 { "Ruled out" }
            (folded(diagnosis, &worse, full))
        }
        p.note {
            "Bars show the held-out error; pale ones the fitted error of candidates that came no "
            "further. The thin line is the error of the explanation on top."
        }
    }
}

/// The first rows in sight, the others behind a title.
fn folded(diagnosis: &Diagnosis, tried: &[&RuledOut], full: f64) -> Markup {
    let (first, rest) = tried.split_at(tried.len().min(OPEN));
    html! {
        (rows(diagnosis, first, full, found(diagnosis)))
        @if !rest.is_empty() {
            details {
                summary { (rest.len()) " more" }
                (rows(diagnosis, rest, full, false))
            }
        }
    }
}

fn rows(diagnosis: &Diagnosis, tried: &[&RuledOut], full: f64, with_best: bool) -> Markup {
    let names = JointNames::default();
    let best = best(diagnosis);
    let is_best = |tried: &RuledOut| std::ptr::eq(tried, &best);
    let bar = |tried: &RuledOut| match tried.held_out_error_rad {
        _ if is_best(tried) => Bar::new(diagnosis.error.after_rad, full, AFTER),
        held_out => Bar {
            ghost: held_out.is_none().then_some(tried.training_error_rad),
            mark: Some(diagnosis.error.after_rad),
            ..Bar::new(held_out.unwrap_or(0.0), full, BEFORE)
        },
    };
    let picture = |tried: &RuledOut| bar(tried).draw();
    let columns = tried_columns(
        "Added to the model",
        &names,
        diagnosis.error.quantity,
        picture,
    );
    let rows = with_best.then_some(&best).into_iter();
    let rows = rows.chain(tried.iter().copied());
    let class = |tried: &RuledOut| is_best(tried).then_some("best");
    html! { div.tried { (page_table_with(rows, &columns, class)) } }
}

/// The columns of what was tried, under this title; joints are called as `names` has them, and
/// pages draw the error.
pub(crate) fn tried_columns<'a>(
    title: &'a str,
    names: &'a JointNames,
    quantity: MeasuredSignal,
    picture: impl Fn(&RuledOut) -> Markup + 'a,
) -> Columns<'a, RuledOut> {
    let [fitted, held_out] = in_columns(["Fitted", "Held out"], quantity);
    columns_of::<RuledOut>()
        .text(title, |tried| names.in_text(&tried.set.join(" + ")))
        .drawn_as(|tried| {
            let (name, ids) = (set_name(&tried.set), tried.set.join(" + "));
            html! { (name) @if ids != name { br; code { (ids) } } }
        })
        .number(fitted, |tried| mrad(tried.training_error_rad))
        .number(held_out, |tried| {
            tried.held_out_error_rad.map_or(NONE.into(), mrad)
        })
        .drawn("Drawn", picture)
        .class("wide")
        .number("BIC", |tried| short(tried.bic_change))
        .text("Why", |tried| names.in_text(&tried.why))
}

fn found(diagnosis: &Diagnosis) -> bool {
    !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty()
}

/// The chosen explanation, to compare with.
fn best(diagnosis: &Diagnosis) -> RuledOut {
    let (after, held_out) = (diagnosis.error.after_rad, diagnosis.error.held_out);
    RuledOut {
        set: vec![explained_by(&diagnosis.effects, &diagnosis.wrong_values)],
        training_error_rad: if held_out { f64::NAN } else { after },
        held_out_error_rad: held_out.then_some(after),
        bic_change: f64::NAN,
        as_good: false,
        why: "best found".to_string(),
    }
}
