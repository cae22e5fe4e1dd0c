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
use super::{Console, ExitStatus, show};
use handstand::Result;
use handstand::paper::{
    Agreement, BlockValue, CheckedNumber, Computed, LumpedBlock, Reproduction, STEPS,
    block_columns, check, follows, html, number_columns, reproduce, rest_of_blocks,
};
use serde_json::{Value, json};

/// Recompute the paper's numbers, figures and findings, and compare.
#[derive(Debug, clap::Args)]
pub struct PaperArgs {
    /// Also judge the figures and all that the paper found
    #[arg(long)]
    findings: bool,
    #[command(flatten)]
    page: PageFile,
}

/// Computes, prints, writes the page.
pub fn run(args: &PaperArgs, console: &Console) -> Result<ExitStatus> {
    args.page.vacant()?;
    let whole = if args.findings || args.page.is_wanted() {
        Some(worked(console)?)
    } else {
        None
    };
    let (rows, computed) = match &whole {
        Some(study) => (study.rows.clone(), study.computed.clone()),
        None => {
            let computed = Computed::new()?;
            (check(&computed), computed)
        }
    };
    console.result(&data(&rows, &computed, whole.as_ref()), || {
        let mut parts = vec![numbers(&rows), whole_robot(&computed), following(&computed)];
        parts.extend(whole.as_ref().filter(|_| args.findings).map(judged));
        parts.join("\n\n")
    })?;
    if let Some(study) = &whole {
        let page = || Ok(html(study, &console.command));
        args.page.write(page, console)?;
    }
    let differs = rows.iter().any(|row| row.verdict == Agreement::Differs);
    Ok(ExitStatus::answer(!differs))
}

fn worked(console: &Console) -> Result<Reproduction> {
    let bar = console.bar(STEPS);
    reproduce(&|what| {
        bar.set_message(what.to_string());
        bar.inc(1);
    })
}

fn numbers(rows: &[CheckedNumber]) -> String {
    let count = |of: fn(&Agreement) -> bool| rows.iter().filter(|row| of(&row.verdict)).count();
    format!(
        "{}\n{} numbers: {} agree to the last digit, {} misprints. `recomputed`: not printed; \
         found from Table 1\nwith SciPy. servo: found by `identify` in data made with eq. (2), \
         half of 95 %.",
        show::table_of(rows, &number_columns()),
        rows.len(),
        count(|verdict| *verdict == Agreement::Agrees),
        count(|verdict| matches!(verdict, Agreement::Sign | Agreement::Digits(..)))
    )
}

fn whole_robot(computed: &Computed) -> String {
    let blocks = &computed.blocks;
    let values: Vec<BlockValue> = blocks.iter().flat_map(LumpedBlock::values).collect();
    let rest = rest_of_blocks(blocks).join("\n  ");
    format!(
        "{}\nThe whole robot with its 18 servos (host/models/humanoid.urdf), held in the \
         handstand. The\nrest, whose weight is not public, is put where Table 1 leaves it; heights \
         are over the block's lower\naxis:\n  {rest}",
        show::table_of(&values, &block_columns())
    )
}

fn following(computed: &Computed) -> String {
    let lines = follows(computed).into_iter();
    let lines = lines.map(|(what, value)| format!("\n  {what:<34}  {value}"));
    "What follows without being printed:".to_string() + &lines.collect::<String>()
}

fn judged(study: &Reproduction) -> String {
    let figures = study.figures.iter().map(|figure| {
        let (number, title, holds) = (figure.number, figure.title, figure.holds.words());
        format!("Figure {number}, {title}: {holds}. {}", figure.sentence)
    });
    let findings = study.findings.iter().map(|finding| {
        let (number, found, command) = (finding.number, finding.found, finding.command);
        let (holds, said) = (finding.holds.words(), &finding.said);
        format!("{number}. {found}\n   {command}: {holds}\n   {said}")
    });
    let all: Vec<String> = figures.chain(findings).collect();
    all.join("\n\n")
}

fn data(rows: &[CheckedNumber], computed: &Computed, whole: Option<&Reproduction>) -> Value {
    let facts = &computed.servo_facts;
    let row = |row: &CheckedNumber| {
        json!({
            "place": row.printed.place,
            "quantity": row.printed.quantity.name(),
            "unit": row.printed.quantity.unit(),
            "in_paper": row.printed.in_paper,
            "stated": row.printed.text,
            "computed": row.computed.value,
            "verdict": row.verdict.to_string(),
        })
    };
    json!({
        "rows": rows.iter().map(row).collect::<Vec<Value>>(),
        "blocks": computed.blocks,
        "follows": {
            "zeros": computed.zeros,
            "servo_gain": facts.gain,
            "servo_pole": facts.poles.first().map(|pole| [pole.re, pole.im]),
            "servo_settling_s": facts.settling_s,
        },
        "figures": whole.map(|study| &study.figures),
        "findings": whole.map(|study| &study.findings),
    })
}
