//! A page that shows both attempts side by side.

use super::run::{RobotDemo, ScoredEffect};
use crate::deploy::rehearsal::{AttemptSample, BalanceAttempt, STANDS_S};
use crate::output::number::{NONE, exact};
use crate::plot::{Chart, Curve, Tone};
use crate::report::page::{Section, document};
use crate::report::table::{Columns, columns_of, page_table};
use maud::{Markup, html};

/// Two pictures beside each other, their axes at one height however long their titles are, or below
/// each other on a narrow page.
const PAIR: &str = "display:grid;gap:1rem;align-items:end;\
                    grid-template-columns:repeat(auto-fit,minmax(20rem,1fr))";

/// The page, which needs nothing but itself.
pub fn html(demo: &RobotDemo) -> String {
    let title = format!("Robot {}: before and after the measurement", demo.seed);
    let header = html! {
        header {
            h1 { (title) }
            p {
                "With the model as believed the robot " (said(&demo.nominal)) "; with what was "
                "learned from its recordings it " (said(&demo.learned)) "."
            }
        }
    };
    let sections = [
        Section {
            id: "first-link",
            title: "The first link",
            lead: "Its angle from upright while the CM-5's firmware balances the robot, from the \
                   same start; the scales are the same. Drag across a chart to zoom.",
            body: pair(demo, "degrees from upright", |attempt| {
                vec![curve(attempt, "first link", Tone::Blue, |s| s.lean_rad)]
            }),
        },
        Section {
            id: "joints",
            title: "Shoulder and hip",
            lead: "Their angles from straight, as their servos tell them.",
            body: pair(demo, "degrees from straight", |attempt| {
                vec![
                    curve(attempt, "shoulder", Tone::Orange, |s| s.joint_rad[0]),
                    curve(attempt, "hip", Tone::Blue, |s| s.joint_rad[1]),
                ]
            }),
        },
        Section {
            id: "hidden",
            title: "What was hidden, and what was found",
            lead: "The robot had these effects, and its owner's model had not. The diagnosis saw \
                   recordings alone. A wide interval says that the effect is there and this value \
                   of it is hardly known: of a dead zone, what a command loses (the punch) shows, \
                   and the width below it does not.",
            body: page_table(&demo.effects, &effect_columns()),
        },
    ];
    document(&title, &header, &sections)
}

fn said(attempt: &BalanceAttempt) -> String {
    let sway = attempt.sway_rms_rad.map_or(String::new(), |rad| {
        format!(", swaying by {:.1} mrad rms", 1e3 * rad)
    });
    if attempt.stands {
        format!("stands for {STANDS_S:.0} s{sway}")
    } else {
        format!("falls after {:.1} s", attempt.stood_s)
    }
}

fn curve(
    attempt: &BalanceAttempt,
    name: &str,
    tone: Tone,
    angle_rad: impl Fn(&AttemptSample) -> f64,
) -> Curve {
    let samples = attempt.samples.iter();
    let points = samples.map(|sample| (sample.time_s, angle_rad(sample).to_degrees()));
    Curve::line(name, tone, points.collect())
}

fn pair(demo: &RobotDemo, label: &str, curves: impl Fn(&BalanceAttempt) -> Vec<Curve>) -> Markup {
    let sides = [
        ("as believed", &demo.nominal),
        ("as learned", &demo.learned),
    ];
    let mut charts = sides.map(|(name, attempt)| {
        let title = format!("Model {name}: {}", said(attempt));
        Chart::new(title, "time, s", label, curves(attempt))
    });
    // What is compared has the same scales; where a robot falls, they hold it down to the ground.
    Chart::share_axes(&mut charts);
    html! {
        div style=(PAIR) {
            @for chart in &charts {
                figure {
                    figcaption { (chart.title) }
                    (chart.zoomable_svg(460.0, 300.0))
                    div.legend { (chart.legend()) }
                }
            }
        }
    }
}

/// The columns of effects that were hidden.
pub fn effect_columns<'a>() -> Columns<'a, ScoredEffect> {
    let estimate = |none: &'static str| {
        move |effect: &ScoredEffect| effect.estimate.map_or(none.to_string(), exact)
    };
    columns_of::<ScoredEffect>()
        .text("Hidden", |effect| effect.address.clone())
        .text("Value", |effect| effect.key.clone())
        .number("True", |effect| exact(effect.true_value))
        .number("Estimated", estimate(NONE))
        .drawn_as(move |effect| html! { (estimate("not found")(effect)) })
        .number("95 % interval", ScoredEffect::interval_words)
}
