//! The page: numbers, figures, findings.

use super::figure::{Curve, Figure, Holds, Ink, Panel};
use super::findings::{Finding, Shown};
use super::{Row, Study, Verdict};
use crate::number::short;
use crate::report::page::{Section, document};
use crate::report::scale::{Scale, span};
use crate::report::svg::{Plot, Tone, at};
use maud::{Markup, html as markup};

/// Size of a panel, px.
const SIZE: (f64, f64) = (460.0, 250.0);

/// A self-contained page. `command` is the line that makes it again.
pub fn html(study: &Study, command: &str) -> String {
    let sections = [
        numbers(study),
        figures(study),
        findings(study),
        origin(command),
    ];
    document("The paper, reproduced", &header(study), &sections)
}

fn header(study: &Study) -> Markup {
    let misprints = study
        .rows
        .iter()
        .filter(|row| row.verdict != Verdict::Agrees)
        .count();
    let hold = |figure: &&Figure| figure.holds == Holds::Yes;
    markup! {
        header.verdict-named {
            p.title { "Development of a simulation environment of an entertainment humanoid robot" }
            h1 {
                (study.rows.len() - misprints) " of " (study.rows.len()) " numbers agree to every digit, "
                (misprints) " are misprints."
            }
            p {
                "What the paper concludes from its figures holds here for "
                (study.figures.iter().filter(hold).count()) " of " (study.figures.len())
                "; the others say below where it does not."
            }
        }
    }
}

fn numbers(study: &Study) -> Section {
    let facts = &study.computed.servo_facts;
    let body = markup! {
        div.scroll { table {
            thead { tr { th { "Where" } th { "Quantity" } th { "Unit" } th.number { "Stated" } th.number { "Computed" } th { "Verdict" } } }
            tbody { @for row in &study.rows { (number(row)) } }
        } }
        h3 { "What follows without being printed" }
        ul {
            @for zeros in &study.computed.zeros {
                li {
                    "Zeros from the torques to (q" (zeros.outputs[0]) ", q" (zeros.outputs[1]) "): ±"
                    (short(zeros.squared.abs().sqrt())) @if zeros.squared < 0.0 { " j" } " 1/s"
                }
            }
            li { "Static gain of eq. (2): " (short(facts.gain)) }
            @if let Some(pole) = facts.poles.first() {
                li {
                    "Poles of eq. (2): z = " (format!("{:.4} ± {:.4} j", pole.re, pole.im.abs())) ", |z| = "
                    (format!("{:.4}", pole.norm())) ", that is " (short(facts.continuous.re)) " ± "
                    (short(facts.continuous.im.abs())) " j 1/s; it settles to 2 % in " (short(facts.settling_s)) " s"
                }
            }
        }
    };
    Section {
        id: "numbers",
        title: "Printed and computed",
        lead: "Computed from Table 1: linearised upright, sampled, solved. The last printed digit decides. Rows marked \
               recomputed are not printed; SciPy found them from Table 1. The servo's coefficients are those of a \
               Box-Jenkins model found in data made with eq. (2), with half their 95 % interval.",
        body,
    }
}

fn number(row: &Row) -> Markup {
    let class = if row.verdict == Verdict::Agrees {
        "good"
    } else {
        "bad"
    };
    markup! {
        tr {
            td { (row.printed.place) }
            td { (row.printed.quantity.name()) }
            td { (row.printed.quantity.unit()) }
            td.number { (row.printed.text) }
            td.number { (row.computed_text()) }
            td { span class=(class) { (row.verdict.to_string()) } }
        }
    }
}

fn figures(study: &Study) -> Section {
    Section {
        id: "figures",
        title: "The figures, from our own simulation",
        lead: "Each with what the paper concludes from it, and whether that holds here.",
        body: markup! { @for figure in &study.figures { (drawn(figure)) } },
    }
}

fn drawn(figure: &Figure) -> Markup {
    let words = markup! {
        p { (figure.sentence) }
        p.note {
            "The paper: " (figure.claim) ". "
            b class=(if figure.holds == Holds::Yes { "good" } else { "bad" }) { (capital(figure.holds.words())) "." }
        }
    };
    let alone = figure.panels.len() == 1;
    markup! {
        h3 { "Figure " (figure.number) ": " (figure.title) }
        @if !alone { (words) }
        div.panels {
            @for panel in &figure.panels { (chart(panel)) }
            @if alone { div { (words) } }
        }
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

fn tone(ink: Ink) -> Tone {
    match ink {
        Ink::Dark => Tone::Measured,
        Ink::Blue => Tone::After,
        Ink::Orange => Tone::Before,
        Ink::Green => Tone::Floor,
        Ink::Quiet => Tone::Quiet,
    }
}

fn chart(panel: &Panel) -> Markup {
    let (width, height) = SIZE;
    let points = || panel.curves.iter().flat_map(|curve| curve.points.iter());
    let plot = Plot {
        x: Scale::new(span(points().map(|p| p.0), 0.0), (46.0, width - 12.0)),
        y: Scale::new(span(points().map(|p| p.1), 0.06), (height - 38.0, 26.0)),
    };
    markup! {
        figure {
            figcaption {
                b { (panel.title) }
                @for curve in &panel.curves {
                    span class={ "key " (tone(curve.ink).class()) } { span.swatch {} (curve.name) }
                }
            }
            svg viewBox=(format!("0 0 {width} {height}")) role="img" aria-label=(panel.title) {
                (plot.columns(6)) (plot.rows(5, panel.y_label)) (plot.x_labels(6, panel.x_label))
                @for curve in &panel.curves { (mark(&plot, curve)) }
            }
        }
    }
}

fn mark(plot: &Plot, curve: &Curve) -> Markup {
    let tone = tone(curve.ink);
    if !curve.dots {
        return plot.curve(curve.points.iter().copied(), tone);
    }
    markup! {
        g class={ "dots " (tone.class()) } {
            @for (x, y) in &curve.points {
                circle cx=(at(plot.x.place(*x))) cy=(at(plot.y.place(*y))) r="1.8" {}
            }
        }
    }
}

fn findings(study: &Study) -> Section {
    Section {
        id: "findings",
        title: "What the paper found",
        lead: "Everything it measured, simulated or left open, with the command that shows it here.",
        body: markup! {
            div.scroll { table {
                thead { tr { th { "" } th { "Found there" } th { "Here" } th { "Command" } th { "Verdict" } } }
                tbody { @for row in &study.findings { (finding(row)) } }
            } }
        },
    }
}

fn finding(row: &Finding) -> Markup {
    let class = match row.shown {
        Shown::Here(Holds::Yes) | Shown::There => "good",
        _ => "bad",
    };
    markup! {
        tr {
            td.number { (row.number) }
            td { (row.found) }
            td { (row.said) }
            td { code { (row.command) } }
            td { span class=(class) { (row.verdict()) } }
        }
    }
}

fn origin(command: &str) -> Section {
    Section {
        id: "origin",
        title: "Where this comes from",
        lead: "The same program makes the same page again.",
        body: markup! {
            p { "Program version " b { (env!("CARGO_PKG_VERSION")) } "." }
            pre { code { (command) } }
        },
    }
}
