//! Samples on their way to pages, some twenty messages a second.

use serde::Serialize;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::broadcast;

/// Time between two messages.
const EVERY: Duration = Duration::from_millis(50);

/// A line of this machine brings samples late, never so early: who is further ahead is simulated.
const AHEAD: Duration = Duration::from_millis(50);

/// A chart of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LiveChart {
    /// What it shows: `servo 3`.
    pub title: String,
    /// Its SI unit.
    pub unit: &'static str,
}

/// Samples of some 50 ms.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct LiveSamples {
    /// Since the run began, s.
    pub time_s: Vec<f64>,
    /// Values of each chart in its unit, `[chart][sample]`; none where a servo did not answer.
    pub values: Vec<Vec<Option<f64>>>,
    /// Angle of each link from hanging at the last sample, rad, counter-clockwise; none where no
    /// sensor tells it.
    pub link_rad: Vec<Option<f64>>,
    /// Lowest supply that a servo told, V.
    pub supply_v: Option<f64>,
    /// Hottest servo, degrees Celsius.
    pub hottest_celsius: Option<f64>,
}

/// Collects samples and sends them; waits where the robot's time runs faster than the clock, as a
/// simulated one's does.
#[derive(Debug)]
pub struct Sender {
    to: broadcast::Sender<Arc<LiveSamples>>,
    next: LiveSamples,
    sent: Instant,
    begun: Option<(Instant, f64)>,
}

impl Sender {
    /// To the pages that listen there.
    pub fn new(to: broadcast::Sender<Arc<LiveSamples>>) -> Sender {
        Sender {
            to,
            next: LiveSamples::default(),
            sent: Instant::now(),
            begun: None,
        }
    }

    /// Adds the sample of this time, s; `rest` fills what only the last one tells.
    pub fn add(
        &mut self,
        time_s: f64,
        values: impl Iterator<Item = Option<f64>>,
        rest: impl FnOnce(&mut LiveSamples),
    ) {
        let (begun, first_s) = *self.begun.get_or_insert((Instant::now(), time_s));
        let since = Duration::try_from_secs_f64(time_s - first_s).unwrap_or_default();
        let ahead = since.saturating_sub(begun.elapsed());
        if ahead > AHEAD {
            std::thread::sleep(ahead);
        }
        self.next.time_s.push(time_s - first_s);
        for (chart, value) in values.enumerate() {
            if self.next.values.len() == chart {
                self.next.values.push(Vec::new());
            }
            self.next.values[chart].push(value);
        }
        if self.sent.elapsed() >= EVERY {
            rest(&mut self.next);
            // A run goes on while no page listens for a moment; the slot knows who must be there.
            let _ = self.to.send(Arc::new(std::mem::take(&mut self.next)));
            self.sent = Instant::now();
        }
    }
}
