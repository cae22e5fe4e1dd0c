//! `cargo xtask real`: the diagnosis on public logs of real rigs, one row per rig.
//!
//! The logs lie in the folder `HANDSTAND_DATA` names. Each row starts from the rig's model in `host/models` as it
//! is, and says what the diagnosis says; nothing is picked by hand but the motions held out.

use comfy_table::{ContentArrangement, Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, diagnose};
use handstand::identify::Horizon;
use handstand::log::{LogRequest, Motion, read};
use handstand::{Error, Model, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Diagnose public logs of real rigs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only the rigs whose name holds this
    #[arg(long)]
    only: Option<String>,
    /// Print the rows as JSON
    #[arg(long)]
    json: bool,
}

/// A rig: its model, what is fitted, what is held out, and what a careful analyst expects.
struct Rig {
    name: &'static str,
    model: &'static str,
    training: &'static [&'static str],
    held_out: &'static [&'static str],
    /// Window, s, where the motion is too long and too sensitive for a free run.
    horizon_s: Option<f64>,
    expected: &'static str,
}

const RIGS: &[Rig] = &[
    Rig {
        name: "MX-106 drop",
        model: "mx106_drop",
        training: &["mx106_drop/drop.csv:26-139"],
        held_out: &[],
        horizon_s: None,
        expected: "stribeck, <= 2.0 mrad",
    },
    Rig {
        name: "HTD-45H, torque off",
        model: "htd45h_off",
        training: &["htd45h/lift_and_drop.csv:33-77"],
        held_out: &[],
        horizon_s: None,
        expected: "nominal, <= 3.2 mrad",
    },
    Rig {
        name: "HTD-45H, powered",
        model: "htd45h",
        training: &["htd45h/sin_sin.csv", "htd45h/up_and_down.csv"],
        held_out: &["htd45h/lift_and_drop.csv:0-31"],
        horizon_s: None,
        expected: "delay first",
    },
    Rig {
        name: "MultiArm, single",
        model: "multiarm_single",
        training: &[
            "multiarm/single_id.csv:0-4583",
            "multiarm/single_id.csv:9168-13751",
        ],
        held_out: &[
            "multiarm/single_id.csv:4584-9167",
            "multiarm/single_id.csv:13752-18335",
        ],
        horizon_s: None,
        expected: "ambiguous with drag, <= 6.5 mrad",
    },
    Rig {
        name: "DFKI double, design A",
        model: "dfki_double",
        training: &["dfki_double/design_A.0_20220815_sys_id_trajectory_00.csv"],
        held_out: &["dfki_double/design_A.0_20220815_sys_id_trajectory_05.csv"],
        horizon_s: Some(0.5),
        expected: "coulomb only, 25 % below",
    },
];

/// Whether every rig could be diagnosed.
pub fn run(args: &Args) -> bool {
    let Some(data) = std::env::var_os("HANDSTAND_DATA").map(PathBuf::from) else {
        eprintln!("HANDSTAND_DATA is unset: it must name the folder of the public logs");
        return false;
    };
    let mut rows = Vec::new();
    let wanted = |rig: &&Rig| {
        args.only
            .as_ref()
            .is_none_or(|part| rig.name.contains(part.as_str()))
    };
    for rig in RIGS.iter().filter(wanted) {
        eprintln!("{} ...", rig.name);
        match judge(rig, &data) {
            Ok(diagnosis) => rows.push((rig, diagnosis)),
            Err(error) => {
                eprintln!("{}: {error}", rig.name);
                return false;
            }
        }
    }
    if args.json {
        let rows: Vec<_> = rows
            .iter()
            .map(|(rig, d)| json!({"rig": rig.name, "expected": rig.expected, "diagnosis": handstand::report::diagnosis_json(d)}))
            .collect();
        println!("{}", json!(rows));
    } else {
        println!("{}", table(&rows));
    }
    true
}

fn judge(rig: &Rig, data: &Path) -> Result<Diagnosis> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/models");
    let model = Model::load(&root.join(format!("{}.toml", rig.model)))?;
    let motions = |names: &[&str]| -> Result<Vec<Motion>> {
        if names.is_empty() {
            return Ok(Vec::new());
        }
        let requests: Vec<LogRequest> = names
            .iter()
            .map(|name| data.join(name).to_string_lossy().parse::<LogRequest>())
            .collect::<std::result::Result<_, Error>>()?;
        read(&requests, &model.log)
    };
    let options = DiagnoseOptions {
        horizon: rig.horizon_s.map(Horizon::Seconds),
        ..DiagnoseOptions::default()
    };
    Ok(diagnose(
        &model,
        motions(rig.training)?,
        motions(rig.held_out)?,
        &options,
        &|_| {},
    ))
}

fn table(rows: &[(&Rig, Diagnosis)]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(110)
        .set_header([
            "Rig",
            "Error, mrad",
            "Judged on",
            "Verdict",
            "Effects",
            "As good",
            "Expected",
        ]);
    for (rig, diagnosis) in rows {
        let error = &diagnosis.error;
        let effects: Vec<String> = diagnosis
            .effects
            .iter()
            .map(|effect| {
                let joint = effect
                    .joint
                    .map_or(String::new(), |joint| format!("@{joint}"));
                let values: Vec<String> = effect
                    .parameters
                    .iter()
                    .map(|p| {
                        format!(
                            "{} = {:.3e} {} ({:.3e} to {:.3e})",
                            p.key, p.value, p.unit, p.low, p.high
                        )
                    })
                    .collect();
                format!("{}{joint}: {}", effect.kind, values.join(", "))
            })
            .collect();
        let rivals: Vec<String> = diagnosis
            .alternatives
            .iter()
            .map(|a| {
                a.effects
                    .iter()
                    .map(|e| e.kind.as_str())
                    .collect::<Vec<_>>()
                    .join(" + ")
            })
            .collect();
        table.add_row([
            rig.name.to_string(),
            format!(
                "{:.2} -> {:.2}, floor {:.2}",
                1e3 * error.before,
                1e3 * error.after,
                1e3 * error.floor
            ),
            if error.held_out { "held out" } else { "fitted" }.to_string(),
            format!("{:?}", diagnosis.verdict).to_lowercase(),
            effects.join("; "),
            rivals.join("; "),
            rig.expected.to_string(),
        ]);
    }
    table
}
