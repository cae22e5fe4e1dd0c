//! The page around the scene.

use super::scene::Scene;
use crate::page::self_contained;
use crate::plot;
use maud::{Markup, PreEscaped, html as markup};

/// The style of the view.
pub const STYLE: &str = include_str!("view.css");
/// The script that moves the view.
pub const SCRIPT: &str = include_str!("view.js");
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

/// A self-contained page that plays `scene`. `command` is the line that makes it again.
///
/// # Errors
/// A scene that JSON cannot hold; none is known.
pub fn html(scene: &Scene, command: &str) -> serde_json::Result<String> {
    let style = markup! { (PreEscaped(plot::STYLE)) (PreEscaped(STYLE)) };
    let body = markup! {
        (stage(scene)?)
        p.note { code { (command) } }
        noscript { p { "This page draws with a script of its own; allow it to run." } }
        script { (PreEscaped(SCRIPT)) }
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
            canvas #stage role="img" aria-label="The robot" {}
            aside { div #drives {} table #angles {} (keys()) }
        }
        canvas #chart role="img" aria-label="Angles over time" {}
        footer {
            button #play title="Play, pause (Space)" { "▶" }
            input #scrub type="range" min="0" max="1000" value="0" step="1" aria-label="Time";
            output #clock {}
            select #speed aria-label="Speed" {}
        }
        script type="application/json" id="scene" { (PreEscaped(data)) }
    })
}

fn keys() -> Markup {
    markup! {
        details {
            summary { "Keys" }
            dl {
                @for (keys, what) in KEYS {
                    dt { @for key in keys { kbd { (key) } " " } }
                    dd { (what) }
                }
            }
        }
    }
}
