//! Streaming: 18 servos at 100 Hz over 57600 baud.

use super::{SimulatedCm5, arm};
use handstand_shared::message::{Command, Report, StreamReport, Subject, Telemetry};
use handstand_shared::packed::{Positions, SERVOS};

/// What a run showed.
#[derive(Debug, Clone)]
pub struct StreamRun {
    /// Times between reports, sorted, ms.
    pub cycles_ms: Vec<f64>,
    /// Reports that were sent, by their tick numbers, and did not arrive.
    pub lost: usize,
    /// Positions that were missing.
    pub missing: usize,
    /// Frames that arrived damaged.
    pub bad_frames: usize,
    /// Bytes per report, on the line.
    pub bytes_per_frame: f64,
    /// From saying goals to the report that says they are obeyed, ms, sorted.
    pub round_trip_ms: Vec<f64>,
    /// Largest distance between a servo's position and the goal it was given 100 ms before, codes.
    pub worst_tracking: u16,
    /// The firmware's own account.
    pub telemetry: Option<Telemetry>,
    /// The reports.
    pub reports: Vec<(f64, StreamReport)>,
}

impl StreamRun {
    /// The share `at` of the sorted times lies below this, ms.
    pub fn quantile(sorted: &[f64], at: f64) -> f64 {
        let last = sorted.len().saturating_sub(1);
        sorted
            .get((at * last as f64).round() as usize)
            .copied()
            .unwrap_or(f64::NAN)
    }
}

/// Arms, sends a slow sine to all servos every 10 ms, and listens.
pub fn stream(bench: &mut impl SimulatedCm5, seconds: f64) -> StreamRun {
    arm(bench);
    bench.clear();
    let bytes_before = bench.pc().bytes;
    let mut said = Vec::new();
    for tick in 0..(seconds * 100.0) as usize {
        let goal = goal_at(tick);
        let goals = Positions::pack([goal; SERVOS]);
        said.push((bench.now_ms(), bench.send(&Command::Goals(goals))));
        bench.run_ms(10.0);
    }
    let bytes = bench.pc().bytes - bytes_before;
    let reports = stream_reports(bench);
    bench.clear();
    bench.send(&Command::Ask(Subject::Telemetry));
    bench.run_ms(50.0);
    let telemetry = bench
        .reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Telemetry(telemetry) => Some(telemetry),
            _ => None,
        });
    let between = reports.windows(2);
    let mut cycles_ms: Vec<f64> = between.clone().map(|pair| pair[1].0 - pair[0].0).collect();
    cycles_ms.sort_by(f64::total_cmp);
    let skipped = |pair: &[(f64, StreamReport)]| pair[1].1.tick.wrapping_sub(pair[0].1.tick) - 1;
    let missing = |report: &StreamReport| (0..SERVOS).filter(|at| !report.is_present(*at)).count();
    let (round_trip_ms, worst_tracking) = obeyed(&reports, &said);
    StreamRun {
        lost: between.map(|pair| usize::from(skipped(pair))).sum(),
        missing: reports.iter().map(|(_, report)| missing(report)).sum(),
        bad_frames: bench.pc().bad_frames,
        bytes_per_frame: bytes as f64 / reports.len() as f64,
        cycles_ms,
        round_trip_ms,
        worst_tracking,
        telemetry,
        reports,
    }
}

/// A sine of 0.25 Hz and 100 codes around the middle.
fn goal_at(tick: usize) -> u16 {
    let angle = tick as f64 * 0.01 * 0.25 * std::f64::consts::TAU;
    (512.0 + 100.0 * angle.sin()).round() as u16
}

fn stream_reports(bench: &impl SimulatedCm5) -> Vec<(f64, StreamReport)> {
    let of_stream = |(at, report)| match report {
        Report::Stream(report) => Some((at, report)),
        _ => None,
    };
    bench.reports().into_iter().filter_map(of_stream).collect()
}

fn obeyed(reports: &[(f64, StreamReport)], said: &[(f64, u8)]) -> (Vec<f64>, u16) {
    let mut times = Vec::new();
    let mut worst = 0;
    let mut next = reports.iter().peekable();
    for (tick, (at, sequence)) in said.iter().enumerate() {
        // The first report after it was said that knows it, within a quarter of the numbers'
        // circle.
        while next.peek().is_some_and(|(_, report)| {
            report.obeyed != *sequence && sequence.wrapping_sub(report.obeyed) < 64
        }) {
            next.next();
        }
        if let Some((arrived, report)) =
            next.peek().filter(|(_, report)| report.obeyed == *sequence)
        {
            times.push(arrived - at);
            if tick > 200 {
                let goal = goal_at(tick - 10);
                let away = report.positions.codes().map(|code| code.abs_diff(goal));
                worst = away.fold(worst, u16::max);
            }
        }
    }
    times.sort_by(f64::total_cmp);
    (times, worst)
}
