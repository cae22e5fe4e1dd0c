//! `cargo xtask bench-lab`: how soon the lab answers, measured in headless Chromium from a person's
//! event to what is drawn; no step may take longer than was promised.

mod person;
mod rig;
mod step;

use super::page::Page;
use super::program::built;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand_browser::Browser;
use handstand_measure::measured::Measured;
use person::Person;
use rig::Rig;
use std::path::PathBuf;
use step::Step;

/// Measure how soon the lab answers, in a browser
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Rounds of each step
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    rounds: u64,
    /// Measure this program instead of building one
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    #[command(flatten)]
    page: Page,
}

/// Whether every step was in time.
pub fn run(args: &Args) -> bool {
    let Some(program) = args.program.clone().or_else(built) else {
        eprintln!("handstand could not be built");
        return false;
    };
    let pictures = std::env::temp_dir();
    let Some(browser) = Browser::start(&pictures) else {
        eprintln!("there is no Chromium: cargo xtask install");
        return false;
    };
    let mut person = Person::new(browser, program, args.rounds as usize);
    let mut steps = Vec::new();
    let measured = Rig::all()
        .and_then(|rigs| {
            rigs.iter()
                .try_for_each(|rig| person.works_with(rig, &mut steps))
        })
        .and_then(|()| person.brings_a_minute(&mut steps));
    if let Err(why) = measured {
        eprintln!("{why}");
        return false;
    }
    let title = "How soon the lab answers";
    let written = args.page.show(None, &tables(&steps), "lab", title);
    written && steps.iter().all(Step::in_time)
}

fn tables(steps: &[Step]) -> Measured {
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY);
    table.set_header(["Step", "Median, ms", "95 % within, ms", "Limit, ms", ""]);
    for step in steps {
        let verdict = if step.in_time() { "" } else { "too slow" };
        table.add_row([
            step.what.clone(),
            format!("{:.0}", step.quantile_ms(0.5)),
            format!("{:.0}", step.quantile_ms(0.95)),
            limit(step.limit_ms),
            verdict.into(),
        ]);
    }
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let load = load().map_or("unknown".into(), |load| format!("{load:.1}"));
    Measured::default().table(table).line(format!(
        "Headless Chromium and the lab on one machine with {processors} processors and a load of \
         {load} tasks at the end. A slider's time \
         runs from its input event until curves and error are drawn again; a page's from the \
         navigation until its charts are drawn, or until it is loaded where it has none. A step is \
         in time where its median is."
    ))
}

fn limit(limit_ms: f64) -> String {
    if limit_ms.is_finite() {
        format!("{limit_ms:.0}")
    } else {
        "-".into()
    }
}

/// Tasks that wanted a processor over the last minute, on average; the measurement's own among
/// them. None where the system does not say.
fn load() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split(' ').next()?.parse().ok()
}
