//! `handstand demo --robot`: the whole circle on a virtual robot behind the CM-5's firmware.

use super::console::show;
use super::show::{or_dash, table_of};
use super::{Console, ExitStatus};
use handstand::deploy::rehearsal::BalanceAttempt;
use handstand::diagnose::Verdict;
use handstand::log::LogRequest;
use handstand::robot_demo::{
    DemoStep, LIMIT_OPTIONS, PAYLOAD_KG, RobotDemo, effect_columns, run as circle,
};
use handstand::{Error, Result};
use std::path::Path;

/// Runs the circle with the robot of this seed in a new folder; exit code 1 where the robot does
/// not stand in the end.
pub fn run(seed: u64, output: &Path, console: &Console) -> Result<ExitStatus> {
    let refused = |error| Error::file(output, "create", error);
    std::fs::create_dir_all(output).map_err(refused)?;
    let bar = console.bar(0);
    let demo = circle(seed, output, &|step| match step {
        DemoStep::Diagnosing(progress) => show(&bar, progress),
        step => bar.suspend(|| console.say(&words(&step))),
    })?;
    drop(bar);
    console.result(&demo, || text(&demo))?;
    let page = output.join("page.html");
    console.say(&format!("Both attempts side by side: {}", page.display()));
    console.say(&commands(&demo, output));
    Ok(ExitStatus::answer(demo.learned.stands))
}

/// What does the same with a robot of one's own.
fn commands(demo: &RobotDemo, output: &Path) -> String {
    let dir = output.display();
    let effects = if demo.added.is_empty() {
        "EFFECT".to_string()
    } else {
        demo.added.join(" ")
    };
    let (training, held_out) = (demo.training.join(" "), demo.held_out.join(" "));
    format!(
        "\nThe same by hand, in {dir}:\n\
         handstand diagnose nominal.toml {training} --holdout {held_out}\n\
         handstand add nominal.toml {effects} --fit {training} --holdout {held_out} -o again.toml\n\
         handstand deploy again.toml --dry-run {LIMIT_OPTIONS}   # the plan of learned.toml: \
         {fingerprint}\n\nAnd with your own robot, nominal.toml being its model: it hangs while it \
         is recorded, and is upright for the last line:\n\
         handstand replay goals_a.csv --record a.csv --port PORT   # likewise b to e; then as above\n\
         handstand balance again.toml --port PORT\n\
         For c and e bolt {PAYLOAD_KG} kg onto the feet, 0.184 m from the hip, and write \
         `# payload_kg = {PAYLOAD_KG}` above those logs and `# payload_kg = 0` above the others: \
         so friction that grows with the load on the bar is told from friction that does not. Of \
         the drops b, c and e take the free swing alone, `b.csv:FIRST-LAST`: the rows behind \
         torque_on's fall to 0. The demonstration lets its robot move farther and faster than \
         yours should: {LIMIT_OPTIONS}.",
        fingerprint = demo.learned.fingerprint,
    )
}

fn words(step: &DemoStep) -> String {
    match step {
        DemoStep::Drawn => "A virtual robot on servos behind the CM-5's firmware, its logic in \
                            process. It has effects that nominal.toml has not; answer.sealed holds \
                            them."
            .to_string(),
        DemoStep::First(attempt) => format!(
            "\nA plan for nominal.toml, deployed and armed: it {}.",
            said(attempt)
        ),
        DemoStep::Recorded(logs) => format!(
            "\nHanging from its bar it was moved through the firmware (excite, replay): \
             {} to learn from, {} to judge by. In c and e its feet carry {PAYLOAD_KG} kg.",
            names(&logs.training),
            names(&logs.held_out)
        ),
        DemoStep::Diagnosing(progress) => progress.what.to_string(),
        DemoStep::Diagnosed(found) => format!("\n{}", found.summary.join("\n")),
        DemoStep::Second(attempt) => format!(
            "\nlearned.toml has what was found. A plan for it, deployed and armed: it {}.",
            said(attempt)
        ),
    }
}

fn names(logs: &[LogRequest]) -> String {
    let names = logs.iter().map(LogRequest::name);
    names.collect::<Vec<_>>().join(" and ")
}

fn said(attempt: &BalanceAttempt) -> String {
    let sway = attempt.sway_rms_rad.map(|rad| 1e3 * rad);
    if attempt.stands {
        format!(
            "stands for {:.0} s and sways by {} mrad rms",
            attempt.stood_s,
            or_dash(sway, |mrad| format!("{mrad:.1}"))
        )
    } else {
        format!(
            "is let down after {:.1} s ({})",
            attempt.stood_s, attempt.end
        )
    }
}

fn text(demo: &RobotDemo) -> String {
    let named = match (demo.named, demo.verdict) {
        (true, _) => "The diagnosis named what was hidden.",
        (false, Verdict::Named) => "The diagnosis named something else.",
        (false, Verdict::Ambiguous) => {
            "The diagnosis leaves open what is missing: something else would do as well."
        }
        (false, _) => "The diagnosis did not name all that was hidden.",
    };
    let (before, after) = (said(&demo.nominal), said(&demo.learned));
    format!(
        "{}\n{named}\n\nAs believed: {before}\nAs learned: {after}",
        table_of(&demo.effects, &effect_columns())
    )
}
