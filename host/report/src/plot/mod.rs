//! Charts: axes with round ticks, curves, bars, bands, a heat map, as SVG; and curves as text.
//!
//! Every drawing of the library comes from here; `plot` knows no layer but `number`. What is drawn
//! is a [`Chart`] (data), or `Axes` that a page fills itself. Marks carry the class of a
//! [`Tone`]; the style sheet gives its colour, so that one drawing serves light, dark and print.
//! Only the page that plays a motion draws its chart itself, in the browser: it redraws at the
//! window's width and scales to the tracks that the reader leaves shown.
//!
//! Libraries were measured with the report's figure of one motion: 6000 samples of two curves
//! and, below, the residual.
//! - `plotters` 0.3 (SVG backend alone, no fonts of the system) writes 144 kB, all points of every
//!   curve; here it is 51 kB, since curves are decimated to pixel columns. It rounds coordinates to
//!   whole pixels, which shows as steps in flat curves, writes colours into the marks, which rules
//!   out the dark page and hiding a curve, and clips the last label.
//! - `plotly` needs its script of more than 3 MB in each page; a page stays below 600 kB and
//!   holds no script but `report/page.js`, which zooms these drawings.
//! - `textplots` 0.8 draws braille curves in a frame without labels, with its border over the
//!   curve and one stroke for all curves. Frame, labels and dots would stay ours; it would
//!   replace the 25 lines that join two dots.

mod axes;
mod bars;
mod chart;
mod decimate;
mod file;
mod heat_map;
mod scale;
mod text;

pub(crate) use axes::Axes;
pub use axes::Tone;
pub use bars::{Bar, interval, largest};
pub use chart::{Chart, Curve};
pub use file::svg_file;
pub use heat_map::heat_map;
pub(crate) use scale::{Scale, span};

/// Light palette and the look of the marks; pages add their dark palette.
pub const STYLE: &str = include_str!("plot.css");
