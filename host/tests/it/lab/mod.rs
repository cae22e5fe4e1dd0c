//! The lab: over HTTP as a program sees it, and in a browser as a person does.

mod bring;
mod events;
mod gains;
mod http;
mod in_space;
mod kept;
mod law;
mod live;
mod made;
mod models;
mod pages;
mod plots;
mod safety;
mod server;
mod sessions;
mod stage_in_space;
mod two_browsers;
mod wide_log;

use handstand_browser::Browser;
use std::path::Path;

/// A browser whose pictures go into the target folder; `None`, and a line that says so, where
/// there is no Chromium.
fn browser() -> Option<Browser> {
    Browser::start(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("lab"))
}
