//! The page around the scene.

use super::scene::Scene;
use maud::{DOCTYPE, PreEscaped, html as markup};

const STYLE: &str = include_str!("view.css");
const SCRIPT: &str = include_str!("view.js");

/// A self-contained page that plays `scene`. `command` is the line that makes it again.
///
/// # Errors
/// A scene that JSON cannot hold; none is known.
pub fn html(scene: &Scene, command: &str) -> serde_json::Result<String> {
    // What could end the script element is written otherwise.
    let data = serde_json::to_string(scene)?.replace('<', "\\u003c");
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (scene.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (scene.title) }
                    select #motion aria-label="Motion" {}
                    div #legend {}
                    button #theme title="Light or dark (D)" aria-label="Light or dark" { "◐" }
                }
                main {
                    canvas #stage aria-label="The robot" {}
                    aside {
                        div #drives {}
                        table #angles {}
                        details {
                            summary { "Keys" }
                            dl {
                                dt { kbd { "Space" } } dd { "play, pause" }
                                dt { kbd { "←" } " " kbd { "→" } } dd { "a sample; with Shift ten" }
                                dt { kbd { "Home" } " " kbd { "End" } } dd { "start, end" }
                                dt { kbd { "-" } " " kbd { "+" } } dd { "slower, faster" }
                                dt { kbd { "T" } } dd { "trail" }
                                dt { kbd { "C" } } dd { "centres of mass" }
                                dt { kbd { "M" } } dd { "next motion" }
                                dt { kbd { "D" } } dd { "light, dark" }
                            }
                        }
                    }
                }
                canvas #chart aria-label="Angles over time" {}
                footer {
                    button #play title="Play, pause (Space)" { "▶" }
                    input #scrub type="range" min="0" max="1000" value="0" step="1" aria-label="Time";
                    output #clock {}
                    select #speed aria-label="Speed" {}
                }
                p.note { code { (command) } }
                noscript { p { "This page draws with a script of its own; allow it to run." } }
                script type="application/json" id="scene" { (PreEscaped(data)) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}
