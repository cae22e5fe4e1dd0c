//! `handstand paper [--report FILE.html]`: the paper's numbers, compared with those recomputed from
//! its Table 1.
//!
//! Every number with its place, as printed, as computed, and whether they agree to the last printed
//! digit; misprints are named. The report also redraws the paper's figures from our own simulation,
//! each with whether its conclusion holds, and lists what the paper found with the command that
//! shows it.
//!
//! ```console
//! $ handstand paper --report paper.html
//! ```
//!
//! Exit code 1 if a number neither agrees nor is a misprint. `--json` prints `rows` and `follows`;
//! with `--findings` or `--report` also `figures` and `findings` (`docs/json.md`).

use super::page::PageFile;
use super::talk::Talk;
use super::{Outcome, show};
use handstand::Result;
use handstand::paper::{Computed, Row, STEPS, Study, Verdict, check, html, study};
use serde_json::{Value, json};

/// Recompute the paper's numbers, figures and findings, and compare.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Also judge the figures and all that the paper found
    #[arg(long)]
    findings: bool,
    #[command(flatten)]
    page: PageFile,
}

/// Computes, prints, writes the page.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    args.page.vacant()?;
    let whole = match args.findings || args.page.is_wanted() {
        true => Some(worked(talk)?),
        false => None,
    };
    let (rows, computed) = match &whole {
        Some(study) => (study.rows.clone(), study.computed.clone()),
        None => {
            let computed = Computed::new()?;
            (check(&computed), computed)
        }
    };
    if talk.json {
        talk.data(&data(&rows, &computed, whole.as_ref()))?;
    } else {
        let mut parts = vec![numbers(&rows), follows(&computed)];
        if let Some(study) = whole.as_ref().filter(|_| args.findings) {
            parts.push(judged(study));
        }
        talk.print(&parts.join("\n\n"))?;
    }
    if let Some(study) = &whole {
        let page = || Ok(html(study, &talk.command));
        args.page.write(page, talk)?;
    }
    let differs = rows.iter().any(|row| row.verdict == Verdict::Differs);
    Ok(if differs {
        Outcome::Refused
    } else {
        Outcome::Done
    })
}

fn worked(talk: &Talk) -> Result<Study> {
    let bar = talk.bar(STEPS);
    study(&|what| {
        bar.set_message(what.to_string());
        bar.inc(1);
    })
}

fn numbers(rows: &[Row]) -> String {
    let mut table = show::table(["Where", "Quantity", "Stated", "Computed", "Verdict"]);
    for row in rows {
        table.add_row([
            row.printed.place.to_string(),
            row.printed.quantity.name(),
            row.printed.text.to_string(),
            row.computed_text(),
            row.verdict.to_string(),
        ]);
    }
    let agree = rows
        .iter()
        .filter(|row| row.verdict == Verdict::Agrees)
        .count();
    let misprints = rows
        .iter()
        .filter(|row| matches!(row.verdict, Verdict::Sign | Verdict::Digits(..)));
    format!(
        "{table}\n{} numbers: {agree} agree to the last digit, {} misprints. `recomputed`: not printed; found from \
         Table 1\nwith SciPy. servo: found by `identify` in data made with eq. (2), half of 95 %.",
        rows.len(),
        misprints.count()
    )
}

fn follows(computed: &Computed) -> String {
    let facts = &computed.servo_facts;
    let mut lines = vec!["What follows without being printed:".to_string()];
    for zeros in &computed.zeros {
        let [a, b] = zeros.outputs;
        let j = if zeros.squared < 0.0 { " j" } else { "" };
        lines.push(format!(
            "  zeros from the torques to (q{a}, q{b})  +-{:.4}{j} 1/s",
            zeros.squared.abs().sqrt()
        ));
    }
    lines.push(format!(
        "  servo, static gain                  {:.4}",
        facts.gain
    ));
    for pole in facts.poles.iter().filter(|pole| pole.im >= 0.0) {
        lines.push(format!(
            "  servo, poles                        z = {:.4} +- {:.4} j, |z| = {:.4}",
            pole.re,
            pole.im,
            pole.norm()
        ));
    }
    lines.push(format!(
        "  servo, poles in continuous time     {:.2} +- {:.2} j 1/s",
        facts.continuous.re,
        facts.continuous.im.abs()
    ));
    lines.push(format!(
        "  servo, settles to 2 % in            {:.2} s",
        facts.settling_s
    ));
    lines.join("\n")
}

fn judged(study: &Study) -> String {
    let figures = study.figures.iter().map(|figure| {
        format!(
            "Figure {}, {}: {}. {}",
            figure.number,
            figure.title,
            figure.holds.words(),
            figure.sentence
        )
    });
    let findings = study.findings.iter().map(|finding| {
        format!(
            "{}. {}\n   {}: {}\n   {}",
            finding.number,
            finding.found,
            finding.command,
            finding.verdict(),
            finding.said
        )
    });
    let all: Vec<String> = figures.chain(findings).collect();
    all.join("\n\n")
}

fn data(rows: &[Row], computed: &Computed, whole: Option<&Study>) -> Value {
    let facts = &computed.servo_facts;
    let rows: Vec<Value> = rows
        .iter()
        .map(|row| {
            json!({
                "place": row.printed.place,
                "quantity": row.printed.quantity.name(),
                "unit": row.printed.quantity.unit(),
                "in_paper": row.printed.in_paper,
                "stated": row.printed.text,
                "computed": row.computed.value,
                "verdict": row.verdict.to_string(),
            })
        })
        .collect();
    let zeros: Vec<Value> = computed
        .zeros
        .iter()
        .map(|zeros| json!({ "outputs": zeros.outputs, "squared": zeros.squared }))
        .collect();
    let figures = whole.map(|study| {
        let of = |figure: &handstand::paper::Figure| {
            json!({
                "number": figure.number,
                "title": figure.title,
                "claim": figure.claim,
                "verdict": figure.holds.words(),
                "sentence": figure.sentence,
            })
        };
        study.figures.iter().map(of).collect::<Vec<_>>()
    });
    let findings = whole.map(|study| {
        let of = |finding: &handstand::paper::Finding| {
            json!({
                "number": finding.number,
                "found": finding.found,
                "command": finding.command,
                "verdict": finding.verdict(),
                "sentence": finding.said,
            })
        };
        study.findings.iter().map(of).collect::<Vec<_>>()
    });
    json!({
        "rows": rows,
        "follows": {
            "zeros": zeros,
            "servo_gain": facts.gain,
            "servo_pole": facts.poles.first().map(|pole| [pole.re, pole.im]),
            "servo_settling_s": facts.settling_s,
        },
        "figures": figures,
        "findings": findings,
    })
}
