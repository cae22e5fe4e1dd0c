//! Scripts and styles of the pages, held in the program.

use super::reply::{Answer, LabError, typed};
use crate::plot;
use crate::report::page::STYLE as PAGE;
use crate::report::playback::page::{PLANAR, SPACE, STYLE as VIEW_STYLE};
use axum::extract::Path;

const FRAME: &str = include_str!("assets/lab.css");
const CHART: &str = include_str!("assets/chart.js");
const CURVES: &str = include_str!("assets/curves.js");
const PAINT: &str = include_str!("assets/paint.js");
const LIVE: &str = include_str!("assets/live.js");
const LAB: &str = include_str!("assets/lab.js");
const WHAT_IF: &str = include_str!("assets/what_if.js");
const GAINS: &str = include_str!("assets/gains.js");
const RAW: &str = include_str!("assets/raw.js");
const COMPARE: &str = include_str!("assets/compare.js");
const RESIDUAL: &str = include_str!("assets/residual.js");
const MODEL: &str = include_str!("assets/model.js");

/// A script or a style sheet.
pub(super) async fn asset(Path(name): Path<String>) -> Answer {
    let script = "text/javascript; charset=utf-8";
    let style = "text/css; charset=utf-8";
    let (kind, text) = match name.as_str() {
        "lab.css" => (style, [plot::STYLE, PAGE, FRAME].concat()),
        "view.css" => (style, [plot::STYLE, VIEW_STYLE].concat()),
        "view.js" => (script, PLANAR.into()),
        "view-space.js" => (script, SPACE.into()),
        "chart.js" => (script, CHART.into()),
        "curves.js" => (script, CURVES.into()),
        "paint.js" => (script, PAINT.into()),
        "live.js" => (script, LIVE.into()),
        "lab.js" => (script, LAB.into()),
        "what_if.js" => (script, WHAT_IF.into()),
        "gains.js" => (script, GAINS.into()),
        "raw.js" => (script, RAW.into()),
        "compare.js" => (script, COMPARE.into()),
        "residual.js" => (script, RESIDUAL.into()),
        "model.js" => (script, MODEL.into()),
        _ => return Err(LabError::NotFound("file")),
    };
    Ok(typed(kind, text))
}
