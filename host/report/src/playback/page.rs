//! The page around the scene.

use super::scene::Scene;
use crate::page::self_contained;
use crate::plot;
use maud::{Markup, PreEscaped, html as markup};

/// The style of the view.
pub const STYLE: &str = include_str!("view.css");
/// The script that moves a planar chain.
pub const PLANAR: &str = concat!(include_str!("planar.js"), include_str!("view.js"));
/// The script that moves a robot in space.
pub const SPACE: &str = concat!(
    include_str!("frames.js"),
    include_str!("orbit.js"),
    include_str!("solids.js"),
    include_str!("space.js"),
    include_str!("view.js")
);
/// Keys and what they do.
const KEYS: [(&[&str], &str); 8] = [
    (&["Space"], "play, pause"),
    (&["←", "→"], "a sample; with Shift ten"),
    (&["Home", "End"], "start, end"),
    (&["-", "+"], "slower, faster"),
    (&["T"], "trail"),
    (&["C"], "centres of mass"),
    (&["M"], "next motion"),
    (&["D"], "light, dark"),
];

/// Keys of a robot in space alone.
const SPACE_KEYS: [(&[&str], &str); 5] = [
    (&["J", "L", "I", "K"], "turn the view; with Shift move it"),
    (&["U", "O"], "nearer, farther"),
    (&["1", "2", "3"], "from the front, the side, above"),
    (&["R"], "the first view again"),
    (&["N"], "names of joints"),
];

/// The script that moves `scene`.
fn script(scene: &Scene) -> &'static str {
    if scene.tree.is_some() { SPACE } else { PLANAR }
}

/// A self-contained page that plays `scene`. `command` is the line that makes it again.
///
/// # Errors
/// A scene that JSON cannot hold; none is known.
pub fn html(scene: &Scene, command: &str) -> serde_json::Result<String> {
    let style = markup! { (PreEscaped(plot::STYLE)) (PreEscaped(STYLE)) };
    let body = markup! {
        (stage(scene)?)
        section.note aria-label="Command that makes this page" { code { (command) } }
        noscript { p { "This page draws with a script of its own; allow it to run." } }
        script { (PreEscaped(script(scene))) }
    };
    Ok(self_contained(&scene.title, &style, &body))
}

/// What the script draws on, and the scene as data.
///
/// # Errors
/// As [`html`].
pub fn stage(scene: &Scene) -> serde_json::Result<Markup> {
    // What could end the script element is written otherwise.
    let data = serde_json::to_string(scene)?.replace('<', "\\u003c");
    Ok(markup! {
        header {
            h1 { (scene.title) }
            select #motion aria-label="Motion" {}
            div #legend {}
            button #theme title="Light or dark (D)" aria-label="Light or dark" { "◐" }
        }
        main {
            @if scene.tree.is_some() { (space()) } @else {
                canvas #stage role="img" aria-label="The robot" {}
            }
            aside { div #drives {} table #angles {} (keys(scene)) }
        }
        @if scene.tree.is_some() {
            section.charts aria-label="Angles over time" { (chart()) }
        } @else { (chart()) }
        footer {
            button #play title="Play, pause (Space)" { "▶" }
            input #scrub type="range" min="0" max="1000" value="0" step="1" aria-label="Time";
            output #clock {}
            select #speed aria-label="Speed" {}
        }
        script type="application/json" id="scene" { (PreEscaped(data)) }
    })
}

/// From behind to the front: ground and trails, surfaces, marks.
fn space() -> Markup {
    markup! {
        div #space {
            canvas #floor aria-hidden="true" {}
            canvas #surfaces aria-hidden="true" {}
            canvas #stage role="img" aria-label="The robot; drag to turn the view" {}
            p #plain hidden { "This browser has no WebGL: links are drawn as lines." }
        }
    }
}

fn chart() -> Markup {
    markup! { canvas #chart role="img" aria-label="Angles over time" {} }
}

fn keys(scene: &Scene) -> Markup {
    let of_space = SPACE_KEYS.iter().filter(|_| scene.tree.is_some());
    markup! {
        details {
            summary { "Keys" }
            @if scene.tree.is_some() {
                p.hint { "Drag to turn the view, with Shift or the right button to move it; the \
                          wheel or two fingers zoom." }
            }
            dl {
                @for (keys, what) in KEYS.iter().chain(of_space) {
                    dt { @for key in *keys { kbd { (key) } " " } }
                    dd { (what) }
                }
            }
        }
    }
}
