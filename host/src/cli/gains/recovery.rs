//! What loop transfer recovery changes.

use handstand::Result;
use handstand::model::Model;
use handstand::report::margins_json;
use handstand::synth::{Design, LoopFigures, Margins, Request};
use serde_json::Value;

/// The same design with the filter of least variance.
pub(super) struct Unrecovered {
    design: Design,
    figures: Option<LoopFigures>,
}

impl Unrecovered {
    /// That of `request`, where it asks for recovery.
    pub fn of(model: &Model, request: &Request) -> Result<Option<Unrecovered>> {
        let mut request = request.clone();
        match &mut request.sensors {
            Some(sensors) if sensors.recovery > 0.0 => sensors.recovery = 0.0,
            _ => return Ok(None),
        }
        let design = Design::of(model, &request)?;
        let figures = LoopFigures::of(model, &design)?;
        Ok(Some(Unrecovered { design, figures }))
    }

    /// A line.
    pub fn text(&self) -> String {
        let of = |margins: &Margins| {
            let disk = &margins.disk;
            format!(
                "{:.3} (±{:.1} dB, ±{:.1} deg)",
                disk.alpha,
                disk.gain_db(),
                disk.phase_rad().to_degrees()
            )
        };
        let margins = self.figures.as_ref().map(|figures| &figures.margins);
        let said = margins.map(|margins| {
            let sensors = margins.sensors.as_ref().map_or("none".to_string(), of);
            format!(
                "{} at the inputs, {sensors} at the sensors",
                of(&margins.inputs)
            )
        });
        let said = said.unwrap_or_else(|| "none: the loop is not stable".to_string());
        format!("\nDisk margin without recovery: {said}")
    }

    /// Its margins, and how far noise moves it.
    pub fn json(&self) -> Value {
        let mut data = margins_json(self.figures.as_ref());
        let estimation = self.design.estimator.as_ref();
        let stationary = estimation.and_then(|it| it.stationary.as_ref());
        data["stationary"] = stationary.map_or(Value::Null, |stationary| {
            serde_json::json!({
                "state_rms": stationary.state_rms,
                "input_rms": stationary.input_rms,
            })
        });
        data
    }
}
