//! The page: numbers, figures, findings.

use super::findings::Finding;
use super::{Agreement, CheckedNumber, Holds, PaperFigure, Reproduction};
use crate::output::number::short;
use crate::plot::Chart;
use crate::report::page::{Section, document, table};
use maud::{Markup, html as markup};

/// Size of a chart, px.
const SIZE: (f64, f64) = (460.0, 250.0);

/// A self-contained page. `command` is the line that makes it again.
pub fn html(study: &Reproduction, command: &str) -> String {
    let sections = [
        numbers(study),
        figures(study),
        findings(study),
        origin(command),
    ];
    document("The paper, reproduced", &header(study), &sections)
}

fn header(study: &Reproduction) -> Markup {
    let misprints = study
        .rows
        .iter()
        .filter(|row| row.verdict != Agreement::Agrees)
        .count();
    let hold = |figure: &&PaperFigure| figure.holds == Holds::Yes;
    markup! {
        header.verdict-named {
            p.title { "Development of a simulation environment of an entertainment humanoid robot" }
            h1 {
                (study.rows.len() - misprints) " of " (study.rows.len())
                " numbers agree to every digit, " (misprints) " are misprints."
            }
            p {
                "What the paper concludes from its figures holds here for "
                (study.figures.iter().filter(hold).count()) " of " (study.figures.len())
                "; the others say below where it does not."
            }
        }
    }
}

fn numbers(study: &Reproduction) -> Section {
    let facts = &study.computed.servo_facts;
    let headings = markup! {
        th { "Where" } th { "Quantity" } th { "Unit" } th.number { "Stated" }
        th.number { "Computed" } th { "Verdict" }
    };
    let body = markup! {
        (table(&headings, &markup! { @for row in &study.rows { (number(row)) } }))
        h3 { "What follows without being printed" }
        ul {
            @for zeros in &study.computed.zeros {
                li {
                    "Zeros from the torques to (q" (zeros.outputs[0]) ", q" (zeros.outputs[1])
                    "): ±"
                    (short(zeros.squared.abs().sqrt())) @if zeros.squared < 0.0 { " j" } " 1/s"
                }
            }
            li { "Static gain of eq. (2): " (short(facts.gain)) }
            @if let Some(pole) = facts.poles.first() {
                li {
                    "Poles of eq. (2): z = " (format!("{:.4} ± {:.4} j", pole.re, pole.im.abs()))
                    ", |z| = " (format!("{:.4}", pole.norm()))
                    ", that is " (short(facts.continuous.re)) " ± "
                    (short(facts.continuous.im.abs())) " j 1/s; it settles to 2 % in "
                    (short(facts.settling_s)) " s"
                }
            }
        }
    };
    Section {
        id: "numbers",
        title: "Printed and computed",
        lead: "Computed from Table 1: linearised upright, sampled, solved. The last printed digit \
               decides. Rows marked recomputed are not printed; SciPy found them from Table 1. The \
               servo's coefficients are those of a Box-Jenkins model found in data made with eq. \
               (2), with half their 95 % interval.",
        body,
    }
}

fn number(row: &CheckedNumber) -> Markup {
    markup! {
        tr {
            td { (row.printed.place) }
            td { (row.printed.quantity.name()) }
            td { (row.printed.quantity.unit()) }
            td.number { (row.printed.text) }
            td.number { (row.computed_text()) }
            td { span class=(good(row.verdict == Agreement::Agrees)) { (row.verdict.to_string()) } }
        }
    }
}

fn figures(study: &Reproduction) -> Section {
    Section {
        id: "figures",
        title: "The figures, from our own simulation",
        lead: "Each with what the paper concludes from it, and whether that holds here.",
        body: markup! { @for figure in &study.figures { (drawn(figure)) } },
    }
}

fn drawn(figure: &PaperFigure) -> Markup {
    let words = markup! {
        p { (figure.sentence) }
        p.note {
            "The paper: " (figure.claim) ". "
            b class=(good(figure.holds == Holds::Yes)) { (capital(figure.holds.words())) "." }
        }
    };
    let alone = figure.charts.len() == 1;
    markup! {
        h3 { "Figure " (figure.number) ": " (figure.title) }
        @if !alone { (words) }
        div.panels {
            @for chart in &figure.charts { (drawn_chart(chart)) }
            @if alone { div { (words) } }
        }
    }
}

fn good(is: bool) -> &'static str {
    if is { "good" } else { "bad" }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

fn drawn_chart(chart: &Chart) -> Markup {
    let (width, height) = SIZE;
    markup! {
        figure {
            figcaption { b { (chart.title) } (chart.legend()) }
            (chart.svg(width, height))
        }
    }
}

fn findings(study: &Reproduction) -> Section {
    let headings = markup! {
        th { "" } th { "Found there" } th { "Here" } th { "Command" } th { "Verdict" }
    };
    let rows = markup! { @for row in &study.findings { (finding(row)) } };
    Section {
        id: "findings",
        title: "What the paper found",
        lead: "Everything it measured, simulated or left open, with the command that shows it \
               here.",
        body: table(&headings, &rows),
    }
}

fn finding(row: &Finding) -> Markup {
    let shown = matches!(row.holds, Holds::Yes | Holds::ShownElsewhere);
    markup! {
        tr {
            td.number { (row.number) }
            td { (row.found) }
            td { (row.said) }
            td { code { (row.command) } }
            td { span class=(good(shown)) { (row.holds.words()) } }
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
