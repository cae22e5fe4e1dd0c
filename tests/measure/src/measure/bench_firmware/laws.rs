//! The laws on the AVR: the same bits as the host's, and their cycles.

use super::{Args, Row};
use handstand_measure::firmware::Built;
#[cfg(simavr)]
use serde_json::json;

#[cfg(simavr)]
pub(super) fn laws(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand_measure::bench::{CHOSEN, ObserverRun, SHIFTS, law, observer_law, plan};
    use handstand_shared::plan::Law;
    let Some(built) = built else {
        return Vec::new();
    };
    let count = args.reduced(args.states, 5000);
    let run = law(&built.law, count, args.seed);
    let (chosen, all) = (run.over(CHOSEN), run.over(0..SHIFTS));
    let text = |cycles: Option<(u64, u64)>| match cycles {
        Some((least, most)) => format!("{least} to {most}"),
        None => "not all met".to_string(),
    };
    let most = |cycles: Option<(u64, u64)>| cycles.map_or(u64::MAX, |(_, most)| most);
    let mut rows = vec![
        Row {
            name: "law 2 x 6 on the AVR against the host's",
            measured: format!("{} states, {} different", run.states, run.different),
            limit: "0",
            holds: Some(run.different == 0 && run.states > 0),
            values: json!({"states": run.states, "different": run.different}),
        },
        Row {
            name: "law 2 x 6, cycles",
            measured: format!(
                "{} at shifts of 0, 8 and 16; {} over 0 to 30; {} at two different ones",
                text(chosen),
                text(all),
                text(run.mixed)
            ),
            limit: "1000 at every shift",
            holds: Some(most(all).max(most(run.mixed)) <= 1000),
            values: json!({"at_0_8_16": chosen, "mixed": run.mixed, "by_shift": run.cycles}),
        },
    ];
    let (_, plan) = plan();
    if let Law::Observer(observer) = &plan.law {
        let ObserverRun {
            states,
            different,
            raw_command,
            update,
        } = observer_law(&built.law, observer, count, args.seed);
        rows.push(Row {
            name: "law with observer on the AVR against the host's",
            measured: format!("{states} states, {different} different"),
            limit: "0",
            holds: Some(different == 0 && states > 0),
            values: json!({"states": states, "different": different}),
        });
        rows.push(Row {
            name: "law with observer, cycles",
            measured: format!(
                "{raw_command} before the commands, {update} while servos are awaited"
            ),
            limit: "-",
            holds: None,
            values: json!({"raw_command": raw_command, "update": update}),
        });
    }
    rows
}

#[cfg(not(simavr))]
pub(super) fn laws(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: the law's cycles are the AVR's, and simavr is not installed");
    Vec::new()
}
