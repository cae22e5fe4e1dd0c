//! An explanation as a card: law, signature beside this log's residual, evidence, the experiment.

use crate::compare::residual_variables;
use crate::effects::signature::signature;
use crate::effects::{Effect, named};
use crate::output::number::short;
use crate::plot::{Chart, Curve, Tone};
use crate::report::signature_chart;
use crate::session::{
    CardRole, SavedCard, SavedSession, SessionEvaluation, effect_name, effect_of, listed,
    value_name,
};
use maud::{Markup, html};

/// Dots of a small picture of the residual.
const DOTS: usize = 500;

/// The card.
pub fn card(
    card: &SavedCard,
    saved: &SavedSession,
    evaluation: &SessionEvaluation,
    current: bool,
) -> Markup {
    let role = match card.role {
        CardRole::Found => "the best explanation",
        CardRole::Rival => "does as well",
        CardRole::NotNeeded => "as good, not needed",
        CardRole::RuledOut => "ruled out",
    };
    let class = if card.role == CardRole::Found {
        "card found"
    } else {
        "card"
    };
    html! {
        article class=(class) {
            span.role { (role) }
            h3 { (title(card)) }
            p.note { code { (names(card)) } }
            @if let [only] = card.effects.as_slice() {
                @if let Some((effect, joint)) = effect_of(only) {
                    (pictures(effect, joint, evaluation)) }
            }
            dl {
                @for effect in card.effects.iter().filter_map(|name| effect_of(name)) {
                    dt { "Law" } dd { code { (effect.0.info().law) } }
                }
                @for fitted in &card.fitted { dt { "Fitted" } dd { (fitted) } }
                dt { "Evidence" } dd { (evidence(card, evaluation)) }
                @if !card.why.is_empty() { dt { "Why not" } dd { (card.why) } }
                @for (effect, _) in card.effects.iter().filter_map(|name| effect_of(name)) {
                    @let info = effect.info();
                    dt { "Told by" } dd { (info.experiment) }
                }
            }
            (confusions(card))
            @if current { (add(card, saved)) }
        }
    }
}

/// What the effects are taken for; open where they were found.
fn confusions(card: &SavedCard) -> Markup {
    let effects = card.effects.iter().filter_map(|name| effect_of(name));
    let all: Vec<_> = effects
        .flat_map(|(effect, _)| effect.info().confusions())
        .collect();
    html! {
        @if !all.is_empty() {
            details open[card.role != CardRole::RuledOut] {
                summary { "Easily taken for" }
                dl { @for confusion in all {
                    dt { (named(confusion.with).map_or(confusion.with, |e| e.info().title)) }
                    dd { (confusion.why) }
                } }
            }
        }
    }
}

/// Its addresses.
fn names(card: &SavedCard) -> String {
    let names = card.effects.iter().chain(&card.values).cloned();
    names.collect::<Vec<_>>().join(" + ")
}

fn title(card: &SavedCard) -> String {
    let effects = card.effects.iter().map(|name| effect_name(name));
    let values = card.values.iter();
    let values = values.map(|path| format!("another {}", value_name(path)));
    listed(effects.chain(values).collect())
}

fn evidence(card: &SavedCard, evaluation: &SessionEvaluation) -> String {
    let words = |error: f64| evaluation.in_words(error);
    let mut parts = Vec::new();
    if let Some(error) = card.held_out_rad {
        parts.push(format!("leaves {} on motions held out", words(error)));
    }
    if let Some(error) = card.training_rad {
        parts.push(format!("{} on those fitted", words(error)));
    }
    if let Some(bic) = card.bic_change {
        parts.push(format!("BIC change {}", short(bic)));
    }
    parts.join(", ")
}

fn add(card: &SavedCard, saved: &SavedSession) -> Markup {
    let (send, names, verb) = if card.effects.is_empty() {
        ("fit", card.values.join("+"), "Fit it")
    } else {
        ("add", card.effects.join("+"), "Add it")
    };
    html! {
        form.row data-send=(send) {
            input type="hidden" name="names" value=(names);
            button.main data-work aria-label=(format!("{verb}: {} to model {}", title(card),
                saved.current)) { (verb) }
        }
    }
}

/// The signature of the law, and this log's residual over the quantity that the law depends on.
fn pictures(effect: Effect, joint: Option<usize>, evaluation: &SessionEvaluation) -> Markup {
    let drawn = signature(effect);
    let joint = joint.unwrap_or(0);
    let beside = (joint < evaluation.run.model.link_count())
        .then(|| residual_over(drawn.x_label, joint, evaluation))
        .flatten();
    html! {
        div.pictures {
            figure {
                (signature_chart(effect, &drawn).svg(300.0, 210.0))
                figcaption { "The law" }
            }
            @if let Some(chart) = beside {
                figure { (chart.svg(300.0, 210.0)) figcaption { "This log's residual" } }
            }
        }
    }
}

fn residual_over(x_label: &str, joint: usize, evaluation: &SessionEvaluation) -> Option<Chart> {
    let run = &evaluation.run;
    let wanted = ["speed", "angle", "torque", "supply", "time"]
        .into_iter()
        .find(|word| x_label.contains(word))
        .unwrap_or("time");
    let wanted = if wanted == "torque" { "load" } else { wanted };
    let variables = residual_variables(&run.model, &run.data.motions, joint);
    let variable = variables
        .into_iter()
        .find(|variable| variable.name == wanted)?;
    let residual = run.residuals().swap_remove(joint).into_iter().flatten();
    let all: Vec<(f64, f64)> = variable.values.into_iter().zip(residual).collect();
    let stride = all.len().div_ceil(DOTS).max(1);
    let dots = all.into_iter().step_by(stride);
    let dots = dots.filter(|(x, y)| x.is_finite() && y.is_finite());
    let shown = evaluation.shown(joint);
    let points = dots.map(|(x, y)| (x, shown.error_per_si * y)).collect();
    let label = format!("{}, {}", variable.name, variable.unit);
    Some(Chart::new(
        format!("residual over {}", variable.name),
        &label,
        &format!("residual, {}", shown.error_unit),
        vec![Curve::dots("", Tone::Blue, points)],
    ))
}
